// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/collision_world.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/require.hpp"

namespace opponens::robot {

namespace {

/// The pairs that are not to be checked, either way round.
std::set<BodyPair> excluded_pairs(const RobotModel& robot, const Scene& scene, const std::vector<BodyPair>& touching) {
  std::set<std::string> known;
  for (const SceneBody& body : scene.bodies) known.insert(body.name);
  for (const Link& link : robot.links()) known.insert(link.name);
  std::set<BodyPair> excluded;
  for (const BodyPair& pair : touching) {
    for (const std::string& name : {pair.first, pair.second}) {
      require(known.count(name) == 1,
              [&] { return "CollisionChecker: touching names '" + name + "', which is absent"; });
    }
    excluded.insert(pair);
    excluded.emplace(pair.second, pair.first);
  }
  return excluded;
}

constexpr double kWitnessDepth = 1e-5;  ///< m

/// For the parallel edges of two boxes, whose cross product is nothing but rounding.
constexpr double kNothing = 1e-14;

/// Whether two boxes share a point: no axis keeps them apart though both are made smaller.
bool boxes_overlap(OrientedBox a, OrientedBox b) {
  a.half_extents.array() -= kWitnessDepth;
  b.half_extents.array() -= kWitnessDepth;
  return a.half_extents.minCoeff() > 0.0 && b.half_extents.minCoeff() > 0.0 && !boxes_apart(a, b, kNothing);
}

Placement::Placed place(const CollisionShape& shape, const Eigen::Isometry3d& X_WG) {
  return {X_WG, {X_WG * shape.center(), X_WG.linear(), shape.half_extents()}};
}

}  // namespace

CollisionWorld::CollisionWorld(const RobotModel& model, const Scene& scene, const std::vector<BodyPair>& touching)
    : robot(model), X_WR(scene.X_WR) {
  const std::set<BodyPair> excluded = excluded_pairs(model, scene, touching);
  for (std::size_t l = robot.links().size(); l-- > 0;) {
    for (const Geometry& g : robot.links()[l].collision) {
      parts.push_back({CollisionShape(g.shape), static_cast<int>(l), g.X_BG});
    }
  }
  robot_parts = static_cast<int>(parts.size());
  for (const SceneBody& body : scene.bodies) {
    for (const Geometry& g : body.geometry) {
      parts.push_back({CollisionShape(g.shape), static_cast<int>(body_names.size()), body.X_WB * g.X_BG});
    }
    body_names.push_back(body.name);
  }
  const std::set<std::pair<int, int>>& allowed = robot.description().allowed_collisions;
  for (int i = 0; i < robot_parts; ++i) {
    std::vector<int>& against = partners.emplace_back();
    for (int j = i + 1; j < static_cast<int>(parts.size()); ++j) {
      const std::pair<int, int> links =
          std::minmax(parts[static_cast<std::size_t>(i)].body, parts[static_cast<std::size_t>(j)].body);
      if (!of_scene(j) && (links.first == links.second || allowed.contains(links))) continue;
      if (!excluded.contains(names_of(i, j))) against.push_back(j);
    }
  }
}

const std::string& CollisionWorld::name_of(int part) const {
  const auto body = static_cast<std::size_t>(parts[static_cast<std::size_t>(part)].body);
  return of_scene(part) ? body_names[body] : robot.links()[body].name;
}

BodyPair CollisionWorld::names_of(int a, int b) const {
  BodyPair pair{name_of(a), name_of(b)};
  if (!of_scene(b) && pair.second < pair.first) std::swap(pair.first, pair.second);
  return pair;
}

Placement::Placement(const CollisionWorld& world, const Eigen::Isometry3d& X_WR,
                     const Eigen::Ref<const Eigen::VectorXd>& q, Memory& memory)
    : world_(world), X_WR_(X_WR), q_(q.data(), q.size()), memory_(memory) {
  const auto at_least = [](auto& list, std::size_t size) {
    if (list.size() < size) list.resize(size);
  };
  at_least(memory.X_RL_, world.robot.links().size());
  at_least(memory.link_known_, world.robot.links().size());
  at_least(memory.placed_, world.parts.size());
  at_least(memory.part_known_, world.parts.size());
  ++memory.number_;
  memory.X_RL_[0].setIdentity();
  memory.link_known_[0] = memory.number_;
}

const Eigen::Isometry3d& Placement::link(int index) {
  const auto i = static_cast<std::size_t>(index);
  Eigen::Isometry3d& X_RL = memory_.X_RL_[i];
  if (memory_.link_known_[i] != memory_.number_) {
    const auto joint = static_cast<std::size_t>(world_.robot.links()[i].joint);
    const Eigen::Isometry3d& X_RP = link(world_.robot.description().joints[joint].parent);
    world_.robot.place_child(joint, q_, X_RP, X_RL);
    memory_.link_known_[i] = memory_.number_;
  }
  return X_RL;
}

const Placement::Placed& Placement::at(int part) {
  const auto i = static_cast<std::size_t>(part);
  Placed& placed = memory_.placed_[i];
  if (memory_.part_known_[i] != memory_.number_) {
    const CollisionPart& own = world_.parts[i];
    placed = place(own.shape, world_.of_scene(part) ? own.X_BG : X_WR_ * link(own.body) * own.X_BG);
    memory_.part_known_[i] = memory_.number_;
  }
  return placed;
}

/// Bounding volumes, cheapest first: spheres, sphere and box, boxes.
bool Placement::collide(int a, int b) {
  const CollisionShape& A = world_.shape(a);
  const CollisionShape& B = world_.shape(b);
  const Placed& at_a = at(a);
  const Placed& at_b = at(b);
  const double reach = A.radius() + B.radius() + kCullMargin;
  if ((at_a.box.center - at_b.box.center).squaredNorm() > reach * reach) return false;
  if (point_box_distance(at_a.box.center, at_b.box) > A.radius() + kCullMargin) return false;
  if (point_box_distance(at_b.box.center, at_a.box) > B.radius() + kCullMargin) return false;
  if (boxes_apart(at_a.box, at_b.box, kCullMargin)) return false;
  return intersect(A, at_a.X_WG, B, at_b.X_WG);
}

Solids Placement::relation(int a, int b) {
  // Separating axes tell all of two boxes, and cheaply.
  if (world_.is_box(a) && world_.is_box(b)) {
    return boxes_overlap(at(a).box, at(b).box) ? Solids::touching : Solids::unknown;
  }
  const CollisionShape& A = world_.shape(a);
  const CollisionShape& B = world_.shape(b);
  const bool meshes = world_.is_mesh(a) || world_.is_mesh(b);  // primitives are their own hulls
  const Convex hulls = convex_relation(A, at(a).X_WG, B, at(b).X_WG, kCullMargin, meshes ? 0.0 : kWitnessDepth);
  if (hulls == Convex::apart) return Solids::apart;
  if (meshes) {
    return pieces_relation(A, at(a).X_WG, B, at(b).X_WG, kCullMargin, kWitnessDepth);
  }
  return hulls == Convex::overlapping ? Solids::touching : Solids::unknown;
}

double Placement::separation(int a, int b) {
  return robot::separation(world_.shape(a), at(a).X_WG, world_.shape(b), at(b).X_WG);
}

double Placement::distance_bound(int a, int b) {
  const double radius_a = world_.shape(a).radius();
  const double radius_b = world_.shape(b).radius();
  const OrientedBox& box_a = at(a).box;
  const OrientedBox& box_b = at(b).box;
  return std::max({(box_a.center - box_b.center).norm() - radius_a - radius_b,
                   point_box_distance(box_a.center, box_b) - radius_a,
                   point_box_distance(box_b.center, box_a) - radius_b, 0.0});
}

}  // namespace opponens::robot
