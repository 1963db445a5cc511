// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// What the tests of retargeting share: both hands, and a recording of one that swings through its ranges.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/rng.hpp"
#include "robot/load_robot.hpp"
#include "robot/retarget.hpp"

namespace opponens::robot {

inline const std::string kHand = OPPONENS_SOURCE_DIR "/models/ur5_allegro/allegro_right.yaml";
inline const std::string kHuman = OPPONENS_SOURCE_DIR "/models/human_hand/human_hand.yaml";

inline Eigen::Index column(const Demonstration& recording, const std::string& name) {
  const auto& names = recording.joint_names;
  return std::find(names.begin(), names.end(), name) - names.begin();
}

/// Every joint swings smoothly between the given shares of its range, each with its own phase.
inline Demonstration swing(const RobotModel& model, double from, double to, int samples = 60) {
  Demonstration recording;
  recording.id = "swing";
  recording.labels = {{"grasp_type", "test"}};
  recording.origin = Origin::simulated;
  recording.joint_names = model.hand().joint_names;
  recording.time = Eigen::VectorXd::LinSpaced(samples, 0.0, 0.02 * (samples - 1));
  recording.q_h.resize(samples, model.dof());
  Rng rng(21);
  for (int i = 0; i < model.dof(); ++i) {
    const double phase = rng.uniform(0, 2 * std::numbers::pi);
    for (int t = 0; t < samples; ++t) {
      const double share = from + (to - from) * (0.5 + 0.5 * std::sin(phase + 4.0 * t / samples));
      recording.q_h(t, i) = model.lower()[i] + share * (model.upper()[i] - model.lower()[i]);
    }
  }
  return recording;
}

/// Allegro as the "human": its recordings have an exact image, with base and scale the same.
inline HandMapping self_mapping(const HandMapping& mapping) {
  HandMapping self = mapping;
  for (JointMapping& copy : self.copied) copy.channel = copy.joint;
  return self;
}

struct Hands {
  RobotModel human{load_hand(kHuman)};
  RobotModel hand{load_hand(kHand)};
  HandMapping mapping = load_hand_mapping(kHand);
};

}  // namespace opponens::robot
