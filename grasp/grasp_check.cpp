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
constexpr double kBetweenPoints = 1e-4;       // m, of penetration that a verdict may miss
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
    if (!keeps(link_object_distances(scene, pose, kOtherClearance), limits)) return false;
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
  const auto distances = link_object_distances(scene, pose, clearance);
  return *std::min_element(distances.begin(), distances.end()) >= clearance;
}

/// Least distance of points to a link, exact below `bound`, else `bound`. X_LP: maps the points to the link's frame.
double least_distance(const PointTree& points, const LinkShape& shape, const Eigen::Isometry3d& X_LP, double bound) {
  const auto rough = [&shape](const Eigen::Vector3d& p_L) { return shape.rough(p_L) - shape.error(); };
  const auto visit = [&](const Eigen::Vector3d&, const Eigen::Vector3d& p_L) {
    if (rough(p_L) < bound) bound = std::min(bound, shape.body.query(p_L, std::max(bound, 0.0)).value);
    return bound;
  };
  return points.descend(rough, X_LP, bound, visit).bound;
}

/// Name of the obstacle that the hand's points come nearest to.
std::string nearest_obstacle(const ClosingScene& scene, const HandPose& pose) {
  const auto X_HL = scene.hand.link_poses(pose.q);
  double least = std::numeric_limits<double>::infinity();
  std::string name;
  for (const Obstacle& obstacle : scene.target.obstacles) {
    const auto distance = [&](const Eigen::Vector3d& p_B) { return obstacle.distance.query(p_B, 1.0).value; };
    for (std::size_t link = 0; link < X_HL.size(); ++link) {
      scene.surface.shapes[link]->points.descend(distance, obstacle.X_BO * pose.X_OH * X_HL[link], least,
                                                 [&](const Eigen::Vector3d&, const Eigen::Vector3d& p_B) {
                                                   const double here = distance(p_B);
                                                   if (here < least) name = obstacle.name;
                                                   return least = std::min(least, here);
                                                 });
    }
  }
  return name;
}

}  // namespace

std::vector<double> link_object_distances(const ClosingScene& scene, const HandPose& pose, double horizon) {
  const auto X_HL = scene.hand.link_poses(pose.q);
  const DistanceGrid& grid = *scene.target.grid;
  const auto bound = [&grid](const Eigen::Vector3d& p_O) { return grid.bound(p_O) - grid.error(); };
  std::vector<double> distances(X_HL.size(), horizon);
  for (std::size_t link = 0; link < X_HL.size(); ++link) {
    double& least = distances[link];
    scene.surface.shapes[link]->points.descend(bound, pose.X_OH * X_HL[link], horizon,
                                               [&](const Eigen::Vector3d&, const Eigen::Vector3d& p_O) {
                                                 // Only a point that could still be the nearest is worth an exact
                                                 // answer.
                                                 if (bound(p_O) < least) {
                                                   least = std::min(least, scene.target.nearest(p_O).distance);
                                                 }
                                                 return least;
                                               });
  }
  return distances;
}

std::vector<double> object_link_distances(const ClosingScene& scene, const HandPose& pose, double horizon) {
  const auto X_HL = scene.hand.link_poses(pose.q);
  std::vector<double> distances(X_HL.size(), horizon);
  for (std::size_t link = 0; link < X_HL.size(); ++link) {
    const LinkShape& shape = *scene.surface.shapes[link];
    if (shape.body.empty()) continue;
    const Eigen::Isometry3d X_OL = pose.X_OH * X_HL[link];
    const double reach = scene.surface.link_radius[link] + horizon;
    const DistanceGrid& grid = *scene.target.grid;
    if (grid.bound(X_OL * scene.surface.link_center[link]) - grid.error() > reach) continue;
    distances[link] = least_distance(scene.target.surface, shape, X_OL.inverse(), horizon);
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
      const double apart = (X_HL[a] * surface.link_center[a] - X_HL[b] * surface.link_center[b]).norm();
      if (apart > surface.link_radius[a] + surface.link_radius[b] + horizon) continue;
      least = least_distance(surface.shapes[a]->points, *surface.shapes[b], X_HL[b].inverse() * X_HL[a], least);
    }
  }
  return least;
}

double obstacle_distance(const ClosingScene& scene, const HandPose& pose, double horizon) {
  if (scene.target.obstacles.empty()) return horizon;
  const auto X_HL = scene.hand.link_poses(pose.q);
  double least = horizon;
  for (std::size_t link = 0; link < X_HL.size(); ++link) {
    const auto distance = [&](const Eigen::Vector3d& p_O) {
      return scene.target.obstacle_distance(p_O, scene.surface.link_radius[link] + horizon).value;
    };
    scene.surface.shapes[link]->points.descend(
        distance, pose.X_OH * X_HL[link], least,
        [&](const Eigen::Vector3d&, const Eigen::Vector3d& p_O) { return least = std::min(least, distance(p_O)); });
  }
  return least;
}

HandCheckers hand_checkers(const robot::RobotModel& hand, const robot::Scene& scene, const std::string& object) {
  std::vector<robot::BodyPair> contacts;
  for (const robot::Link& link : hand.links()) contacts.emplace_back(link.name, object);
  return {robot::CollisionChecker(hand, scene), robot::CollisionChecker(hand, scene, std::move(contacts))};
}

GraspLimits grasp_limits(const robot::RobotModel& hand, const std::vector<std::string>& touching,
                         double max_penetration, double clearance_pregrasp) {
  GraspLimits limits{std::vector<bool>(hand.links().size(), false),
                     std::max(max_penetration - kBetweenPoints, 0.5 * max_penetration), clearance_pregrasp};
  for (const std::string& link : touching) limits.touching[static_cast<std::size_t>(hand.link_index(link))] = true;
  return limits;
}

std::vector<std::string> links_of(const std::vector<Contact>& contacts) {
  std::vector<std::string> links;
  for (const Contact& contact : contacts) links.push_back(contact.link);
  return links;
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
  if (!keeps(link_object_distances(scene, pose, kOtherClearance), limits)) return "penetrates the object";
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
