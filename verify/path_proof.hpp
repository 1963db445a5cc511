// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "robot/motion_bound.hpp"
#include "robot/robot_model.hpp"
#include "verify/bodies.hpp"

namespace opponens::verify {

struct ProofSettings {
  double clearance = 0.0005;         ///< m, that every pair has to keep
  double max_penetration = 0.001;    ///< m, of the contacts while closing
  double resolution = 1e-6;          ///< m, of relative motion: shorter pieces are not divided any more
  double relative_gap = 0.1;         ///< the proven clearance is at least 1 - this of the worst that was found
  double penetration_gap = 0.00025;  ///< m, by which the proven penetration may exceed the deepest that was found
};

/// A place on a path: on the segment from waypoint - 1 to waypoint.
struct Place {
  int waypoint = 0;
  double fraction = 1.0;
};

/// Proves what a path keeps away from, by conservative advancement: a pair whose distance is d in the middle of a piece
/// of a segment, and whose distance changes by at most h between there and the piece's ends (robot::MotionBound), keeps
/// d - h on it; where that is not enough the piece is halved, for the pairs that need it. Bounding volumes first, then
/// fcl::distance, looked for only below what is needed and not where a cheap upper bound tells that the piece is
/// halved. Solids inside each other are found at the first waypoint: after that their surfaces would have to meet.
class PathProof {
 public:
  using NamePair = std::pair<std::string, std::string>;  ///< link, and link or scene body

  /// contacts: pairs (link, object) that may touch while closing. All but the settings are referred to.
  PathProof(const robot::RobotModel& robot, const robot::MotionBound& bound, Bodies& bodies,
            const std::set<NamePair>& contacts, const ProofSettings& settings);

  /// Looks at a waypoint alone: [d] rad. Doing this for all of them before the segments gives sharper limits to start
  /// with. first: look for solids inside each other too.
  void visit(const Eigen::VectorXd& q, int waypoint, bool closing, bool first);
  /// Proves the segment that ends at a waypoint.
  void prove(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to, int waypoint, bool closing);

  /// The least found of a pair of names, m; 0: a collision.
  struct Found {
    double distance = std::numeric_limits<double>::infinity();
    Place place;
    bool proven = true;  ///< false: a piece was left at the resolution with less than the clearance proven
  };
  const std::map<NamePair, Found>& found() const { return found_; }
  /// m, no pair comes nearer anywhere, contacts on the closing segment apart.
  double proven_clearance() const { return proven_clearance_; }

  struct Contact {
    double attained = 0.0;  ///< m, deepest found
    double proven = 0.0;    ///< m, no deeper anywhere
    Place place;
  };
  const std::map<NamePair, Contact>& contacts() const { return touching_; }

  std::int64_t configurations() const { return configurations_; }
  std::int64_t distances() const { return distances_; }  ///< asked of fcl

 private:
  struct Piece;
  void place(const Eigen::VectorXd& q);
  bool is_contact(std::size_t pair, bool closing) const { return closing && contact_[pair] != nullptr; }
  double needed(const Found& found) const;
  double distance(std::size_t pair, double bound, const Place& place);
  void note(Found& found, double distance, const Place& place);
  void divide(const Piece& piece, const std::vector<std::size_t>& pairs);
  bool settled(std::size_t pair, double change, const Place& place);
  bool contact_settled(std::size_t pair, double change, const Place& place);
  void look_at_contact(std::size_t pair, const Place& place);

  const robot::RobotModel& robot_;
  const robot::MotionBound& bound_;
  Bodies& bodies_;
  ProofSettings settings_;
  std::map<NamePair, Found> found_;
  std::map<NamePair, Contact> touching_;
  std::vector<Found*> found_of_;          ///< [pairs]
  std::vector<Contact*> contact_;         ///< [pairs] null: not a contact
  std::vector<Bodies::NearPoints> near_;  ///< [pairs] where they were nearest when last looked at
  std::vector<double> depth_;             ///< [pairs] m, of contacts when last looked at
  std::vector<std::size_t> all_;          ///< [pairs] their indices
  std::vector<Eigen::Isometry3d> X_RL_;
  robot::LinkTravel travel_;
  double worst_ = std::numeric_limits<double>::infinity();
  double proven_clearance_ = std::numeric_limits<double>::infinity();
  double deepest_ = 0.0;
  std::int64_t configurations_ = 0;
  std::int64_t distances_ = 0;
};

}  // namespace opponens::verify
