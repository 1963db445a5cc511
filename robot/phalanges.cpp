// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/phalanges.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "robot/link_pairs.hpp"

namespace opponens::robot {

namespace {

using Eigen::Vector3d;

constexpr double kParallel = 0.9;    // cosine of 25 deg
constexpr double kUneven = 1.5;      // one way further than the other by this factor tells where a finger closes
constexpr double kShortestBone = 0.003;  // m, a shorter bone is a joint's housing

/// A body of a finger's chain, from its joint to the next one.
struct Segment {
  int joint;
  Vector3d origin;  ///< of the joint
  Vector3d axis;    ///< unit
  JointType type;
  Vector3d end;  ///< origin of the next joint, or the far end of the last body
  HandBody body;
};

const Joint& joint_at(const RobotModel& robot, int index) {
  return robot.description().joints[static_cast<std::size_t>(index)];
}

/// Mean of the tenth of the vertices that lies furthest from a point.
Vector3d far_end(const Eigen::Matrix3Xd& vertices, const Vector3d& from) {
  const Eigen::VectorXd distance = (vertices.colwise() - from).colwise().norm();
  const double limit = 0.9 * distance.maxCoeff();
  Vector3d sum = Vector3d::Zero();
  double count = 0.0;
  for (Eigen::Index i = 0; i < vertices.cols(); ++i) {
    if (distance[i] < limit) continue;
    sum += vertices.col(i);
    count += 1.0;
  }
  return sum / count;
}

std::vector<Segment> segments_of(const RobotModel& robot, const FingerChain& finger,
                                 const std::vector<Eigen::Isometry3d>& X_PL) {
  const std::vector<int> bodies = rigid_bodies(robot.description());
  std::vector<Segment> segments;
  for (const int index : finger.joints) {
    const Joint& joint = joint_at(robot, index);
    const Eigen::Isometry3d& X_PC = X_PL[static_cast<std::size_t>(joint.child)];
    std::vector<int> links;
    for (std::size_t l = 0; l < bodies.size(); ++l) {
      if (bodies[l] == joint.child) links.push_back(static_cast<int>(l));
    }
    segments.push_back({index, X_PC.translation(), X_PC.linear() * joint.axis, joint.type, X_PC.translation(),
                        hand_body(robot, links, X_PL)});
  }
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (i + 1 < segments.size()) {
      segments[i].end = segments[i + 1].origin;
    } else if (segments[i].body.vertices.cols() > 0) {
      segments[i].end = far_end(segments[i].body.vertices, segments[i].origin);
    }
  }
  return segments;
}

/// How far a joint can move from rest (zero clipped to its limits): down, up, both >= 0.
Eigen::Vector2d excursions(const RobotModel& robot, const Joint& joint) {
  double lower = joint.lower;
  double upper = joint.upper;
  double rest = std::clamp(0.0, lower, upper);
  if (joint.mimic) {
    const auto& joints = robot.description().joints;
    const auto driver = std::find_if(joints.begin(), joints.end(),
                                     [&](const Joint& candidate) { return candidate.name == joint.mimic->joint; });
    if (driver == joints.end()) return Eigen::Vector2d::Zero();
    const Eigen::Vector2d range = excursions(robot, *driver) * std::abs(joint.mimic->multiplier);
    return joint.mimic->multiplier < 0.0 ? Eigen::Vector2d(range.reverse()) : range;
  }
  return {rest - lower, upper - rest};
}

/// Direction in which the last body moves ahead when its joint turns in the positive sense.
Vector3d ahead_of(const Segment& last) {
  return last.type == JointType::prismatic ? last.axis : last.axis.cross(last.end - last.origin);
}

/// Mean end of the other fingers; the palm's origin when there is none.
Vector3d towards_others(const std::vector<std::vector<Segment>>& fingers, std::size_t self) {
  Vector3d sum = Vector3d::Zero();
  double count = 0.0;
  for (std::size_t i = 0; i < fingers.size(); ++i) {
    if (i == self || fingers[i].empty()) continue;
    sum += fingers[i].back().end;
    count += 1.0;
  }
  return (count > 0.0 ? Vector3d(sum / count) : sum) - fingers[self].back().end;
}

/// +1 or -1: the sense of the last joint in which the finger closes.
double closing_sense(const RobotModel& robot, const FingerChain& finger,
                     const std::vector<std::vector<Segment>>& fingers, std::size_t self,
                     std::vector<std::string>& notes) {
  const Segment& last = fingers[self].back();
  const Eigen::Vector2d range = excursions(robot, joint_at(robot, finger.joints.back()));
  if (last.type == JointType::revolute) {
    if (range[1] > kUneven * range[0]) return 1.0;
    if (range[0] > kUneven * range[1]) return -1.0;
  }
  notes.push_back("finger '" + finger.name +
                  "': its last joint does not tell which way it closes; taken to be towards " + "the other fingers");
  return ahead_of(last).dot(towards_others(fingers, self)) < 0.0 ? -1.0 : 1.0;
}

/// The bone of a segment with its pad side; length zero when it has none.
Phalanx phalanx_of(const Segment& segment, const Segment& last, double sense) {
  const double same = last.axis.dot(segment.axis) < 0.0 ? -1.0 : 1.0;
  Phalanx phalanx{segment.joint, sense * same, segment.body, segment.end - segment.origin, Vector3d::Zero()};
  if (last.type == JointType::prismatic) {
    phalanx.side = sense * last.axis;
    phalanx.bone -= phalanx.side * phalanx.side.dot(phalanx.bone);
  } else {
    phalanx.bone -= last.axis * last.axis.dot(phalanx.bone);
    phalanx.side = sense * last.axis.cross(phalanx.bone).normalized();
  }
  const double length = phalanx.bone.norm();
  if (length < kShortestBone) return phalanx;
  phalanx.bone /= length;
  const double base = phalanx.bone.dot(segment.origin);
  const Eigen::Vector2d extent = extent_along(phalanx.body.vertices, phalanx.bone);
  phalanx.from = std::max(base, extent[0]);
  phalanx.to = std::min(base + length, extent[1]);
  return phalanx;
}

/// How much alike two fingers point and close: 2 when they are parallel.
double likeness(const FingerBones& a, const FingerBones& b) {
  const Phalanx& x = a.phalanges.front();
  const Phalanx& y = b.phalanges.front();
  return x.side.dot(y.side) + x.bone.dot(y.bone);
}

/// The finger unlike all others; -1 when none stands out.
int odd_one_out(const std::vector<FingerBones>& fingers) {
  constexpr double kStandsOut = 0.5;  // of a mean likeness, which lies in [-2, 2]
  std::vector<std::pair<double, int>> mean;
  for (std::size_t i = 0; i < fingers.size(); ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < fingers.size(); ++j) sum += i == j ? 0.0 : likeness(fingers[i], fingers[j]);
    mean.emplace_back(sum / static_cast<double>(fingers.size() - 1), static_cast<int>(i));
  }
  std::sort(mean.begin(), mean.end());
  return mean[0].first < mean[1].first - kStandsOut ? mean[0].second : -1;
}

void name_by_place(const RobotModel& robot, std::vector<FingerBones>& fingers) {
  static const std::vector<std::string> kNames = {"index", "middle", "ring", "little"};
  const bool unnamed = std::all_of(fingers.begin(), fingers.end(), [](const FingerBones& finger) {
    return finger.name.starts_with("finger_") && !finger.phalanges.empty();
  });
  if (!unnamed || fingers.size() < 3 || fingers.size() > 1 + kNames.size()) return;
  const int thumb = odd_one_out(fingers);
  if (thumb < 0) return;
  FingerBones& first = fingers[static_cast<std::size_t>(thumb)];
  std::vector<std::pair<double, FingerBones*>> others;
  for (FingerBones& finger : fingers) {
    if (&finger != &first) others.emplace_back((finger.end() - first.end()).norm(), &finger);
  }
  // Fingers as far from the thumb as each other, to the millimetre, stay in the file's order.
  std::stable_sort(others.begin(), others.end(),
                   [](const auto& a, const auto& b) { return std::round(1e3 * a.first) < std::round(1e3 * b.first); });
  first.name = "thumb";
  first.thumb = true;
  for (std::size_t i = 0; i < others.size(); ++i) others[i].second->name = kNames[i];
  for (FingerBones& finger : fingers) {
    finger.notes.push_back("the finger of joint '" + joint_at(robot, finger.joints.front()).name +
                           "' has no name of its own; by its place it is called " + finger.name);
  }
}

Vector3d unit_where_agreed(const Vector3d& sum, double count) {
  constexpr double kAgree = 0.5;  // length of the mean of unit vectors
  return count > 0.0 && sum.norm() / count > kAgree ? Vector3d(sum.normalized()) : Vector3d::Zero();
}

}  // namespace

std::vector<Eigen::Isometry3d> rest_in_palm(const RobotModel& robot) {
  std::vector<Eigen::Isometry3d> X = robot.link_poses(robot.clip(Eigen::VectorXd::Zero(robot.dof())));
  const Eigen::Isometry3d X_PR = X[static_cast<std::size_t>(robot.palm())].inverse();
  for (Eigen::Isometry3d& X_L : X) X_L = X_PR * X_L;
  return X;
}

PalmDirections palm_directions(const std::vector<FingerBones>& fingers) {
  const auto is_thumb = [](const FingerBones& finger) { return finger.thumb || finger.phalanges.empty(); };
  const bool only_thumbs = std::all_of(fingers.begin(), fingers.end(), is_thumb);
  Vector3d side = Vector3d::Zero();
  Vector3d ahead = Vector3d::Zero();
  double count = 0.0;
  for (const FingerBones& finger : fingers) {
    if (finger.phalanges.empty() || (finger.thumb && !only_thumbs)) continue;
    side += finger.phalanges.front().side;
    ahead += finger.phalanges.front().bone;
    count += 1.0;
  }
  PalmDirections palm{unit_where_agreed(side, count), unit_where_agreed(ahead, count)};
  if (palm.side.norm() == 0.0) palm.side = palm.ahead;  // jaws close towards each other: the palm lies behind them
  return palm;
}

std::vector<FingerBones> finger_bones(const RobotModel& robot, const std::vector<Eigen::Isometry3d>& X_PL) {
  const std::vector<FingerChain> chains = fingers_of(robot.description(), robot.palm());
  std::vector<std::vector<Segment>> fingers;
  for (const FingerChain& chain : chains) fingers.push_back(segments_of(robot, chain, X_PL));
  std::vector<FingerBones> result;
  for (std::size_t f = 0; f < chains.size(); ++f) {
    FingerBones finger{chains[f].name, chains[f].thumb, chains[f].joints, {}, {}};
    const Segment& last = fingers[f].back();
    const double sense = closing_sense(robot, chains[f], fingers, f, finger.notes);
    for (const Segment& segment : fingers[f]) {
      const bool bends = segment.type == last.type && std::abs(segment.axis.dot(last.axis)) > kParallel;
      if (!bends || segment.body.vertices.cols() == 0) continue;
      if (last.type == JointType::prismatic && &segment != &last) continue;
      Phalanx phalanx = phalanx_of(segment, last, sense);
      if (phalanx.to - phalanx.from >= kShortestBone) finger.phalanges.push_back(std::move(phalanx));
    }
    if (finger.phalanges.empty()) finger.notes.push_back("finger '" + finger.name + "': no geometry to put points on");
    result.push_back(std::move(finger));
  }
  name_by_place(robot, result);
  return result;
}

}  // namespace opponens::robot
