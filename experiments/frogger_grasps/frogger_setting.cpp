// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/frogger_grasps/frogger_setting.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "grasp/precision_problem.hpp"
#include "robot/mesh.hpp"

namespace opponens {

Eigen::Matrix3d tangent_rotation() {
  const Eigen::Vector3d zeta = Eigen::Vector3d(1.2, 2.3, 3.4).normalized();
  return Eigen::Quaterniond::FromTwoVectors(zeta, Eigen::Vector3d::UnitX()).toRotationMatrix();
}

robot::Scene frogger_scene(const std::filesystem::path& mesh, double table_z, bool table) {
  robot::TriangleMesh turned = *robot::load_mesh(mesh);
  turned.vertices = tangent_rotation() * turned.vertices;
  robot::Scene scene;
  scene.name = mesh.stem().string();
  scene.object = "object";
  Eigen::Isometry3d X_WA = Eigen::Isometry3d::Identity();
  X_WA.linear() = tangent_rotation().transpose();
  const robot::Shape shape = std::make_shared<const robot::TriangleMesh>(std::move(turned));
  scene.bodies.push_back({"object", X_WA, {{shape, Eigen::Isometry3d::Identity()}}});
  if (table) {
    Eigen::Isometry3d X_WT = Eigen::Isometry3d::Identity();
    X_WT.translation().z() = table_z - 0.05;
    const robot::Shape slab = robot::Box{Eigen::Vector3d(2.0, 2.0, 0.1)};
    scene.bodies.push_back({"table", X_WT, {{slab, Eigen::Isometry3d::Identity()}}});
    scene.support = "table";
  }
  return scene;
}

QualityConvention frogger_convention(double mu, int edges) {
  QualityConvention convention;
  convention.mu = mu;
  convention.edges = edges;
  convention.unit = ForceUnit::force;
  convention.rho = 1.0;
  return convention;
}

SynergyBox frogger_joint_box(const robot::RobotModel& hand) {
  const Eigen::VectorXd range = hand.upper() - hand.lower();
  Eigen::VectorXd lower = hand.lower() + 0.05 * range;
  const Eigen::VectorXd upper = hand.upper() - 0.05 * range;
  for (const int j : {1, 2, 3, 5, 6, 7, 9, 10, 11, 14, 15}) lower[j] = 0.15;
  lower[12] = 0.4;
  lower[13] = 0.5;
  return grasp::free_box(lower, upper);
}

std::vector<Contact> tip_contacts(const robot::RobotModel& hand, const grasp::HandSurface& surface,
                                  const grasp::GraspTarget& target, grasp::TipModel model, const Posture& posture,
                                  NormalRule rule, double mu) {
  const auto X_HL = hand.link_poses(posture.q);
  std::vector<Contact> contacts;
  for (const grasp::FingerTip& tip : grasp::finger_tips(hand, surface, model)) {
    const auto link = static_cast<std::size_t>(tip.link);
    const Eigen::Isometry3d X_OL = posture.X_OH * X_HL[link];
    const grasp::TipTouch touch = grasp::touch(tip, surface, target, X_OL);
    Contact contact{hand.links()[link].name, touch.p_O, touch.n_O, mu};
    if (model == grasp::TipModel::fixed_point) contact.p_OC = X_OL * tip.center_L;
    if (rule == NormalRule::face) {
      const robot::TriangleMesh& mesh = *target.mesh;
      const Eigen::Vector3i t = mesh.triangles.col(target.distance->query(touch.p_O).triangle);
      const Eigen::Vector3d a = mesh.vertices.col(t[0]);
      contact.n_O = -(mesh.vertices.col(t[1]) - a).cross(mesh.vertices.col(t[2]) - a).normalized();
    }
    contacts.push_back(contact);
  }
  return contacts;
}

double largest_gap(const robot::RobotModel& hand, const grasp::HandSurface& surface, const grasp::GraspTarget& target,
                   grasp::TipModel model, const Posture& posture) {
  const auto X_HL = hand.link_poses(posture.q);
  double largest = 0.0;
  for (const grasp::FingerTip& tip : grasp::finger_tips(hand, surface, model)) {
    const Eigen::Isometry3d X_OL = posture.X_OH * X_HL[static_cast<std::size_t>(tip.link)];
    largest = std::max(largest, std::abs(grasp::touch(tip, surface, target, X_OL).gap));
  }
  return largest;
}

}  // namespace opponens
