// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "robot/collision.hpp"
#include "robot/motion_bound.hpp"
#include "robot/pair_gaps.hpp"
#include "robot/robot_model.hpp"

namespace opponens::motion {

struct ClearanceSettings {
  /// m, that every pair keeps. Above the 0.5 mm that `verify` asks for by default by more than what its polyhedra
  /// around round shapes take away (0.02 mm each).
  double clearance = 0.0006;
  double resolution = 1e-5;   ///< m, of relative motion: parts of a motion below it are not divided any more
  double bound_factor = 1.0;  ///< on robot::MotionBound; below 1 nothing is proven: for tests
};

/// Proves that all pairs a CollisionChecker checks keep a clearance on whole straight motions, not at samples of them:
/// a pair whose distance is d in the middle of a part of a motion, and changes by at most h between there and the
/// part's ends (robot::MotionBound), keeps d - h on it; where that is too little the part is halved, for the pairs that
/// need it (Schwarzer, Saha and Latombe 2005, doi:10.1109/TRO.2004.839232). Distances are robot::PairGaps', known only
/// as far as a decision takes. What does not move relative to each other is left out: it stays as it is.
/// Immutable, thread-safe. Same arguments, same answer.
class ContinuousCheck {
 public:
  /// Both are referred to and must outlive this.
  ContinuousCheck(const robot::CollisionChecker& checker, const robot::RobotModel& robot,
                  const ClearanceSettings& settings = {});

  /// The same check, but a pair that is nearer than the clearance at q ([d] rad; a start that is given, not chosen) has
  /// to keep only 0.9 of what it has there: it may slide along and leave, and all others keep the clearance.
  ContinuousCheck starting_at(const Eigen::VectorXd& q) const;
  /// The same check without the pairs of these links that another checker of this robot and scene leaves out, as the
  /// contacts of a grasp with its object.
  ContinuousCheck without_contacts(const robot::CollisionChecker& closing, const std::set<std::string>& links) const;

  /// A place of the motion q_from to q_to (both inclusive), as a fraction in [0, 1], where the clearance is not kept,
  /// or not proven at the resolution; nullopt when it is kept throughout. That nothing is inside something else is the
  /// caller's to know of one end. Adds the configurations evaluated to checks. [d] rad.
  std::optional<double> first_near(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to,
                                   std::int64_t& checks) const;

  /// Whether all pairs keep the clearance at q, [d] rad.
  bool keeps(const Eigen::VectorXd& q) const;

  /// Pairs whose clearance starting_at made smaller.
  int pairs_nearer_at_start() const { return nearer_; }

 private:
  struct Watched {
    std::size_t index;  ///< of PairGaps
    robot::MotionBound::Shares shares;
    double needed;  ///< m
  };
  struct Work;
  struct Piece;
  std::optional<double> divide(const Piece& piece, Work& work, std::int64_t& checks) const;
  std::optional<double> look(const Piece& piece, Work& work) const;

  const robot::RobotModel& robot_;
  ClearanceSettings settings_;
  robot::MotionBound bound_;
  robot::PairGaps gaps_;
  std::vector<Watched> watched_;
  int nearer_ = 0;
};

}  // namespace opponens::motion
