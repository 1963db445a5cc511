// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "experiments/frogger_grasps/frogger_setting.hpp"
#include "experiments/frogger_grasps/reference_grasps.hpp"

namespace opponens {

/// Where things are.
struct Folders {
  std::filesystem::path reference;  ///< reference/frogger
  std::filesystem::path objects;    ///< data/objects/ycb
  std::filesystem::path hand;       ///< hand.yaml
};

/// An object of the comparison, ready to score postures.
struct FroggerObject {
  ReferenceFile reference;
  robot::Scene scene;
  grasp::GraspTarget target;
  grasp::HandSurface surface;
};
FroggerObject load_object(const Folders& folders, const std::string& file, const robot::RobotModel& hand, bool table);

struct Score {
  double min_weight = 0.0;  ///< 0 without force closure, or without a grasp
  double epsilon = 0.0;
  bool force_closure = false;
};
Score score(const FroggerObject& object, const std::vector<Contact>& contacts);

/// Least signed distance of the hand's surface (points 2 mm apart) to the object, m. Shares nothing with the search but
/// the mesh distance.
double least_clearance(const robot::RobotModel& hand, const FroggerObject& object, const Posture& posture);

Posture posture_of(const ReferenceGrasp& grasp);

double median(std::vector<double> values);  ///< 0 when empty

}  // namespace opponens
