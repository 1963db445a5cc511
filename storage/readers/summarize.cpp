// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "storage/readers/source.hpp"

namespace opponens::storage {
namespace {

ChannelSummary& channel_named(std::vector<ChannelSummary>& channels, const std::string& name) {
  const auto found = std::find_if(channels.begin(), channels.end(), [&](const auto& c) { return c.name == name; });
  if (found != channels.end()) return *found;
  return channels.emplace_back(ChannelSummary{name, 0.0, 0.0, 0, 0});
}

void add_channels(const Demonstration& demonstration, Summary& summary) {
  if (demonstration.q_h.rows() == 0) return;
  for (std::size_t j = 0; j < demonstration.joint_names.size(); ++j) {
    const auto values = demonstration.q_h.col(static_cast<Eigen::Index>(j));
    const double low = values.minCoeff();
    const double high = values.maxCoeff();
    ChannelSummary& channel = channel_named(summary.channels, demonstration.joint_names[j]);
    channel.min = channel.recordings == 0 ? low : std::min(channel.min, low);
    channel.max = channel.recordings == 0 ? high : std::max(channel.max, high);
    ++channel.recordings;
    if (low == high) ++channel.stuck_recordings;
  }
}

void add_rate(const Demonstration& demonstration, Summary& summary) {
  const Eigen::Index count = demonstration.time.size();
  if (count < 2) return;
  const double duration = demonstration.time[count - 1] - demonstration.time[0];
  const double rate = static_cast<double>(count - 1) / duration;
  summary.lowest_rate = summary.duration == 0.0 ? rate : std::min(summary.lowest_rate, rate);
  summary.highest_rate = std::max(summary.highest_rate, rate);
  summary.duration += duration;
}

}  // namespace

Summary summarize(const std::vector<Demonstration>& demonstrations) {
  Summary summary;
  for (const auto& demonstration : demonstrations) {
    ++summary.recordings;
    summary.samples += demonstration.time.size();
    add_rate(demonstration, summary);
    add_channels(demonstration, summary);
    for (const auto& [label, value] : demonstration.labels) ++summary.recordings_per_label[label][value];
  }
  return summary;
}

}  // namespace opponens::storage
