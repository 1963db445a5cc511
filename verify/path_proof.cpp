// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/path_proof.hpp"

#include <algorithm>
#include <numeric>

#include "core/require.hpp"

namespace opponens::verify {

struct PathProof::Piece {
  const Eigen::VectorXd& q_from;  ///< of the whole segment
  const Eigen::VectorXd& step;
  const Eigen::VectorXd& joint_step;  ///< [joints] of the whole segment
  int waypoint;
  bool closing;
  double begin;  ///< fraction
  double end;
};

PathProof::PathProof(const robot::RobotModel& robot, const robot::MotionBound& bound, Bodies& bodies,
                     const std::set<NamePair>& contacts, const ProofSettings& settings)
    : robot_(robot), bound_(bound), bodies_(bodies), settings_(settings) {
  require(settings.clearance > 0.0 && settings.max_penetration >= 0.0 && settings.resolution > 0.0 &&
              settings.relative_gap > 0.0 && settings.relative_gap < 1.0 && settings.penetration_gap > 0.0,
          "ProofSettings: lengths must be positive, relative_gap between 0 and 1");
  for (const Bodies::Pair& pair : bodies.pairs()) {
    const NamePair names{bodies.name(pair.first), bodies.name(pair.second)};
    found_of_.push_back(&found_[names]);
    const bool contact = bodies.link(pair.second) < 0 && contacts.count(names) == 1;
    near_.push_back(bodies.points(pair));
    contact_.push_back(contact ? &touching_[names] : nullptr);
  }
  depth_.resize(found_of_.size(), 0.0);
  all_.resize(found_of_.size());
  std::iota(all_.begin(), all_.end(), 0);
}

void PathProof::place(const Eigen::VectorXd& q) {
  robot_.link_poses(q, X_RL_);
  bodies_.place(X_RL_);
  ++configurations_;
}

/// The clearance that a piece has to have for a pair. A pair that was found to fail is only followed to its worst.
double PathProof::needed(const Found& found) const {
  const double share = 1.0 - settings_.relative_gap;
  if (found.distance < settings_.clearance) return share * found.distance;
  return std::max(settings_.clearance, share * worst_);
}

void PathProof::note(Found& found, double distance, const Place& place) {
  if (distance < found.distance) {
    found.distance = distance;
    found.place = place;
  }
  worst_ = std::min(worst_, distance);
  if (distance == 0.0) proven_clearance_ = 0.0;
}

/// The distance of a pair, or `bound` when it is not nearer than that. What is nearer is noted.
double PathProof::distance(std::size_t pair, double bound, const Place& place) {
  ++distances_;
  const double distance = bodies_.distance(bodies_.pairs()[pair], bound, near_[pair]);
  if (distance < bound) note(*found_of_[pair], distance, place);
  return distance;
}

void PathProof::visit(const Eigen::VectorXd& q, int waypoint, bool closing, bool first) {
  place(q);
  const Place here{waypoint, 1.0};
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (is_contact(i, closing)) {
      look_at_contact(i, here);
      continue;
    }
    const Bodies::Pair& pair = bodies_.pairs()[i];
    const double bound = std::max(worst_, settings_.clearance);
    const double gap = bodies_.gap(pair, bound);
    if (first && gap == 0.0 && bodies_.contained(pair)) note(*found_of_[i], 0.0, here);
    if (gap < bound && found_of_[i]->distance > 0.0) distance(i, bound, here);
  }
}

void PathProof::look_at_contact(std::size_t pair, const Place& place) {
  Contact& contact = *contact_[pair];
  if (bodies_.gap(bodies_.pairs()[pair], 0.0) > 0.0 || contact.attained > settings_.max_penetration) return;
  const double depth = bodies_.depth(bodies_.pairs()[pair], 0.0).attained;
  depth_[pair] = depth;
  if (depth > contact.attained) contact = {depth, std::max(contact.proven, depth), place};
  deepest_ = std::max(deepest_, depth);
}

void PathProof::prove(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to, int waypoint, bool closing) {
  const Eigen::VectorXd step = q_to - q_from;
  const Eigen::VectorXd joint_step = robot_.joint_positions(q_to) - robot_.joint_positions(q_from);
  divide({q_from, step, joint_step, waypoint, closing, 0.0, 1.0}, all_);
}

void PathProof::divide(const Piece& piece, const std::vector<std::size_t>& pairs) {
  const double middle = 0.5 * (piece.begin + piece.end);
  place(piece.q_from + middle * piece.step);
  bound_.travel(X_RL_, (piece.end - piece.begin) * piece.joint_step, travel_);
  const Place here{piece.waypoint, middle};
  std::vector<std::size_t> open;
  for (const std::size_t i : pairs) {
    const int a = bodies_.link(bodies_.pairs()[i].first);
    const int b = bodies_.link(bodies_.pairs()[i].second);
    const double change = 0.5 * (b < 0 ? bound_.of_link(travel_, a) : bound_.between(travel_, a, b));
    const bool done = is_contact(i, piece.closing) ? contact_settled(i, change, here) : settled(i, change, here);
    if (!done) open.push_back(i);
  }
  if (open.empty()) return;
  Piece half = piece;
  half.end = middle;
  divide(half, open);
  half.begin = middle;
  half.end = piece.end;
  divide(half, open);
}

bool PathProof::settled(std::size_t index, double change, const Place& place) {
  Found& found = *found_of_[index];
  if (found.distance == 0.0) return true;  // nothing worse can be found
  const Bodies::Pair& pair = bodies_.pairs()[index];
  double enough = needed(found) + change;
  double gap = bodies_.gap(pair, enough);
  if (gap < enough) {
    // Two points too near to each other tell that this piece is halved, however far exactly the surfaces are apart.
    double apart = bodies_.apart(pair, near_[index]);
    if (apart >= enough) apart = bodies_.approach(pair, enough);
    if (apart < enough && apart >= worst_ && change > settings_.resolution) return false;
    gap = distance(index, enough, place);
    enough = needed(found) + change;
  }
  const bool settled = gap >= enough;
  if (!settled && change > settings_.resolution) return false;
  const double proven = std::max(0.0, gap - change);
  proven_clearance_ = std::min(proven_clearance_, proven);
  if (!settled && proven < settings_.clearance) found.proven = false;
  return true;
}

bool PathProof::contact_settled(std::size_t index, double change, const Place& place) {
  Contact& contact = *contact_[index];
  if (contact.attained > settings_.max_penetration) return true;  // it has failed
  const Bodies::Pair& pair = bodies_.pairs()[index];
  const double allowed = std::min(settings_.max_penetration, deepest_ + settings_.penetration_gap);
  const auto settle = [&contact](double depth) {
    contact.proven = std::max(contact.proven, depth);
    return true;
  };
  // What is outside and apart gets no deeper than it moves beyond its distance.
  const double gap = bodies_.gap(pair, change);
  if (gap > 0.0 && change - gap <= allowed) return settle(change - gap);
  ++distances_;
  const double distance = bodies_.distance(pair, change);
  if (distance > 0.0 && change - distance <= allowed && !bodies_.contained(pair)) return settle(change - distance);
  if (change > allowed && change > settings_.resolution) return false;
  // As deep as where it was last looked at, this piece would be halved.
  if (depth_[index] + change > allowed && change > settings_.resolution) return false;
  const Depth depth = bodies_.depth(pair, allowed - change);
  depth_[index] = depth.attained;
  if (depth.attained > contact.attained) {
    contact.attained = depth.attained;
    contact.place = place;
    deepest_ = std::max(deepest_, depth.attained);
  }
  const bool settled = depth.bound + change <= allowed;
  return settled || change <= settings_.resolution ? settle(depth.bound + change) : false;
}

}  // namespace opponens::verify
