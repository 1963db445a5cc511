// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "comparisons.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "robot/narrow_phase.hpp"

namespace opponens::experiments {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using robot::ConfigurationBatch;

constexpr double kSpacing = 0.02;      ///< rad
constexpr double kMotion = 1.0;        ///< rad
constexpr double kBisection = 1e-6;    ///< rad or m
constexpr int kBatch = 1000;           ///< configurations
constexpr int kTriesPerContact = 200;  ///< pairs of configurations

VectorXd uniform(const robot::RobotModel& robot, Rng& rng) {
  VectorXd q(robot.dof());
  for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = rng.uniform(robot.lower()[i], robot.upper()[i]);
  return q;
}

VectorXd near(const robot::RobotModel& robot, const VectorXd& q, Rng& rng) {
  VectorXd other = q;
  for (double& value : other) value += rng.uniform(-kMotion, kMotion);
  return robot.clip(other);
}

void note(Tally& tally, bool truth, bool same, const VectorXd& q, const Isometry3d* X_WR = nullptr) {
  ++tally.configurations;
  tally.free += truth ? 1 : 0;
  if (same) return;
  ++tally.different;
  std::ostringstream text;
  text.precision(17);
  text << (truth ? "free" : "colliding") << " by the truth, q: " << q.transpose();
  if (X_WR != nullptr) text << ", X_WR: " << X_WR->matrix().topRows<3>().reshaped().transpose() << " (by columns)";
  tally.example = text.str();
}

void compare_rows(const Subject& subject, const ConfigurationBatch& rows, Tally& tally) {
  robot::CollisionCounts counts;
  const std::vector<bool> batch = subject.checker.free_rows(rows, &counts);
  const std::vector<bool> portable = subject.portable.free_rows(rows);
  tally.pairs_asked += counts.pairs;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const VectorXd q = rows.row(i);
    const bool truth = subject.checker.exact_free(q);
    const auto k = static_cast<std::size_t>(i);
    note(tally, truth, batch[k] == truth && portable[k] == truth && subject.checker.free(q) == truth, q);
  }
}

void compare_all(const Subject& subject, const std::vector<VectorXd>& configurations, Tally& tally) {
  ConfigurationBatch rows(static_cast<Eigen::Index>(configurations.size()), subject.robot.dof());
  for (std::size_t i = 0; i < configurations.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = configurations[i];
  compare_rows(subject, rows, tally);
}

bool flying_truth(const Subject& hand, const Isometry3d& X_WR, const VectorXd& q) {
  return hand.checker.colliding_pairs(X_WR, q).empty();
}

void compare_pose(const Subject& hand, const Isometry3d& X_WR, const VectorXd& q, Tally& tally) {
  const bool truth = flying_truth(hand, X_WR, q);
  const bool same = hand.checker.free(X_WR, q) == truth && hand.portable.free(X_WR, q) == truth;
  note(tally, truth, same, q, &X_WR);
}

Vector3d random_vector(double size, Rng& rng) {
  return {rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size)};
}

/// A hand near a body.
Isometry3d random_root(const Subject& hand, const VectorXd& q, Rng& rng) {
  Vector3d target = hand.scene.X_WR.translation() + random_vector(0.4, rng);
  if (!hand.scene.bodies.empty()) {
    const robot::SceneBody& body = hand.scene.bodies[rng.index(hand.scene.bodies.size())];
    const robot::Geometry& geometry = body.geometry[rng.index(body.geometry.size())];
    const robot::CollisionShape shape(geometry.shape);
    const Vector3d inside = shape.center() + random_vector(1.0, rng).cwiseProduct(shape.half_extents());
    target = body.X_WB * geometry.X_BG * inside + random_vector(0.15, rng);
  }
  Isometry3d X_WH = Isometry3d::Identity();
  X_WH.linear() =
      Eigen::Quaterniond(rng.normal(), rng.normal(), rng.normal(), rng.normal()).normalized().toRotationMatrix();
  X_WH.translation() = target;
  return X_WH * hand.robot.link_poses(q)[static_cast<std::size_t>(hand.robot.palm())].inverse();
}

}  // namespace

Tally compare_uniform(const Subject& subject, std::int64_t count, Rng& rng) {
  Tally tally;
  while (tally.configurations < count) {
    std::vector<VectorXd> configurations(
        static_cast<std::size_t>(std::min<std::int64_t>(kBatch, count - tally.configurations)));
    for (VectorXd& q : configurations) q = uniform(subject.robot, rng);
    compare_all(subject, configurations, tally);
  }
  return tally;
}

Tally compare_motions(const Subject& subject, std::int64_t count, Rng& rng) {
  Tally tally;
  while (tally.configurations < count) {
    const VectorXd from = uniform(subject.robot, rng);
    const VectorXd to = near(subject.robot, from, rng);
    const int steps = static_cast<int>(std::ceil((to - from).lpNorm<Eigen::Infinity>() / kSpacing));
    std::vector<VectorXd> configurations;
    for (int i = 0; i <= steps; ++i) configurations.emplace_back(from + (to - from) * i / std::max(steps, 1));
    compare_all(subject, configurations, tally);
  }
  return tally;
}

Tally compare_contacts(const Subject& subject, std::int64_t count, Rng& rng) {
  Tally tally;
  std::vector<VectorXd> ends;
  const auto flush = [&] {
    compare_all(subject, ends, tally);
    ends.clear();
  };
  for (std::int64_t tries = 0; tries < count * kTriesPerContact; ++tries) {
    if (tally.configurations + static_cast<std::int64_t>(ends.size()) >= count) break;
    VectorXd a = uniform(subject.robot, rng);
    VectorXd b = near(subject.robot, a, rng);
    const bool free = subject.checker.exact_free(a);
    if (subject.checker.exact_free(b) == free) continue;
    while ((b - a).lpNorm<Eigen::Infinity>() > kBisection) {
      const VectorXd middle = 0.5 * (a + b);
      (subject.checker.exact_free(middle) == free ? a : b) = middle;
    }
    ends.insert(ends.end(), {a, b});
    if (ends.size() >= kBatch) flush();
  }
  if (!ends.empty()) flush();
  return tally;
}

Tally compare_flying(const Subject& hand, std::int64_t count, Rng& rng) {
  Tally tally;
  while (tally.configurations < count) {
    const VectorXd q = uniform(hand.robot, rng);
    compare_pose(hand, random_root(hand, q, rng), q, tally);
  }
  return tally;
}

Tally compare_flying_contacts(const Subject& hand, std::int64_t count, Rng& rng) {
  Tally tally;
  for (std::int64_t tries = 0; tally.configurations < count && tries < count * kTriesPerContact; ++tries) {
    const VectorXd q = uniform(hand.robot, rng);
    Isometry3d X_a = random_root(hand, q, rng);
    Isometry3d X_b = X_a;
    X_b.translation() += random_vector(0.3, rng);
    const bool free = flying_truth(hand, X_a, q);
    if (flying_truth(hand, X_b, q) == free) continue;
    while ((X_b.translation() - X_a.translation()).norm() > kBisection) {
      Isometry3d X = X_a;
      X.translation() = 0.5 * (X_a.translation() + X_b.translation());
      (flying_truth(hand, X, q) == free ? X_a : X_b) = X;
    }
    compare_pose(hand, X_a, q, tally);
    compare_pose(hand, X_b, q, tally);
  }
  return tally;
}

}  // namespace opponens::experiments
