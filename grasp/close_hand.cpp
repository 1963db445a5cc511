// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/close_hand.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "analysis/synergy_box.hpp"
#include "grasp/clearance_probe.hpp"

namespace opponens::grasp {
namespace {

constexpr double kTouch = 0.0002;      // m, contact is met within this
constexpr double kMaxRetreat = 0.03;   // m
constexpr double kMaxAdvance = 0.02;   // m
constexpr double kMaxTravel = 1.2;     // rad of the fastest joint of a finger
constexpr double kMaxOpening = 1.2;    // rad
constexpr double kOpeningStep = 0.06;  // rad
constexpr double kMaxPush = 0.2;       // rad of one joint in one step
constexpr int kMaxPushes = 25;
constexpr int kMaxSteps = 80;

/// A one-parameter motion s -> pose with a bound of how fast its points move, m per unit of s.
struct Motion {
  std::function<HandPose(double)> pose;
  double speed;
  double end;
};

struct Stop {
  double s;
  Clearance clearance;
  bool touched;
};

/// Follows a motion from a clear pose until the links are kTouch or less from the object or come too near to something
/// else, by steps no longer than the clearance allows; an overshoot (speed is an estimate) is taken back by bisection.
/// What is beside the way must not make the steps small: it is looked at every kEnoughRoom, and no link is thinner.
Stop advance(const Motion& motion, const std::vector<int>& links, Watch watch, ClearanceProbe& probe) {
  double clear = 0.0;
  Clearance at_clear = probe(motion.pose(0.0), links, watch);
  double approach = motion.speed;  // m per unit of s, of the last step towards the object
  double blocked = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kMaxSteps; ++step) {
    if (at_clear.object <= kTouch) return {clear, at_clear, true};
    if (clear >= motion.end || (blocked - clear) * motion.speed < 0.5 * kTouch) break;
    const double room = std::min(at_clear.object, std::max(at_clear.others, kEnoughRoom));
    const double touch = (at_clear.object - 0.5 * kTouch) / std::max(approach, 0.05 * motion.speed);
    const double ahead = at_clear.object < kEnoughRoom ? std::min(touch, kEnoughRoom / motion.speed) : 0.0;
    double s = std::min(motion.end, clear + std::max({0.8 * room / motion.speed, 0.5 * kTouch / motion.speed, ahead}));
    if (s >= blocked) s = 0.5 * (clear + blocked);
    const Clearance here = probe(motion.pose(s), links, watch);
    if (here.object < 0.0 || here.others < 0.0) {
      blocked = s;
    } else {
      approach = (at_clear.object - here.object) / (s - clear);
      clear = s;
      at_clear = here;
    }
  }
  return {clear, at_clear, false};
}

double largest(const Eigen::VectorXd& direction, const std::vector<int>& joints) {
  double value = 0.0;
  for (const int j : joints) value = std::max(value, std::abs(direction[j]));
  return value;
}

/// Opens a finger against the closing direction until it is clear of the object and, where that is possible, of the
/// hand's other links; nullopt when that does not free it from the object.
std::optional<HandPose> open_finger(const ClosingScene& scene, const Finger& finger, const HandPose& start,
                                    ClearanceProbe& probe) {
  const double fastest = std::max(largest(scene.direction, finger.joints), 0.05);
  std::optional<HandPose> freed;
  HandPose pose = start;
  for (double s = 0.0; s <= kMaxOpening; s += kOpeningStep) {
    pose.q = start.q;
    for (const int j : finger.joints) pose.q[j] -= s / fastest * scene.direction[j];
    pose.q = scene.hand.clip(pose.q);
    if (probe(pose, finger.links, Watch::object).object <= kTouch) continue;
    if (!freed) freed = pose;
    if (probe.hand_clearance(pose, finger.links) > kTouch) return pose;
  }
  return freed;
}

/// Moves a finger out of the object by the least joint motion that lifts its deepest point, again and again; nullopt
/// when it is not clear after a bounded number of steps.
std::optional<HandPose> push_out(const ClosingScene& scene, const Finger& finger, const HandPose& start,
                                 ClearanceProbe& probe) {
  HandPose pose = start;
  for (int step = 0; step < kMaxPushes; ++step) {
    const Clearance deepest = probe(pose, finger.links, Watch::object);
    if (deepest.object > kTouch) return pose;
    const Eigen::Vector3d out = pose.X_OH.linear().transpose() * scene.target.grid->query(deepest.p_O).gradient;
    const Eigen::VectorXd slope =
        scene.hand.point_jacobian(probe.link_poses(), deepest.link, pose.X_OH.inverse() * deepest.p_O).transpose() *
        out;
    Eigen::VectorXd motion = Eigen::VectorXd::Zero(slope.size());
    for (const int j : finger.joints) motion[j] = slope[j];
    const double reach = motion.squaredNorm();
    if (reach < 1e-8) return std::nullopt;
    motion *= (2.0 * kTouch - deepest.object) / reach;
    const double turn = largest(motion, finger.joints);
    pose.q = scene.hand.clip(pose.q + std::min(1.0, kMaxPush / turn) * motion);
  }
  return std::nullopt;
}

/// Draws the hand back along its approach direction until the palm is out of the object.
bool retreat(const ClosingScene& scene, HandPose& pose, ClearanceProbe& probe) {
  const Eigen::Vector3d back = -(pose.X_OH.linear() * scene.surface.approach);
  double moved = 0.0;
  while (true) {
    const double clearance = probe(pose, scene.surface.palm_links, Watch::object).object;
    if (clearance >= 0.0) return true;
    const double step = kTouch - clearance;
    moved += step;
    if (moved > kMaxRetreat) return false;
    pose.X_OH.translation() += step * back;
  }
}

/// Bound of the speed of a finger's points when its joints move along direction: each joint times its reach.
double finger_speed(const ClosingScene& scene, const Finger& finger, const Eigen::VectorXd& direction,
                    const std::vector<Eigen::Isometry3d>& X_HL) {
  double speed = 1e-6;
  for (const int mover : finger.links) {
    const LinkDrive& drive = scene.surface.drives[static_cast<std::size_t>(mover)];
    if (drive.index < 0) continue;
    double reach = 0.0;
    for (const int link : finger.links) {
      if (!scene.surface.moves[static_cast<std::size_t>(link)][static_cast<std::size_t>(drive.index)]) continue;
      const auto i = static_cast<std::size_t>(link);
      const Eigen::Vector3d apart =
          X_HL[i] * scene.surface.link_center[i] - X_HL[static_cast<std::size_t>(mover)].translation();
      reach = std::max(reach, apart.norm() + scene.surface.link_radius[i]);
    }
    speed += std::abs(drive.multiplier * direction[drive.index]) * reach;
  }
  return speed;
}

/// The synergy combination that brings the finger's contact points nearer to the object, as joint motion of that
/// finger.
Eigen::VectorXd approaching_direction(const ClosingScene& scene, const Finger& finger, const HandPose& pose) {
  const auto X_HL = scene.hand.link_poses(pose.q);
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(pose.q.size());
  for (const robot::SurfacePoint& point : scene.hand.description().contact_points) {
    if (std::find(finger.links.begin(), finger.links.end(), point.link) == finger.links.end()) continue;
    const Eigen::Vector3d p_H = X_HL[static_cast<std::size_t>(point.link)] * point.p_L;
    const Eigen::Vector3d gradient =
        pose.X_OH.linear().transpose() * scene.target.grid->query(pose.X_OH * p_H).gradient;
    slope += scene.hand.point_jacobian(X_HL, point.link, p_H).transpose() * gradient;
  }
  const Eigen::VectorXd dy = -(scene.box.axes.transpose() * scene.box.scale.cwiseProduct(slope));
  const Eigen::VectorXd along = scene.box.scale.cwiseProduct(scene.box.axes * dy);
  const double length = largest(along, finger.joints);
  return length > 1e-9 ? Eigen::VectorXd(along / length) : Eigen::VectorXd::Zero(pose.q.size());
}

/// Moves the finger along direction until it touches, then the joints beyond each touching link. False (and the pose as
/// it was) when it meets nothing.
bool close_finger(const ClosingScene& scene, const Finger& finger, const Eigen::VectorXd& direction, HandPose& pose,
                  ClearanceProbe& probe) {
  Eigen::VectorXd moving = Eigen::VectorXd::Zero(pose.q.size());
  for (const int j : finger.joints) moving[j] = direction[j];
  const HandPose before = pose;
  std::vector<int> links = finger.links;
  probe.excuse(pose, links);
  bool met = false;
  while (largest(moving, finger.joints) > 0.02 && !links.empty()) {
    const HandPose start = pose;
    const auto at = [&](double s) { return HandPose{start.X_OH, scene.hand.clip(start.q + s * moving)}; };
    probe(start, {}, Watch::object);
    const Motion motion{at, finger_speed(scene, finger, moving, probe.link_poses()),
                        kMaxTravel / largest(moving, finger.joints)};
    const Stop stop = advance(motion, links, Watch::everything, probe);
    if (!stop.touched) break;  // the rest of a finger that already touches stays as it is
    pose = at(stop.s);
    met = true;
    const auto& stopped = scene.surface.moves[static_cast<std::size_t>(stop.clearance.link)];
    for (const int j : finger.joints) moving[j] = stopped[static_cast<std::size_t>(j)] ? 0.0 : moving[j];
    std::erase_if(links, [&](int link) {
      const auto& moves = scene.surface.moves[static_cast<std::size_t>(link)];
      return std::none_of(finger.joints.begin(), finger.joints.end(),
                          [&](int j) { return moves[static_cast<std::size_t>(j)] && moving[j] != 0.0; });
    });
  }
  if (!met) pose = before;
  return met;
}

}  // namespace

Eigen::VectorXd closing_direction(const SynergyBox& group, const SynergyBox& pre_grasp) {
  const Eigen::VectorXd difference =
      (group.scale.cwiseProduct(group.center) - pre_grasp.scale.cwiseProduct(pre_grasp.center))
          .cwiseQuotient(group.scale);
  Eigen::VectorXd along = group.axes * (group.axes.transpose() * difference);
  if (along.norm() < 0.1 * difference.norm()) along = difference;
  along = group.scale.cwiseProduct(along);
  const double length = along.cwiseAbs().maxCoeff();
  return length > 1e-6 ? Eigen::VectorXd(along / length) : Eigen::VectorXd::Zero(along.size());
}

std::optional<HandPose> close_hand(const ClosingScene& scene, const HandPose& start) {
  ClearanceProbe probe(scene);
  HandPose pose{start.X_OH, scene.hand.clip(start.q)};
  if (!retreat(scene, pose, probe)) return std::nullopt;
  for (const Finger& finger : scene.surface.fingers) {
    auto opened = open_finger(scene, finger, pose, probe);
    if (!opened) opened = push_out(scene, finger, pose, probe);
    if (!opened) return std::nullopt;
    pose = *opened;
  }
  std::vector<int> all(scene.hand.links().size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  const Eigen::Vector3d forward = pose.X_OH.linear() * scene.surface.approach;
  const auto shifted = [&](double s) {
    HandPose moved = pose;
    moved.X_OH.translation() += s * forward;
    return moved;
  };
  const Stop stop = advance({shifted, 1.0, kMaxAdvance}, all, Watch::surroundings, probe);
  if (stop.touched) pose = shifted(stop.s);
  for (const Finger& finger : scene.surface.fingers) {
    if (close_finger(scene, finger, scene.direction, pose, probe)) continue;
    close_finger(scene, finger, approaching_direction(scene, finger, pose), pose, probe);
  }
  return pose;
}

std::vector<Contact> find_contacts(const ClosingScene& scene, const HandPose& pose, double tolerance, double mu) {
  const auto X_HL = scene.hand.link_poses(pose.q);
  std::vector<Contact> contacts;
  std::vector<bool> touches(X_HL.size(), false);
  const auto add = [&](std::size_t link, const robot::MeshDistance::Query& at) {
    contacts.push_back({scene.hand.links()[link].name, at.point, -at.gradient.normalized(), mu});
    touches[link] = true;
  };
  for (const robot::SurfacePoint& point : scene.hand.description().contact_points) {
    const auto link = static_cast<std::size_t>(point.link);
    const Eigen::Vector3d p_O = pose.X_OH * X_HL[link] * point.p_L;
    if (scene.target.grid->value(p_O) > tolerance + scene.target.grid->spacing()) continue;
    const auto at = scene.target.nearest(p_O);
    if (std::abs(at.distance) <= tolerance) add(link, at);
  }
  const DistanceGrid& grid = *scene.target.grid;
  for (std::size_t link = 0; link < X_HL.size(); ++link) {
    if (touches[link]) continue;
    robot::MeshDistance::Query nearest{};
    nearest.distance = tolerance;
    scene.surface.shapes[link]->points.descend(
        [&grid](const Eigen::Vector3d& p_O) { return grid.bound(p_O) - grid.error(); }, pose.X_OH * X_HL[link],
        nearest.distance,
        [&](const Eigen::Vector3d&, const Eigen::Vector3d& p_O) {
          if (grid.bound(p_O) - grid.error() >= nearest.distance) return nearest.distance;
          const auto at = scene.target.nearest(p_O);
          if (at.distance < nearest.distance) nearest = at;
          return nearest.distance;
        });
    if (std::abs(nearest.distance) < tolerance) add(link, nearest);
  }
  return contacts;
}

}  // namespace opponens::grasp
