// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "analysis/analyze.hpp"
#include "analysis/human_likeness.hpp"
#include "analysis/recording_source.hpp"

namespace opponens::analysis {

/// What the statistics keep of one movement.
struct Movement {
  std::size_t index = 0;  ///< in the source
  std::string id;
  std::string source;   ///< label
  std::string subject;  ///< label
  std::string group;    ///< value of the label to group by
  double weight = 1.0;
  int samples = 0;
  int begin = 0;            ///< first sample of the grasp phase; 0 without a split
  double noise_gain = 1.0;  ///< rad/s that noise of 1 rad makes; 1 for order 0
  SampleStatistics before;  ///< scaled, of the samples before; empty without a split
  SampleStatistics after;   ///< scaled, of the others
};

/// What one pass over all recordings finds.
struct Movements {
  std::vector<std::string> joint_names;
  Eigen::VectorXd scale;                      ///< [n]
  double resolution = 0.0;                    ///< of the sensors, in the unit of what is analysed: rad or rad/s
  std::vector<Movement> movements;            ///< by id, then source
  std::vector<TransitionReport> transitions;  ///< in the order of the source; empty without a split
  std::vector<FreeMotion> free_motions;
};

/// What is analysed of a recording: its joint positions (order 0) or velocities (order 1), [T x n].
Eigen::MatrixXd analysed_values(const Demonstration& recording, int order);

/// Checks every recording, splits it and takes its moments. The failures are those of analyze().
Result<Movements> read_movements(const RecordingSource& source, const AnalysisSettings& settings,
                                 const Reading& reading);

}  // namespace opponens::analysis
