// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "close_hand.hpp"

#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <variant>

namespace simulated_postures {
namespace {

using opponens::robot::Cylinder;
using opponens::robot::Geometry;
using Poses = std::vector<Eigen::Isometry3d>;

constexpr double kStep = 0.25 * std::numbers::pi / 180.0;  // rad, for a rate of 1
constexpr int kMaxSteps = 4000;
constexpr double kTouch = 1e-3;  // m

Capsule capsule_of(const opponens::robot::RobotModel& model, const std::string& name) {
  const int link = model.link_index(name);
  for (const Geometry& geometry : model.links()[static_cast<std::size_t>(link)].collision) {
    if (const auto* cylinder = std::get_if<Cylinder>(&geometry.shape)) {
      const Eigen::Vector3d half(0.0, 0.0, 0.5 * cylinder->length);
      return {link, geometry.X_BG * Eigen::Vector3d(-half), geometry.X_BG * half, cylinder->radius};
    }
  }
  throw std::invalid_argument("simulated_postures: link " + name + " has no cylinder");
}

double half_extent(const opponens::robot::Shape& object, const Eigen::Vector3d& direction) {
  if (const auto* sphere = std::get_if<opponens::robot::Sphere>(&object)) return sphere->radius;
  if (const auto* box = std::get_if<opponens::robot::Box>(&object)) return 0.5 * direction.cwiseAbs().dot(box->size);
  const auto& cylinder = std::get<Cylinder>(object);
  return cylinder.radius * direction.head<2>().norm() + 0.5 * cylinder.length * std::abs(direction.z());
}

/// The palm's own geometry, in the palm frame: the box nearest to the object's side.
double palm_surface(const Hand& hand) {
  double surface = 0.0;
  for (const Geometry& geometry : hand.model.links()[static_cast<std::size_t>(hand.model.palm())].collision) {
    if (const auto* box = std::get_if<opponens::robot::Box>(&geometry.shape)) {
      surface = std::max(surface, geometry.X_BG.translation().x() + 0.5 * box->size.x());
    }
  }
  return surface;
}

/// Moves the object by half millimetres along `way` until the named fingers, at the start, are clear of it.
void push_clear(const Hand& hand, const opponens::robot::Shape& object, const Poses& poses,
                const std::vector<std::string>& fingers, const Eigen::Vector3d& way, Eigen::Isometry3d& X_PO) {
  const Eigen::Isometry3d& X_WP = poses[static_cast<std::size_t>(hand.model.palm())];
  const auto clear = [&] {
    for (const std::string& name : fingers) {
      for (const Capsule& segment : hand.fingers.at(name).segments) {
        const Eigen::Isometry3d& X_WL = poses[static_cast<std::size_t>(segment.link)];
        if (signed_distance({object, X_PO}, X_WP, segment, X_WL) < 0.0) return false;
      }
    }
    return true;
  };
  for (int i = 0; i < 100 && !clear(); ++i) X_PO.translation() += 5e-4 * way;
}

/// z along the axis, x as near as possible to the given direction.
Eigen::Matrix3d frame(const Eigen::Vector3d& axis, const Eigen::Vector3d& near_x) {
  Eigen::Matrix3d R;
  R.col(2) = axis;
  R.col(1) = axis.cross(near_x).normalized();
  R.col(0) = R.col(1).cross(axis);
  return R;
}

/// What the fingers must not press into, with the poses of one trial posture.
class Closing {
 public:
  Closing(const Hand& hand, Geometry object) : hand_(hand), object_(std::move(object)) {}

  bool presses(const Finger& finger, const Eigen::VectorXd& q) {
    hand_.model.link_poses(q, poses_);
    const auto palm = static_cast<std::size_t>(hand_.model.palm());
    for (std::size_t s = 0; s < finger.segments.size(); ++s) {
      const Capsule& segment = finger.segments[s];
      const Eigen::Isometry3d& X_WL = poses_[static_cast<std::size_t>(segment.link)];
      if (signed_distance(object_, poses_[palm], segment, X_WL) < 0.0) return true;
      if (s == 0) continue;  // the first segment lies against the palm by construction
      for (const Geometry& geometry : hand_.model.links()[palm].collision) {
        if (signed_distance(geometry, poses_[palm], segment, X_WL) < 0.0) return true;
      }
      if (finger.name == "thumb" && meets_finger(segment, X_WL)) return true;
    }
    return false;
  }

  void close(const Finger& finger, const Eigen::Vector3d& rate, Eigen::VectorXd& q) {
    if (presses(finger, q)) {
      throw std::runtime_error("simulated_postures: " + finger.name +
                               " starts inside the object, the palm or a finger");
    }
    std::vector<bool> moving(finger.joints.size(), true);
    for (int step = 0; step < kMaxSteps && std::find(moving.begin(), moving.end(), true) != moving.end(); ++step) {
      for (std::size_t j = 0; j < finger.joints.size(); ++j) {
        if (!moving[j]) continue;
        const int joint = finger.joints[j];
        const double before = q[joint];
        q[joint] = std::clamp(before + rate[static_cast<Eigen::Index>(j)] * kStep, hand_.model.lower()[joint],
                              hand_.model.upper()[joint]);
        if (q[joint] != before && !presses(finger, q)) continue;
        q[joint] = before;
        moving[j] = false;
      }
    }
  }

  bool touches(const Finger& finger, const Eigen::VectorXd& q) { return !touching(finger, q).empty(); }

  std::vector<std::string> touching(const Finger& finger, const Eigen::VectorXd& q) {
    hand_.model.link_poses(q, poses_);
    const Eigen::Isometry3d& X_WP = poses_[static_cast<std::size_t>(hand_.model.palm())];
    std::vector<std::string> names;
    for (const Capsule& segment : finger.segments) {
      const auto link = static_cast<std::size_t>(segment.link);
      if (signed_distance(object_, X_WP, segment, poses_[link]) < kTouch) {
        names.push_back(hand_.model.links()[link].name);
      }
    }
    return names;
  }

 private:
  bool meets_finger(const Capsule& segment, const Eigen::Isometry3d& X_WL) const {
    for (const auto& [name, other] : hand_.fingers) {
      if (name == "thumb") continue;
      for (const Capsule& capsule : other.segments) {
        if (gap(segment, X_WL, capsule, poses_[static_cast<std::size_t>(capsule.link)]) < 0.0) return true;
      }
    }
    return false;
  }

  const Hand& hand_;
  Geometry object_;
  Poses poses_;
};

}  // namespace

Hand::Hand(opponens::robot::RobotDescription description) : model(std::move(description)) {
  const std::vector<std::pair<std::string, std::string>> names{
      {"index", "I"}, {"middle", "M"}, {"ring", "R"}, {"little", "L"}};
  for (const auto& [name, letter] : names) {
    Finger finger{name, {}, {}, Eigen::Vector3d::Zero()};
    for (const char* joint : {"MCP", "PIP", "DIP"}) finger.joints.push_back(channel(letter + "_" + joint));
    for (const char* link : {"_mcp", "_pip", "_dip"}) finger.segments.push_back(capsule_of(model, name + link));
    fingers[name] = finger;
  }
  Finger thumb{"thumb", {channel("T_ABD"), channel("T_MCP"), channel("T_IP")}, {}, Eigen::Vector3d::Zero()};
  for (const char* link : {"thumb_metacarpal", "thumb_mcp", "thumb_ip"}) {
    thumb.segments.push_back(capsule_of(model, link));
  }
  fingers["thumb"] = thumb;
  for (const auto& tip : model.description().tips) fingers.at(tip.finger).tip = tip.p_L;
}

int Hand::channel(const std::string& name) const {
  const auto& names = model.joint_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::invalid_argument("simulated_postures: the hand has no channel " + name);
  return static_cast<int>(found - names.begin());
}

Eigen::Isometry3d place_object(const Hand& hand, const opponens::robot::Shape& object, const GraspSpec& spec) {
  const Poses poses = hand.model.link_poses(spec.start);
  const Eigen::Isometry3d X_PW = poses[static_cast<std::size_t>(hand.model.palm())].inverse();
  const auto tip = [&](const std::string& name) -> Eigen::Vector3d {
    const Finger& finger = hand.fingers.at(name);
    return X_PW * poses[static_cast<std::size_t>(finger.segments.back().link)] * finger.tip;
  };
  Eigen::Isometry3d X_PO = Eigen::Isometry3d::Identity();
  X_PO.translation() = spec.at;
  if (spec.place == Place::palm) {
    const bool faces_palm = std::abs(spec.axis.x()) > 0.9;
    X_PO.linear() = frame(spec.axis, faces_palm ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX());
    const Eigen::Vector3d out = X_PO.linear().transpose() * Eigen::Vector3d::UnitX();
    X_PO.translation().x() += palm_surface(hand) + half_extent(object, out);
    // A bent palm arch puts the ring and little finger in front of the palm.
    push_clear(hand, object, poses, {"thumb", "index", "middle", "ring", "little"}, Eigen::Vector3d::UnitX(), X_PO);
  } else if (spec.place != Place::index) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const std::string& name : spec.fingers) mean += tip(name) / static_cast<double>(spec.fingers.size());
    const Eigen::Vector3d line = mean - tip("thumb");
    const Eigen::Vector3d axis =
        spec.place == Place::rim ? line.cross(Eigen::Vector3d::UnitY()).normalized() : spec.axis;
    X_PO.linear() = frame(axis, line);
    X_PO.translation() += 0.5 * (tip("thumb") + mean);
    push_clear(hand, object, poses, {"index", "middle", "ring", "little"}, -line.normalized(), X_PO);
  } else {
    const Capsule& middle = hand.fingers.at("index").segments[1];
    const Eigen::Isometry3d X_PL = X_PW * poses[static_cast<std::size_t>(middle.link)];
    // Flat against the radial side of the segment: the object's x, its thin direction, along the segment's y.
    Eigen::Matrix3d R_LO;
    R_LO.col(0) = Eigen::Vector3d::UnitY();
    R_LO.col(1) = -Eigen::Vector3d::UnitX();
    R_LO.col(2) = Eigen::Vector3d::UnitZ();
    X_PO.linear() = X_PL.linear() * R_LO;
    const double beside = middle.radius + half_extent(object, Eigen::Vector3d::UnitX());
    X_PO.translation() += X_PL * Eigen::Vector3d(0.5 * (middle.a + middle.b) + beside * Eigen::Vector3d::UnitY());
  }
  return X_PO;
}

Closed close_hand(const Hand& hand, const opponens::robot::Shape& object, const GraspSpec& spec) {
  Closing closing(hand, {object, place_object(hand, object, spec)});
  Closed result;
  result.posture = spec.start;
  const Finger* neighbour = nullptr;
  for (const std::string& name : spec.fingers) {
    const Finger& finger = hand.fingers.at(name);
    closing.close(finger, spec.rate, result.posture);
    if (!closing.touches(finger, result.posture)) {
      if (neighbour == nullptr) throw std::runtime_error("simulated_postures: " + name + " misses the object");
      for (std::size_t j = 0; j < finger.joints.size(); ++j) {
        result.posture[finger.joints[j]] = result.posture[neighbour->joints[j]];
      }
    }
    neighbour = &finger;
  }
  closing.close(hand.fingers.at("thumb"), spec.thumb_rate, result.posture);
  for (const auto& [name, finger] : hand.fingers) {
    const std::vector<std::string> links = closing.touching(finger, result.posture);
    result.touching.insert(result.touching.end(), links.begin(), links.end());
  }
  return result;
}

}  // namespace simulated_postures
