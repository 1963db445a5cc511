// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/pair_gaps.hpp"

#include <algorithm>
#include <limits>

#include "robot/collision_world.hpp"
#include "robot/mesh_gap.hpp"

namespace opponens::robot {

namespace {

// m; how far apart two limits may be at most for each to be worth its cost: hulls take 0.5 us, pieces 5 us, triangles
// 50 us (`continuous_benchmark`).
constexpr double kHullsWithin = 0.1;
constexpr double kPiecesWithin = 0.004;
constexpr double kTrianglesWithin = 0.001;
constexpr double kWithin = 2e-6;  ///< m, of a distance of triangles

}  // namespace

PairGaps::PairGaps(const CollisionChecker& checker) : world_(checker.shapes()) {
  const Eigen::Isometry3d X_RW = world_.X_WR.inverse();
  for (int i = 0; i < static_cast<int>(world_.parts.size()); ++i) {
    const CollisionPart& part = world_.parts[static_cast<std::size_t>(i)];
    X_BG_.push_back(world_.of_scene(i) ? X_RW * part.X_BG : part.X_BG);
    center_.emplace_back(X_BG_.back() * part.shape.center());
  }
  world_.any_pair([&](int a, int b) {
    const int link_b = world_.of_scene(b) ? -1 : world_.parts[static_cast<std::size_t>(b)].body;
    pairs_.push_back({a, b, world_.parts[static_cast<std::size_t>(a)].body, link_b,
                      world_.shape(a).radius() + world_.shape(b).radius()});
    return false;
  });
}

BodyPair PairGaps::names(const Pair& pair) const { return world_.names_of(pair.a, pair.b); }

void PairGaps::reset(Places& places) const {
  places.away_.assign(pairs_.size(), Eigen::Vector3d::Zero());
  places.pieces_.assign(pairs_.size(), {-1, -1});
  places.center_ = center_;
  places.X_RG_ = X_BG_;
  places.known_.assign(X_BG_.size(), 0);
  places.number_ = 0;
}

void PairGaps::place(const std::vector<Eigen::Isometry3d>& X_RL, Places& places) const {
  places.X_RL_ = &X_RL;
  ++places.number_;
  for (std::size_t i = 0; i < static_cast<std::size_t>(world_.robot_parts); ++i) {
    places.center_[i] = X_RL[static_cast<std::size_t>(world_.parts[i].body)] * center_[i];
  }
}

const Eigen::Isometry3d& PairGaps::pose(int part, Places& places) const {
  const auto i = static_cast<std::size_t>(part);
  if (!world_.of_scene(part) && places.known_[i] != places.number_) {
    places.X_RG_[i] = (*places.X_RL_)[static_cast<std::size_t>(world_.parts[i].body)] * X_BG_[i];
    places.known_[i] = places.number_;
  }
  return places.X_RG_[i];
}

GapBounds PairGaps::gap(std::size_t index, Places& places, double needed, double enough) const {
  const Pair& pair = pairs_[index];
  const CollisionShape& A = world_.shape(pair.a);
  const CollisionShape& B = world_.shape(pair.b);
  const Eigen::Isometry3d& X_RA = pose(pair.a, places);
  const Eigen::Isometry3d& X_RB = pose(pair.b, places);
  const double boxes = box_gap({places.center_[static_cast<std::size_t>(pair.a)], X_RA.linear(), A.half_extents()},
                               {places.center_[static_cast<std::size_t>(pair.b)], X_RB.linear(), B.half_extents()});
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  const double apart = enough - needed;
  if (boxes >= enough || apart > kHullsWithin) return {boxes, kOpen};
  const bool meshes = world_.is_mesh(pair.a) || world_.is_mesh(pair.b);
  const bool exact = apart <= kTrianglesWithin;
  // Of what is halved anyway, or is looked at in pieces, it is enough to know whether the hulls are far enough apart.
  const GapBounds hulls = convex_gap(convex_solid(A), convex_solid(B), relative_pose(X_RA, X_RB),
                                     exact && !meshes ? needed : enough, enough, places.away_[index]);
  if (!meshes || hulls.lower >= enough || apart > kPiecesWithin) return {hulls.lower, meshes ? kOpen : hulls.upper};
  if (!exact) {
    auto& [a, b] = places.pieces_[index];
    LeafPair last{a, b};
    const bool keep = pieces_keep(A, X_RA, B, X_RB, enough, last);
    a = last.a;
    b = last.b;
    return {keep ? enough : 0.0, kOpen};
  }
  const double distance = mesh_distance(A, X_RA, B, X_RB, needed, enough);
  return {distance, distance < enough ? distance + kWithin : kOpen};
}

}  // namespace opponens::robot
