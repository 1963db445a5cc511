// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/collision.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "core/require.hpp"
#include "robot/narrow_phase.hpp"

namespace opponens::robot {

namespace {

/// m. Bounding volumes must be further apart than this to settle a pair: above the tolerance of FCL's tests (1e-6), so
/// that the verdict is the narrow phase's, with or without them.
constexpr double kCullMargin = 2e-6;

/// One geometry of a link or of a scene body.
struct Part {
  CollisionShape shape;
  int body;                ///< link index, or scene body index
  Eigen::Isometry3d X_BG;  ///< scene: X_WG
};

/// Where a part is now.
struct Placed {
  Eigen::Isometry3d X_WG;
  OrientedBox box;
};

Placed place(const CollisionShape& shape, const Eigen::Isometry3d& X_WG) {
  return {X_WG, {X_WG * shape.center(), X_WG.linear(), shape.half_extents()}};
}

/// Whether bounding volumes alone show two parts to be apart: spheres, sphere and box, boxes; cheapest first.
bool culled(const CollisionShape& a, const Placed& at_a, const CollisionShape& b, const Placed& at_b) {
  const double reach = a.radius() + b.radius() + kCullMargin;
  if ((at_a.box.center - at_b.box.center).squaredNorm() > reach * reach) return true;
  if (point_box_distance(at_a.box.center, at_b.box) > a.radius() + kCullMargin) return true;
  if (point_box_distance(at_b.box.center, at_a.box) > b.radius() + kCullMargin) return true;
  return boxes_apart(at_a.box, at_b.box, kCullMargin);
}

/// Lower bound of the distance of two parts, m.
double distance_bound(const CollisionShape& a, const Placed& at_a, const CollisionShape& b, const Placed& at_b) {
  return std::max({(at_a.box.center - at_b.box.center).norm() - a.radius() - b.radius(),
                   point_box_distance(at_a.box.center, at_b.box) - a.radius(),
                   point_box_distance(at_b.box.center, at_a.box) - b.radius(), 0.0});
}

/// Makes each distinct mesh once; fingers share theirs.
class ShapeCache {
 public:
  CollisionShape get(const Shape& shape) {
    const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&shape);
    if (mesh == nullptr) return CollisionShape(shape);
    const auto found = known_.find(mesh->get());
    if (found != known_.end()) return found->second;
    return known_.emplace(mesh->get(), CollisionShape(shape)).first->second;
  }

 private:
  std::map<const TriangleMesh*, CollisionShape> known_;
};

}  // namespace

struct CollisionChecker::World {
  RobotModel robot;
  Eigen::Isometry3d X_WR;
  std::vector<std::string> body_names;
  std::vector<Part> links;   ///< parts of the robot, most distal link first
  std::vector<Part> bodies;  ///< parts of the scene
  std::vector<Placed> bodies_at;
  std::vector<std::vector<int>> against;  ///< per link part: scene parts to check
  std::vector<std::pair<int, int>> self;  ///< link parts to check, most distal first

  World(const RobotModel& model, const Scene& scene, const std::vector<BodyPair>& touching);

  std::vector<Placed> place_links(const Eigen::Isometry3d& X_WR_now, const Eigen::Ref<const Eigen::VectorXd>& q) const;

  const std::string& link_name(int part) const {
    return robot.links()[static_cast<std::size_t>(links[static_cast<std::size_t>(part)].body)].name;
  }
  BodyPair scene_pair(std::size_t link_part, int body_part) const {
    return {link_name(static_cast<int>(link_part)),
            body_names[static_cast<std::size_t>(bodies[static_cast<std::size_t>(body_part)].body)]};
  }
  BodyPair self_pair(const std::pair<int, int>& parts) const {
    BodyPair pair{link_name(parts.first), link_name(parts.second)};
    if (pair.second < pair.first) std::swap(pair.first, pair.second);
    return pair;
  }

  /// Calls visit(a, at_a, b, at_b, name) for every pair of parts to check, where name() makes the pair's names; ends
  /// when visit returns true, and returns whether it did.
  template <typename Visit>
  bool any_pair(const std::vector<Placed>& at, const Visit& visit) const {
    for (std::size_t i = 0; i < links.size(); ++i) {
      for (const int body : against[i]) {
        const auto j = static_cast<std::size_t>(body);
        if (visit(links[i].shape, at[i], bodies[j].shape, bodies_at[j], [&] { return scene_pair(i, body); })) {
          return true;
        }
      }
    }
    for (const std::pair<int, int>& parts : self) {
      const auto i = static_cast<std::size_t>(parts.first);
      const auto j = static_cast<std::size_t>(parts.second);
      if (visit(links[i].shape, at[i], links[j].shape, at[j], [&] { return self_pair(parts); })) return true;
    }
    return false;
  }

  bool free(const std::vector<Placed>& at) const {
    return !any_pair(at, [](const auto& a, const auto& at_a, const auto& b, const auto& at_b, const auto&) {
      return !culled(a, at_a, b, at_b) && intersect(a, at_a.X_WG, b, at_b.X_WG);
    });
  }

  std::vector<BodyPair> colliding_pairs(const std::vector<Placed>& at) const {
    std::set<BodyPair> pairs;
    any_pair(at, [&pairs](const auto& a, const auto& at_a, const auto& b, const auto& at_b, const auto& name) {
      if (!culled(a, at_a, b, at_b) && intersect(a, at_a.X_WG, b, at_b.X_WG)) pairs.insert(name());
      return false;
    });
    return {pairs.begin(), pairs.end()};
  }

  Clearance clearance(const std::vector<Placed>& at) const;
};

CollisionChecker::World::World(const RobotModel& model, const Scene& scene, const std::vector<BodyPair>& touching)
    : robot(model), X_WR(scene.X_WR) {
  std::set<BodyPair> excluded;
  std::set<std::string> known;
  for (const SceneBody& body : scene.bodies) known.insert(body.name);
  for (const Link& link : robot.links()) known.insert(link.name);
  for (const BodyPair& pair : touching) {
    for (const std::string& name : {pair.first, pair.second}) {
      require(known.count(name) == 1,
              [&] { return "CollisionChecker: touching names '" + name + "', which is absent"; });
    }
    excluded.insert(pair);
    excluded.emplace(pair.second, pair.first);
  }
  ShapeCache cache;
  for (std::size_t l = robot.links().size(); l-- > 0;) {
    for (const Geometry& g : robot.links()[l].collision) {
      links.push_back({cache.get(g.shape), static_cast<int>(l), g.X_BG});
    }
  }
  for (const SceneBody& body : scene.bodies) {
    for (const Geometry& g : body.geometry) {
      bodies.push_back({cache.get(g.shape), static_cast<int>(body_names.size()), body.X_WB * g.X_BG});
      bodies_at.push_back(place(bodies.back().shape, bodies.back().X_BG));
    }
    body_names.push_back(body.name);
  }
  against.resize(links.size());
  for (std::size_t i = 0; i < links.size(); ++i) {
    for (int j = 0; j < static_cast<int>(bodies.size()); ++j) {
      if (excluded.count(scene_pair(i, j)) == 0) against[i].push_back(j);
    }
    for (std::size_t j = i + 1; j < links.size(); ++j) {
      const std::pair<int, int> bodies_of = std::minmax(links[i].body, links[j].body);
      const std::pair<int, int> parts(static_cast<int>(i), static_cast<int>(j));
      if (bodies_of.first == bodies_of.second || robot.description().allowed_collisions.count(bodies_of) == 1) continue;
      if (excluded.count(self_pair(parts)) == 0) self.push_back(parts);
    }
  }
}

std::vector<Placed> CollisionChecker::World::place_links(const Eigen::Isometry3d& X_WR_now,
                                                         const Eigen::Ref<const Eigen::VectorXd>& q) const {
  require(q.size() == robot.dof(), [&] {
    return "CollisionChecker: q has " + std::to_string(q.size()) + " entries, the robot " + std::to_string(robot.dof());
  });
  require(q.allFinite(), "CollisionChecker: q is not finite");
  const std::vector<Eigen::Isometry3d> X_RL = robot.link_poses(q);
  std::vector<Placed> at;
  at.reserve(links.size());
  for (const Part& part : links) {
    at.push_back(place(part.shape, X_WR_now * X_RL[static_cast<std::size_t>(part.body)] * part.X_BG));
  }
  return at;
}

CollisionChecker::Clearance CollisionChecker::World::clearance(const std::vector<Placed>& at) const {
  struct Candidate {
    double bound;
    std::function<double()> distance;
    BodyPair pair;
  };
  // Nearest bounds first, so that few exact distances are needed. Equal bounds stay in the order of the pairs.
  std::vector<Candidate> candidates;
  any_pair(at, [&](const auto& a, const auto& at_a, const auto& b, const auto& at_b, const auto& name) {
    candidates.push_back({distance_bound(a, at_a, b, at_b),
                          [&a, &at_a, &b, &at_b] { return separation(a, at_a.X_WG, b, at_b.X_WG); }, name()});
    return false;
  });
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& x, const Candidate& y) { return x.bound < y.bound; });
  Clearance result{std::numeric_limits<double>::infinity(), {}};
  for (const Candidate& candidate : candidates) {
    if (candidate.bound >= result.distance) break;
    const double distance = candidate.distance();
    if (distance < result.distance) result = {distance, candidate.pair};
    if (distance == 0.0) break;
  }
  return result;
}

CollisionChecker::CollisionChecker(const RobotModel& robot, const Scene& scene, std::vector<BodyPair> touching)
    : world_(std::make_unique<const World>(robot, scene, touching)) {}
CollisionChecker::~CollisionChecker() = default;
CollisionChecker::CollisionChecker(CollisionChecker&&) noexcept = default;
CollisionChecker& CollisionChecker::operator=(CollisionChecker&&) noexcept = default;

bool CollisionChecker::free(const Eigen::Ref<const Eigen::VectorXd>& q) const { return free(world_->X_WR, q); }

bool CollisionChecker::free(const Eigen::Isometry3d& X_WR, const Eigen::Ref<const Eigen::VectorXd>& q) const {
  return world_->free(world_->place_links(X_WR, q));
}

std::vector<BodyPair> CollisionChecker::colliding_pairs(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  return colliding_pairs(world_->X_WR, q);
}

std::vector<BodyPair> CollisionChecker::colliding_pairs(const Eigen::Isometry3d& X_WR,
                                                        const Eigen::Ref<const Eigen::VectorXd>& q) const {
  return world_->colliding_pairs(world_->place_links(X_WR, q));
}

CollisionChecker::Clearance CollisionChecker::clearance(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  return world_->clearance(world_->place_links(world_->X_WR, q));
}

std::vector<std::string> CollisionChecker::open_meshes() const {
  std::set<std::string> names;
  for (const Part& part : world_->links) {
    if (part.shape.open_surface()) names.insert(world_->robot.links()[static_cast<std::size_t>(part.body)].name);
  }
  for (const Part& part : world_->bodies) {
    if (part.shape.open_surface()) names.insert(world_->body_names[static_cast<std::size_t>(part.body)]);
  }
  return {names.begin(), names.end()};
}

}  // namespace opponens::robot
