// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/tip_seed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "analysis/synergy_box.hpp"
#include "grasp/random_vector.hpp"

namespace opponens::grasp {
namespace {

constexpr int kChords = 10;
constexpr int kShapes = 12;
constexpr double kChordTilt = 0.35;    // rad
constexpr double kFarthest = 0.3;      // m, no hand opens that far
constexpr double kLeastStep = 0.0005;  // m, of a march through the object

struct Chord {
  Eigen::Vector3d from, to;
};

std::optional<Chord> draw_chord(const PrecisionSpace& space, Rng& rng) {
  for (int i = 0; i < kChords; ++i) {
    const SurfaceSeed start = sample_surface(space.target, rng);
    const Eigen::Vector3d any = normal_vector(rng);
    const double tilt = std::tan(kChordTilt * std::sqrt(rng.uniform()));
    const Eigen::Vector3d side = (any - any.dot(start.n_O) * start.n_O).normalized();
    const Eigen::Vector3d direction = (tilt * side - start.n_O).normalized();
    // Inside, the depth is a step that stays inside.
    double length = 2.0 * kLeastStep;
    while (length < kFarthest) {
      const double d = space.target.grid->value(start.p_O + length * direction);
      if (d > 0.0) return Chord{start.p_O, start.p_O + length * direction};
      length += std::max(-d, kLeastStep);
    }
  }
  return std::nullopt;
}

struct Pinch {
  Eigen::VectorXd y;
  Eigen::Vector3d thumb, others;  ///< p_H of the opposing tip, and the middle of the others
};

Pinch pinch_of(const PrecisionSpace& space, Eigen::VectorXd y, std::size_t opposing) {
  const auto X_HL = space.hand.link_poses(space.hand.clip(analysis::configuration(space.box, y)));
  Pinch pinch{std::move(y), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (std::size_t i = 0; i < space.tips.size(); ++i) {
    const Eigen::Vector3d p_H = X_HL[static_cast<std::size_t>(space.tips[i].link)] * space.tips[i].center_L;
    if (i == opposing) {
      pinch.thumb = p_H;
    } else {
      pinch.others += p_H / static_cast<double>(space.tips.size() - 1);
    }
  }
  return pinch;
}

Pinch draw_pinch(const PrecisionSpace& space, double opening, std::size_t opposing, Rng& rng) {
  Pinch best;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kShapes; ++i) {
    Eigen::VectorXd y(space.box.half_width.size());
    for (Eigen::Index j = 0; j < y.size(); ++j) {
      y[j] = space.box.half_width[j] * 0.5 * (rng.uniform(-1.0, 1.0) + rng.uniform(-1.0, 1.0));
    }
    Pinch pinch = pinch_of(space, std::move(y), opposing);
    const double misfit = std::abs((pinch.others - pinch.thumb).norm() - opening);
    if (misfit >= least) continue;
    least = misfit;
    best = std::move(pinch);
  }
  return best;
}

}  // namespace

std::size_t opposing_tip(const PrecisionSpace& space) {
  for (std::size_t i = 0; i < space.tips.size(); ++i) {
    if (space.tips[i].finger == "thumb") return i;
  }
  const Eigen::VectorXd middle = Eigen::VectorXd::Zero(space.box.half_width.size());
  std::size_t best = 0;
  double farthest = -1.0;
  for (std::size_t i = 0; i < space.tips.size(); ++i) {
    const Pinch pinch = pinch_of(space, middle, i);
    const double apart = (pinch.others - pinch.thumb).norm();
    if (apart <= farthest) continue;
    farthest = apart;
    best = i;
  }
  return best;
}

std::optional<HandSeed> draw_tip_seed(const PrecisionSpace& space, Rng& rng) {
  const auto chord = draw_chord(space, rng);
  if (!chord) return std::nullopt;
  const std::size_t opposing = opposing_tip(space);
  const double ball = space.tips[opposing].radius;
  const Eigen::Vector3d along = chord->to - chord->from;
  const Pinch pinch = draw_pinch(space, along.norm() + 2.0 * ball, opposing, rng);
  const Eigen::Vector3d direction = along.normalized();
  const Eigen::AngleAxisd roll(2.0 * std::numbers::pi * rng.uniform(), direction);
  HandSeed seed;
  seed.y = pinch.y;
  seed.X_OH.linear() = roll.toRotationMatrix() *
                       Eigen::Quaterniond::FromTwoVectors(pinch.others - pinch.thumb, direction).toRotationMatrix();
  seed.X_OH.translation() = 0.5 * (chord->from + chord->to) - seed.X_OH.linear() * (0.5 * (pinch.thumb + pinch.others));
  return seed;
}

std::optional<HandSeed> best_tip_seed(const PrecisionSpace& space, PrecisionProblem& problem, int draws, Rng& rng) {
  std::optional<HandSeed> best;
  double least = std::numeric_limits<double>::infinity();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(problem.size());
  for (int i = 0; i < draws; ++i) {
    auto seed = draw_tip_seed(space, rng);
    if (!seed) break;
    problem.place(*seed);
    x.tail(seed->y.size()) = seed->y;
    const PrecisionValue& value = problem.evaluate(x, false);
    const double cost = value.gaps.cwiseAbs().sum() + value.excess.cwiseMax(0.0).sum() - std::max(value.quality, -1.0);
    if (!(cost < least)) continue;
    least = cost;
    best = std::move(seed);
  }
  return best;
}

}  // namespace opponens::grasp
