// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/grasp_check.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "analysis/synergy_box.hpp"

namespace opponens::grasp {
namespace {

constexpr double kObstacleClearance = 0.001;  // m, of a grasp from support and obstacles
constexpr double kSelfClearance = 0.0005;     // m, between fingers: what a path keeps (design: "Verification")
constexpr double kOtherClearance = 0.0005;    // m, of links without a contact from the object
constexpr int kSweepSteps = 12;

/// The straight motion from grasp to pre-grasp at s in [0, 1].
HandPose between(const HandPose& grasp, const HandPose& pregrasp, double s) {
  HandPose pose = grasp;
  pose.X_OH.translation() += s * (pregrasp.X_OH.translation() - grasp.X_OH.translation());
  pose.q += s * (pregrasp.q - grasp.q);
  return pose;
}

/// Whether touching links penetrate no more than they may and the others keep clear.
bool keeps(const std::vector<double>& distances, const GraspLimits& limits) {
  for (std::size_t link = 0; link < distances.size(); ++link) {
    if (distances[link] < (limits.touching[link] ? -limits.max_penetration : kOtherClearance)) return false;
  }
  return true;
}

bool sweep_is_clear(const ClosingScene& scene, const HandCheckers& checkers, const HandPose& grasp,
                    const HandPose& pregrasp, const GraspLimits& limits) {
  for (int i = 1; i < kSweepSteps; ++i) {
    const HandPose pose = between(grasp, pregrasp, static_cast<double>(i) / kSweepSteps);
    if (!keeps(link_object_distances(scene, pose, Density::medium, kOtherClearance), limits)) return false;
    if (obstacle_distance(scene, pose, kObstacleClearance) < kObstacleClearance) return false;
    if (self_distance(scene, pose, kSelfClearance) < kSelfClearance) return false;
  }
  for (int i = 2; i < kSweepSteps; i += 3) {
    const HandPose pose = between(grasp, pregrasp, static_cast<double>(i) / kSweepSteps);
    if (!checkers.touching.free(scene.target.X_WO * pose.X_OH, pose.q)) return false;
  }
  return true;
}

bool clear_of_object(const ClosingScene& scene, const HandPose& pose, double clearance) {
  for (const Density density : {Density::medium, Density::dense}) {
    const auto distances = link_object_distances(scene, pose, density, clearance);
    if (*std::min_element(distances.begin(), distances.end()) < clearance) return false;
  }
  return true;
}

/// Name of the obstacle that the hand's points come nearest to.
std::string nearest_obstacle(const ClosingScene& scene, const HandPose& pose) {
  const auto X_HL = scene.hand.link_poses(pose.q);
  double least = std::numeric_limits<double>::infinity();
  std::string name;
  for (const Obstacle& obstacle : scene.target.obstacles) {
    for (std::size_t link = 0; link < X_HL.size(); ++link) {
      const Eigen::Isometry3d X_BL = obstacle.X_BO * pose.X_OH * X_HL[link];
      for (const Eigen::Vector3d& p_L : scene.surface.medium[link]) {
        const double distance = obstacle.distance.query(X_BL * p_L, kObstacleClearance).value;
        if (distance >= least) continue;
        least = distance;
        name = obstacle.name;
      }
    }
  }
  return name;
}

}  // namespace

std::vector<double> link_object_distances(const ClosingScene& scene, const HandPose& pose, Density density,
                                          double horizon) {
  const auto X_HL = scene.hand.link_poses(pose.q);
  const HandSurface& surface = scene.surface;
  const DistanceGrid& grid = *scene.target.grid;
  std::vector<double> distances(X_HL.size(), std::numeric_limits<double>::infinity());
  for (std::size_t link = 0; link < X_HL.size(); ++link) {
    const Eigen::Isometry3d X_OL = pose.X_OH * X_HL[link];
    const double bound = grid.value(X_OL * surface.link_center[link]) - surface.link_radius[link];
    if (bound - grid.spacing() > horizon) continue;
    double& least = distances[link];
    for (const Eigen::Vector3d& p_L : (density == Density::dense ? surface.dense : surface.medium)[link]) {
      const Eigen::Vector3d p_O = X_OL * p_L;
      const double rough = grid.value(p_O) - grid.spacing();
      // Only a point that could still be the nearest is worth an exact answer.
      if (rough < horizon && rough < least) least = std::min(least, scene.target.distance->signed_distance(p_O));
    }
  }
  return distances;
}

std::vector<double> object_link_distances(const ClosingScene& scene, const HandPose& pose, double horizon) {
  const auto X_HL = scene.hand.link_poses(pose.q);
  const HandSurface& surface = scene.surface;
  std::vector<double> distances(X_HL.size(), horizon);
  for (std::size_t link = 0; link < X_HL.size(); ++link) {
    if (surface.links[link].empty()) continue;
    const Eigen::Isometry3d X_OL = pose.X_OH * X_HL[link];
    const double reach = surface.link_radius[link] + horizon;
    const DistanceGrid& grid = *scene.target.grid;
    if (grid.value(X_OL * surface.link_center[link]) > reach + grid.spacing()) continue;
    const Eigen::Isometry3d X_LO = X_OL.inverse();
    for (const Eigen::Vector3d& p_O : scene.target.surface) {
      const Eigen::Vector3d p_L = X_LO * p_O;
      if ((p_L - surface.link_center[link]).squaredNorm() > reach * reach) continue;
      distances[link] = std::min(distances[link], surface.links[link].query(p_L, horizon).value);
    }
  }
  return distances;
}

double self_distance(const ClosingScene& scene, const HandPose& pose, double horizon) {
  const auto X_HL = scene.hand.link_poses(pose.q);
  const HandSurface& surface = scene.surface;
  double least = horizon;
  for (std::size_t a = 0; a < X_HL.size(); ++a) {
    for (const int stranger : surface.strangers[a]) {
      const auto b = static_cast<std::size_t>(stranger);
      const Eigen::Isometry3d X_BA = X_HL[b].inverse() * X_HL[a];
      const double apart = (X_BA * surface.link_center[a] - surface.link_center[b]).norm();
      if (apart > surface.link_radius[a] + surface.link_radius[b] + horizon) continue;
      for (const Eigen::Vector3d& p_A : surface.medium[a]) {
        least = std::min(least, surface.links[b].query(X_BA * p_A, horizon).value);
      }
    }
  }
  return least;
}

double obstacle_distance(const ClosingScene& scene, const HandPose& pose, double horizon) {
  const auto X_HL = scene.hand.link_poses(pose.q);
  double least = horizon;
  for (std::size_t link = 0; link < X_HL.size(); ++link) {
    const Eigen::Isometry3d X_OL = pose.X_OH * X_HL[link];
    const double reach = scene.surface.link_radius[link] + horizon;
    if (scene.target.obstacle_distance(X_OL * scene.surface.link_center[link], reach).value > reach) continue;
    for (const Eigen::Vector3d& p_L : scene.surface.medium[link]) {
      least = std::min(least, scene.target.obstacle_distance(X_OL * p_L, horizon).value);
    }
  }
  return least;
}

HandCheckers hand_checkers(const robot::RobotModel& hand, const robot::Scene& scene, const std::string& object) {
  std::vector<robot::BodyPair> contacts;
  for (const robot::Link& link : hand.links()) contacts.emplace_back(link.name, object);
  return {robot::CollisionChecker(hand, scene), robot::CollisionChecker(hand, scene, std::move(contacts))};
}

std::string posture_fault(const ClosingScene& scene, const HandCheckers& checkers, const HandPose& pose,
                          const GraspLimits& limits) {
  if (obstacle_distance(scene, pose, kObstacleClearance) < kObstacleClearance) {
    return "too near to an obstacle: " + nearest_obstacle(scene, pose);
  }
  const Eigen::Isometry3d X_WH = scene.target.X_WO * pose.X_OH;
  if (!checkers.touching.free(X_WH, pose.q)) {
    const std::vector<robot::BodyPair> pairs = checkers.touching.colliding_pairs(X_WH, pose.q);
    return pairs.empty() ? "hand in collision" : "hand in collision: " + pairs[0].first + "-" + pairs[0].second;
  }
  if (self_distance(scene, pose, kSelfClearance) < kSelfClearance) return "fingers touch each other";
  if (!keeps(link_object_distances(scene, pose, Density::dense, kOtherClearance), limits))
    return "penetrates the object";
  if (!keeps(object_link_distances(scene, pose, kOtherClearance), limits)) return "penetrates the object";
  return {};
}

std::optional<HandPose> find_pregrasp(const ClosingScene& scene, const HandCheckers& checkers,
                                      const SynergyBox& pre_grasp, const HandPose& grasp, const GraspLimits& limits) {
  const Eigen::VectorXd opened = scene.hand.clip(analysis::project(pre_grasp, grasp.q));
  const Eigen::VectorXd against = scene.hand.clip(analysis::project(pre_grasp, grasp.q - 0.5 * scene.direction));
  const Eigen::VectorXd center = scene.hand.clip(pre_grasp.scale.cwiseProduct(pre_grasp.center));
  const Eigen::Vector3d back = -(grasp.X_OH.linear() * scene.surface.approach);
  for (const double distance : {0.02, 0.03, 0.05, 0.07, 0.1, 0.14}) {
    for (const Eigen::VectorXd* q : {&opened, &against, &center}) {
      HandPose pose{grasp.X_OH, *q};
      pose.X_OH.translation() += distance * back;
      if (!clear_of_object(scene, pose, limits.clearance_pregrasp)) continue;
      if (self_distance(scene, pose, kSelfClearance) < kSelfClearance) continue;
      if (obstacle_distance(scene, pose, kObstacleClearance) < kObstacleClearance) continue;
      if (!checkers.apart.free(scene.target.X_WO * pose.X_OH, pose.q)) continue;
      if (sweep_is_clear(scene, checkers, grasp, pose, limits)) return pose;
    }
  }
  return std::nullopt;
}

}  // namespace opponens::grasp
