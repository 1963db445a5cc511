// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/frogger_grasps/scores.hpp"

#include <algorithm>

#include "grasp/quality.hpp"
#include "robot/mesh.hpp"

namespace opponens {

FroggerObject load_object(const Folders& folders, const std::string& file, const robot::RobotModel& hand, bool table) {
  ReferenceFile reference = read_reference(folders.reference / file);
  const std::filesystem::path mesh = folders.objects / reference.object / (reference.object + ".obj");
  robot::Scene scene = frogger_scene(mesh, reference.table_z, table);
  grasp::GraspTarget target = grasp::make_target(scene, "object", 1);
  return {std::move(reference), std::move(scene), std::move(target),
          grasp::hand_surface(hand, frogger_joint_box(hand).center)};
}

Score score(const FroggerObject& object, const std::vector<Contact>& contacts) {
  const GraspQuality quality =
      grasp::evaluate(contacts, frogger_convention(object.reference.mu, object.reference.edges));
  if (!quality.force_closure()) return {};
  return {quality.min_weight.value_or(0.0), quality.epsilon.value_or(0.0), true};
}

double least_clearance(const robot::RobotModel& hand, const FroggerObject& object, const Posture& posture) {
  const auto X_HL = hand.link_poses(posture.q);
  double least = 1.0;
  for (std::size_t link = 0; link < X_HL.size(); ++link) {
    const Eigen::Isometry3d X_OL = posture.X_OH * X_HL[link];
    for (const robot::Geometry& geometry : hand.links()[link].collision) {
      for (const Eigen::Vector3d& p_L : robot::surface_samples(geometry, 0.002)) {
        const Eigen::Vector3d p_O = X_OL * p_L;
        if (object.target.grid->value(p_O) > 0.01) continue;  // the grid errs by less than its spacing of 3 to 5 mm
        least = std::min(least, object.target.distance->signed_distance(p_O));
      }
    }
  }
  return least;
}

Posture posture_of(const ReferenceGrasp& grasp) {
  const Eigen::Matrix3d R_AO = tangent_rotation();
  Posture posture{Eigen::Isometry3d::Identity(), grasp.q};
  posture.X_OH.linear() = R_AO * grasp.X_OB.linear();
  posture.X_OH.translation() = R_AO * grasp.X_OB.translation();
  return posture;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace opponens
