// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/continuous_check.hpp"

#include <algorithm>
#include <cmath>

#include "core/require.hpp"

namespace opponens::motion {
namespace {

constexpr double kShareAtStart =
    0.9;  ///< of a distance at the start, which a motion along a surface cannot keep wholly

/// A motion's bounds are found anew at every so many halvings: they come down to the travel itself as motions get
/// short, and the bounds of a motion hold for its parts by their share.
constexpr int kBoundEvery = 2;

constexpr double kSlice = 0.0009;  ///< m; limits that close are told apart exactly by PairGaps

/// The distance of a pair, or `limit` when that is less, m.
double distance_below(const robot::PairGaps& gaps, std::size_t pair, robot::PairGaps::Places& places, double limit) {
  while (limit > 0.0) {
    const double needed = std::max(0.0, limit - kSlice);
    const robot::GapBounds gap = gaps.gap(pair, places, needed, limit);
    if (gap.lower >= limit || gap.upper >= needed) return std::min(gap.lower, limit);
    limit = needed;
  }
  return 0.0;
}

}  // namespace

/// Room for one motion, to be used again and again.
struct ContinuousCheck::Work {
  Eigen::VectorXd from;
  Eigen::VectorXd step;
  Eigen::VectorXd joint_step;
  std::vector<Eigen::Isometry3d> X_RL;
  std::vector<robot::LinkTravel> travel;  ///< [depth / kBoundEvery]
  robot::PairGaps::Places places;
  std::vector<std::uint32_t> open;  ///< indices of watched pairs, of the parts of the motion that are being divided

  static Work& own() {
    thread_local Work work;
    return work;
  }
};

/// Part of a motion, and its pairs: [first, last) of the open ones.
struct ContinuousCheck::Piece {
  double begin;  ///< fraction
  double end;
  int depth;
  std::size_t first;
  std::size_t last;
};

ContinuousCheck::ContinuousCheck(const robot::CollisionChecker& checker, const robot::RobotModel& robot,
                                 const ClearanceSettings& settings)
    : robot_(robot), settings_(settings), bound_(robot, settings.bound_factor), gaps_(checker) {
  require(std::isfinite(settings.clearance) && settings.clearance >= 0.0 && settings.resolution > 0.0,
          "ClearanceSettings: clearance must be finite and not negative, resolution positive");
  for (std::size_t i = 0; i < gaps_.pairs().size(); ++i) {
    const robot::PairGaps::Pair& pair = gaps_.pairs()[i];
    const robot::MotionBound::Shares shares = bound_.shares(pair.link_a, pair.link_b);
    if (shares.a >= 0 || shares.b >= 0) watched_.push_back({i, shares, settings.clearance});
  }
}

ContinuousCheck ContinuousCheck::starting_at(const Eigen::VectorXd& q) const {
  ContinuousCheck result = *this;
  Work& work = Work::own();
  gaps_.reset(work.places);
  robot_.link_poses(q, work.X_RL);
  gaps_.place(work.X_RL, work.places);
  for (Watched& pair : result.watched_) {
    if (gaps_.ball_gap(gaps_.pairs()[pair.index], work.places) >= pair.needed / kShareAtStart) continue;
    const double enough = pair.needed / kShareAtStart;
    const double lower = distance_below(gaps_, pair.index, work.places, enough);
    if (lower >= enough) continue;
    if (lower < pair.needed) ++result.nearer_;
    pair.needed = kShareAtStart * lower;
  }
  return result;
}

ContinuousCheck ContinuousCheck::without_contacts(const robot::CollisionChecker& closing,
                                                  const std::set<std::string>& links) const {
  ContinuousCheck result = *this;
  const robot::PairGaps kept(closing);
  std::set<robot::BodyPair> checked;
  for (const robot::PairGaps::Pair& pair : kept.pairs()) checked.insert(kept.names(pair));
  std::erase_if(result.watched_, [&](const Watched& pair) {
    const robot::BodyPair names = gaps_.names(gaps_.pairs()[pair.index]);
    return (links.contains(names.first) || links.contains(names.second)) && !checked.contains(names);
  });
  return result;
}

bool ContinuousCheck::keeps(const Eigen::VectorXd& q) const {
  Work& work = Work::own();
  gaps_.reset(work.places);
  robot_.link_poses(q, work.X_RL);
  gaps_.place(work.X_RL, work.places);
  return std::all_of(watched_.begin(), watched_.end(), [&](const Watched& pair) {
    return gaps_.ball_gap(gaps_.pairs()[pair.index], work.places) >= pair.needed ||
           gaps_.gap(pair.index, work.places, pair.needed, pair.needed).lower >= pair.needed;
  });
}

std::optional<double> ContinuousCheck::first_near(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to,
                                                  std::int64_t& checks) const {
  Work& work = Work::own();
  gaps_.reset(work.places);
  work.from = q_from;
  work.step = q_to - q_from;
  require(work.step.size() == robot_.dof() && work.step.allFinite(), "first_near: configurations must be finite");
  work.joint_step = robot_.joint_positions(q_to) - robot_.joint_positions(q_from);
  work.open.resize(watched_.size());
  for (std::size_t i = 0; i < watched_.size(); ++i) work.open[i] = static_cast<std::uint32_t>(i);
  return divide({0.0, 1.0, 0, 0, watched_.size()}, work, checks);
}

/// Proves a part of the motion, or halves it for the pairs that remain.
std::optional<double> ContinuousCheck::divide(const Piece& piece, Work& work, std::int64_t& checks) const {
  ++checks;
  const std::size_t end = work.open.size();
  if (const auto near = look(piece, work)) return near;
  if (work.open.size() == end) return std::nullopt;
  const double middle = 0.5 * (piece.begin + piece.end);
  const std::size_t last = work.open.size();
  if (const auto near = divide({piece.begin, middle, piece.depth + 1, end, last}, work, checks)) return near;
  if (const auto near = divide({middle, piece.end, piece.depth + 1, end, last}, work, checks)) return near;
  work.open.resize(end);
  return std::nullopt;
}

/// Looks at the middle of a part of the motion and appends the pairs for which that is not enough to the open ones.
std::optional<double> ContinuousCheck::look(const Piece& piece, Work& work) const {
  const double middle = 0.5 * (piece.begin + piece.end);
  robot_.link_poses(work.from + middle * work.step, work.X_RL);
  gaps_.place(work.X_RL, work.places);
  const auto level = static_cast<std::size_t>(piece.depth / kBoundEvery);
  const int below = piece.depth % kBoundEvery;
  if (work.travel.size() <= level) work.travel.resize(level + 1);
  robot::LinkTravel& travel = work.travel[level];
  if (below == 0) bound_.travel(work.X_RL, (piece.end - piece.begin) * work.joint_step, travel);
  const double share = std::ldexp(0.5, -below);  // of a piece, from its middle to its ends
  for (std::size_t k = piece.first; k < piece.last; ++k) {
    const std::uint32_t i = work.open[k];
    const Watched& pair = watched_[i];
    const double change = bound_.of_part(travel, pair.shares, share);
    const double enough = pair.needed + change;
    if (gaps_.ball_gap(gaps_.pairs()[pair.index], work.places) >= enough) continue;
    const robot::GapBounds gap = gaps_.gap(pair.index, work.places, pair.needed, enough);
    if (gap.lower >= enough) continue;
    if (gap.upper < pair.needed || change <= settings_.resolution) return middle;
    work.open.push_back(i);
  }
  return std::nullopt;
}

}  // namespace opponens::motion
