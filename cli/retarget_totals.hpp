// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "cli/console.hpp"
#include "cli/json.hpp"
#include "robot/retarget.hpp"

namespace opponens::cli {

/// Residuals and limits over all samples of many mapped recordings.
struct RetargetTotals {
  std::vector<std::string> tips{};
  std::vector<std::string> joints{};
  Eigen::VectorXd tip_squares{};  ///< m^2, summed over samples
  Eigen::VectorXd clamped{};      ///< samples, per joint
  double largest = 0.0;           ///< m
  int clamped_samples = 0;
  int samples = 0;
  int unconverged = 0;                   ///< recordings
  std::map<std::string, int> assumed{};  ///< recordings without the channel, which was taken to be at rest

  void add(const robot::Retargeted& mapped);
  Eigen::VectorXd tip_rms() const;
  double rms() const;  ///< of all tips
  void say(const Console& console) const;
  Json json() const;
};

}  // namespace opponens::cli
