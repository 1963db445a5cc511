// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "storage/readers/source.hpp"

namespace opponens::storage {
namespace {

std::size_t position_of(std::vector<ChannelSummary>& channels, const std::string& name) {
  const auto found = std::find_if(channels.begin(), channels.end(), [&](const auto& c) { return c.name == name; });
  const auto position = static_cast<std::size_t>(found - channels.begin());
  if (found == channels.end()) channels.push_back(ChannelSummary{name, 0.0, 0.0, 0, 0});
  return position;
}

void add_channels(const Demonstration& demonstration, Summary& summary) {
  if (demonstration.q_h.rows() == 0) return;
  std::vector<Eigen::Index> places;
  for (std::size_t j = 0; j < demonstration.joint_names.size(); ++j) {
    const auto values = demonstration.q_h.col(static_cast<Eigen::Index>(j));
    const double low = values.minCoeff();
    const double high = values.maxCoeff();
    const std::size_t place = position_of(summary.channels, demonstration.joint_names[j]);
    places.push_back(static_cast<Eigen::Index>(place));
    ChannelSummary& channel = summary.channels[place];
    channel.min = channel.recordings == 0 ? low : std::min(channel.min, low);
    channel.max = channel.recordings == 0 ? high : std::max(channel.max, high);
    ++channel.recordings;
    if (low == high) ++channel.stuck_recordings;
  }
  const auto count = static_cast<Eigen::Index>(summary.channels.size());
  const Eigen::Index known = summary.scatter.rows();
  summary.scatter.conservativeResizeLike(Eigen::MatrixXd::Zero(std::max(count, known), std::max(count, known)));
  const Eigen::MatrixXd centred = demonstration.q_h.rowwise() - demonstration.q_h.colwise().mean();
  const Eigen::MatrixXd scatter = centred.transpose() * centred;
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = 0; j < places.size(); ++j) {
      summary.scatter(places[i], places[j]) += scatter(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
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

void add(Summary& summary, const Recording& recording) {
  const Demonstration& demonstration = recording.demonstration;
  ++summary.recordings;
  summary.samples += demonstration.q_h.rows();
  summary.largest_step = std::max(summary.largest_step, recording.file.largest_step);
  summary.gaps += recording.file.gaps;
  add_rate(demonstration, summary);
  add_channels(demonstration, summary);
  for (const auto& [label, value] : demonstration.labels) ++summary.recordings_per_label[label][value];
}

std::vector<DependentChannel> dependent_channels(const Summary& summary) {
  std::vector<DependentChannel> dependent;
  std::vector<Eigen::Index> independent;
  const Eigen::MatrixXd& scatter = summary.scatter;
  for (Eigen::Index j = 0; j < scatter.rows(); ++j) {
    const double variance = scatter(j, j);
    // What rounding leaves of a channel that stands still is no movement.
    const auto& channel = summary.channels[static_cast<std::size_t>(j)];
    if (channel.stuck_recordings == channel.recordings || !(variance > 0.0)) continue;
    // Correlations, so that the solution does not depend on how far each channel moves.
    const auto count = static_cast<Eigen::Index>(independent.size());
    Eigen::MatrixXd known(count, count);
    Eigen::VectorXd shared(count);
    for (Eigen::Index a = 0; a < count; ++a) {
      const Eigen::Index i = independent[static_cast<std::size_t>(a)];
      shared(a) = scatter(i, j) / std::sqrt(scatter(i, i) * variance);
      for (Eigen::Index b = 0; b < count; ++b) {
        const Eigen::Index k = independent[static_cast<std::size_t>(b)];
        known(a, b) = scatter(i, k) / std::sqrt(scatter(i, i) * scatter(k, k));
      }
    }
    const Eigen::VectorXd weights = known.ldlt().solve(shared);
    const double unexplained = count == 0 ? 1.0 : 1.0 - 2.0 * weights.dot(shared) + weights.dot(known * weights);
    if (!(unexplained <= kDependentShare)) {
      independent.push_back(j);
      continue;
    }
    DependentChannel found{channel.name, {}};
    // A share of 1e-3 of the channel's movement is no more than what may stay unexplained.
    for (Eigen::Index a = 0; a < count; ++a) {
      if (std::abs(weights(a)) < std::sqrt(kDependentShare)) continue;
      const Eigen::Index i = independent[static_cast<std::size_t>(a)];
      found.of.push_back(summary.channels[static_cast<std::size_t>(i)].name);
    }
    dependent.push_back(std::move(found));
  }
  return dependent;
}

}  // namespace opponens::storage
