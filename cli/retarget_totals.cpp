// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/retarget_totals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace opponens::cli {
namespace {

std::string fixed(double value) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

}  // namespace

void RetargetTotals::add(const robot::Retargeted& mapped) {
  const auto count = static_cast<int>(mapped.demonstration.time.size());
  if (samples == 0) {
    tips = mapped.tips;
    joints = mapped.demonstration.joint_names;
    tip_squares = Eigen::VectorXd::Zero(mapped.tip_rms.size());
    clamped = Eigen::VectorXd::Zero(mapped.clamped_share.size());
  }
  tip_squares += count * mapped.tip_rms.cwiseAbs2();
  clamped += count * mapped.clamped_share;
  largest = std::max(largest, mapped.tip_residual_max);
  clamped_samples += mapped.clamped_samples;
  samples += count;
  if (!mapped.converged) ++unconverged;
  for (const std::string& channel : mapped.assumed) ++assumed[channel];
}

Eigen::VectorXd RetargetTotals::tip_rms() const { return (tip_squares / std::max(1, samples)).cwiseSqrt(); }

double RetargetTotals::rms() const { return std::sqrt(tip_rms().squaredNorm() / static_cast<double>(tips.size())); }

void RetargetTotals::say(const Console& console) const {
  const Eigen::VectorXd each = tip_rms();
  std::string words;
  for (std::size_t i = 0; i < tips.size(); ++i) {
    words += (i == 0 ? "" : ", ") + tips[i] + " " + fixed(1e3 * each[static_cast<Eigen::Index>(i)]);
  }
  if (!tips.empty()) {
    console.say("fingertips off by " + fixed(1e3 * rms()) + " mm rms (" + words + "), " + fixed(1e3 * largest) +
                " mm at most");
  }
  words.clear();
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const double count = clamped[static_cast<Eigen::Index>(i)];
    if (count > 0.5) words += (words.empty() ? "" : ", ") + joints[i] + " " + fixed(100.0 * count / samples) + " %";
  }
  console.say(words.empty() ? "no joint was held at a limit"
                            : "a joint was held at a limit in " + std::to_string(clamped_samples) + " of " +
                                  std::to_string(samples) + " samples: " + words);
  if (unconverged > 0) {
    console.say("in " + std::to_string(unconverged) + " recordings the solver stopped at its iteration limit");
  }
  for (const auto& [channel, count] : assumed) {
    console.say(std::to_string(count) + " recordings have no channel " + channel + ": taken to be at rest");
  }
}

Json RetargetTotals::json() const {
  const bool measured = !tips.empty();
  const Eigen::VectorXd each = tip_rms();
  Json of_tips = Json::array();
  for (std::size_t i = 0; i < tips.size(); ++i) {
    of_tips.push_back({{"name", tips[i]}, {"residual_rms_m", number(each[static_cast<Eigen::Index>(i)])}});
  }
  return {{"tip_residual_rms_m", measured ? number(rms()) : Json(nullptr)},
          {"tip_residual_max_m", measured ? number(largest) : Json(nullptr)},
          {"tips", of_tips},
          {"clamped_share", by_name(joints, clamped / std::max(1, samples))},
          {"clamped_samples", clamped_samples},
          {"samples", samples},
          {"unconverged", unconverged},
          {"assumed", Json(assumed)}};
}

}  // namespace opponens::cli
