// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/motion_bound.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>
#include <utility>
#include <variant>

#include "core/require.hpp"

namespace opponens::robot {
namespace {

/// Largest distance of a shape's points from p, in the shape's frame, m.
struct Farthest {
  Eigen::Vector3d p;

  double operator()(const Box& box) const { return (p.cwiseAbs() + 0.5 * box.size).norm(); }
  double operator()(const Sphere& sphere) const { return p.norm() + sphere.radius; }
  double operator()(const Cylinder& cylinder) const {
    return std::hypot(p.head<2>().norm() + cylinder.radius, std::abs(p.z()) + 0.5 * cylinder.length);
  }
  double operator()(const std::shared_ptr<const TriangleMesh>& mesh) const {
    return std::sqrt((mesh->vertices.colwise() - p).colwise().squaredNorm().maxCoeff());
  }
};

double farthest(const std::vector<Geometry>& geometry, const Eigen::Vector3d& p) {
  double radius = 0.0;
  for (const Geometry& g : geometry) radius = std::max(radius, std::visit(Farthest{g.X_BG.inverse() * p}, g.shape));
  return radius;
}

/// A box around a shape, in the shape's frame.
struct Around {
  Eigen::AlignedBox3d operator()(const Box& box) const { return {-0.5 * box.size, 0.5 * box.size}; }
  Eigen::AlignedBox3d operator()(const Sphere& sphere) const {
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(sphere.radius);
    return {-half, half};
  }
  Eigen::AlignedBox3d operator()(const Cylinder& cylinder) const {
    const Eigen::Vector3d half(cylinder.radius, cylinder.radius, 0.5 * cylinder.length);
    return {-half, half};
  }
  Eigen::AlignedBox3d operator()(const std::shared_ptr<const TriangleMesh>& mesh) const {
    return {mesh->vertices.rowwise().minCoeff(), mesh->vertices.rowwise().maxCoeff()};
  }
};

/// The ball about the middle of the geometry's box in the link.
std::pair<Eigen::Vector3d, double> ball_around(const std::vector<Geometry>& geometry) {
  if (geometry.empty()) return {Eigen::Vector3d::Zero(), 0.0};
  Eigen::AlignedBox3d box;
  for (const Geometry& g : geometry) {
    Eigen::AlignedBox3d around = std::visit(Around{}, g.shape);
    box.extend(around.transformed(g.X_BG));
  }
  const Eigen::Vector3d center = box.center();
  return {center, farthest(geometry, center)};
}

double distance_to_line(const Eigen::Vector3d& p, const Eigen::Vector3d& origin, const Eigen::Vector3d& axis) {
  return axis.cross(p - origin).norm();
}

}  // namespace

MotionBound::MotionBound(const RobotModel& robot, double factor) : factor_(factor) {
  const auto& description = robot.description();
  const Eigen::Index count = static_cast<Eigen::Index>(robot.links().size());
  // A joint that no q moves has the same position everywhere.
  const Eigen::VectorXd moves = robot.joint_positions(Eigen::VectorXd::LinSpaced(robot.dof(), 1.0, 2.0)) -
                                robot.joint_positions(Eigen::VectorXd::Zero(robot.dof()));
  for (const Link& link : robot.links()) {
    Chain chain;
    chain.first = size_;
    for (int j = link.joint; j >= 0;) {
      const Joint& joint = description.joints[static_cast<std::size_t>(j)];
      if (joint.type != JointType::fixed && moves[j] != 0.0) {
        chain.joints.push_back({j, joint.child, joint.type == JointType::revolute, joint.axis});
      }
      j = description.links[static_cast<std::size_t>(joint.parent)].joint;
    }
    std::tie(chain.center, chain.radius) = ball_around(link.collision);
    size_ += chain.joints.size();
    chains_.push_back(std::move(chain));
  }
  shared_.setZero(count, count);
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b < count; ++b) {
      const auto& one = chains_[static_cast<std::size_t>(a)].joints;
      const auto& other = chains_[static_cast<std::size_t>(b)].joints;
      const auto differ = std::mismatch(one.rbegin(), one.rend(), other.rbegin(), other.rend(),
                                        [](const auto& x, const auto& y) { return x.joint == y.joint; });
      shared_(a, b) = static_cast<int>(differ.first - one.rbegin());
    }
  }
}

LinkTravel MotionBound::travel(const std::vector<Eigen::Isometry3d>& X_RL,
                               const Eigen::Ref<const Eigen::VectorXd>& step) const {
  LinkTravel result;
  travel(X_RL, step, result);
  return result;
}

void MotionBound::travel(const std::vector<Eigen::Isometry3d>& X_RL, const Eigen::Ref<const Eigen::VectorXd>& step,
                         LinkTravel& result) const {
  require(X_RL.size() == chains_.size() && step.size() + 1 == static_cast<Eigen::Index>(chains_.size()),
          "MotionBound: link poses or joint steps do not belong to this robot");
  result.sums.resize(size_);
  for (std::size_t l = 0; l < chains_.size(); ++l) {
    const Chain& chain = chains_[l];
    const Eigen::Vector3d center = X_RL[l] * chain.center;
    // Of the joint below: its origin in the middle of the motion, and the farthest that the link's points get from it.
    Eigen::Vector3d below = center;
    double length = chain.radius;
    double slack = 0.0;  // by which the origin below can move in this joint's child frame
    double sum = 0.0;
    for (std::size_t k = 0; k < chain.joints.size(); ++k) {
      const MovingJoint& joint = chain.joints[k];
      const Eigen::Isometry3d& X_RJ = X_RL[static_cast<std::size_t>(joint.link)];
      const Eigen::Vector3d& origin = X_RJ.translation();
      const double moved = std::abs(step[joint.joint]);
      if (joint.revolute) {
        const Eigen::Vector3d axis = X_RJ.linear() * joint.axis;
        const double local = distance_to_line(center, origin, axis) + chain.radius + 0.5 * sum;
        const double chained = distance_to_line(below, origin, axis) + slack + length;
        const double reach = std::min(local, chained);
        length =
            std::min((below - origin).norm() + slack + length, (center - origin).norm() + chain.radius + 0.5 * sum);
        sum += moved * reach;
        slack = 0.0;
        below = origin;
      } else {
        // Sliding along its axis: the points keep their place in its child, whose origin slides in the frame above.
        slack += 0.5 * moved;
        sum += moved;
      }
      result.sums[chain.first + k] = sum;
    }
  }
}

double MotionBound::upper_part(const LinkTravel& travel, int link, std::size_t shared) const {
  const Chain& chain = chains_[static_cast<std::size_t>(link)];
  const std::size_t count = chain.joints.size() - shared;
  return count == 0 ? 0.0 : factor_ * travel.sums[chain.first + count - 1];
}

double MotionBound::of_link(const LinkTravel& travel, int link) const { return upper_part(travel, link, 0); }

double MotionBound::between(const LinkTravel& travel, int link_a, int link_b) const {
  const auto shared = static_cast<std::size_t>(shared_(link_a, link_b));
  return upper_part(travel, link_a, shared) + upper_part(travel, link_b, shared);
}

MotionBound::Shares MotionBound::shares(int link_a, int link_b) const {
  const auto shared = link_b < 0 ? 0 : static_cast<std::size_t>(shared_(link_a, link_b));
  const auto last = [&](int link) {
    if (link < 0) return -1;
    const Chain& chain = chains_[static_cast<std::size_t>(link)];
    return chain.joints.size() == shared ? -1 : static_cast<int>(chain.first + chain.joints.size() - shared) - 1;
  };
  return {last(link_a), last(link_b)};
}

std::vector<double> link_displacements(const RobotModel& robot, const Eigen::Ref<const Eigen::VectorXd>& q_a,
                                       const Eigen::Ref<const Eigen::VectorXd>& q_b) {
  const MotionBound bound(robot);
  const LinkTravel travel =
      bound.travel(robot.link_poses(0.5 * (q_a + q_b)), robot.joint_positions(q_b) - robot.joint_positions(q_a));
  std::vector<double> result;
  for (std::size_t l = 0; l < robot.links().size(); ++l) {
    result.push_back(bound.of_link(travel, static_cast<int>(l)));
  }
  return result;
}

}  // namespace opponens::robot
