// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/collision.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <mutex>
#include <set>
#include <span>

#include "core/require.hpp"
#include "robot/collision_world.hpp"
#include "robot/wide_world.hpp"

namespace opponens::robot {

namespace {

/// A pose as the sweep takes it.
std::array<float, 12> wide_pose(const Eigen::Isometry3d& X) {
  std::array<float, 12> pose;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) pose[static_cast<std::size_t>(3 * i + j)] = static_cast<float>(X.linear()(i, j));
    pose[static_cast<std::size_t>(9 + i)] = static_cast<float>(X.translation()[i]);
  }
  return pose;
}

/// Rows [first, first + count) of a batch; idle lanes repeat the last.
wide::Query wide_query(const ConfigurationBatch& batch, int first, int count, const std::array<float, 12>& root) {
  wide::Query query{{}, (1U << count) - 1U, false, root.data()};
  for (int lane = 0; lane < wide::kLanes; ++lane) {
    query.q[lane] = batch.row(first + std::min(lane, count - 1)).data();
  }
  return query;
}

bool too_large(const Eigen::Ref<const Eigen::VectorXd>& q) {
  return q.size() > 0 && q.cwiseAbs().maxCoeff() > wide::World::kLargestPosition;
}

static_assert(CollisionChecker::kTogether == wide::kLanes);

}  // namespace

struct CollisionChecker::World {
  CollisionWorld exact;
  wide::World fixed;  ///< the robot's root where the scene puts it
  bool portable;
  bool constant_collision = false;       ///< of what no joint moves, the scene included
  bool constant_self_collision = false;  ///< of the robot with itself

  World(const RobotModel& robot, const Scene& scene, const std::vector<BodyPair>& touching,
        const CollisionSettings& settings)
      : exact(robot, scene, touching), fixed(exact, true), portable(settings.portable) {
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(robot.dof());
    Placement placement(exact, exact.X_WR, zero);
    for (const auto& [a, b] : fixed.constant_pairs()) {
      if (!placement.collide(a, b)) continue;
      constant_collision = true;
      constant_self_collision = constant_self_collision || !exact.of_scene(b);
    }
  }

  /// The robot's root anywhere: made when first asked for, which most checkers never are.
  const wide::World& flying() const {
    std::call_once(flying_once, [this] { flying_made = std::make_unique<const wide::World>(exact, false); });
    return *flying_made;
  }

  void require_configuration(const Eigen::Ref<const Eigen::VectorXd>& q) const {
    require(q.size() == exact.robot.dof(), [&] {
      return "CollisionChecker: q has " + std::to_string(q.size()) + " entries, the robot " +
             std::to_string(exact.robot.dof());
    });
    require(q.allFinite(), "CollisionChecker: q is not finite");
  }

  void require_batch(const ConfigurationBatch& batch) const {
    require(batch.cols() == exact.robot.dof() && batch.allFinite(),
            "CollisionChecker: a batch needs one finite number for each joint");
    require(batch.size() == 0 || batch.cwiseAbs().maxCoeff() <= wide::World::kLargestPosition,
            "CollisionChecker: a joint position of a batch is beyond 10,000");
  }

  bool exact_free(const Eigen::Isometry3d& X_WR, const Eigen::Ref<const Eigen::VectorXd>& q) const {
    Placement placement(exact, X_WR, q);
    for (int i = 0; i < exact.robot_parts; ++i) {
      for (const int j : exact.partners[static_cast<std::size_t>(i)]) {
        if (placement.collide(i, j)) return false;
      }
    }
    return true;
  }

  /// Whether no unknown pair of a lane collides. One that touches for certain spares the kinematics too.
  bool settle(std::span<const wide::Unknown> unknown, unsigned lane, const Eigen::Isometry3d& X_WR,
              const Eigen::Ref<const Eigen::VectorXd>& q, std::int64_t& asked) const {
    const auto concerns = [lane](const wide::Unknown& pair) { return (pair.lanes >> lane & 1U) != 0; };
    const auto touches = [lane](const wide::Unknown& pair) { return (pair.touching >> lane & 1U) != 0; };
    if (std::none_of(unknown.begin(), unknown.end(), concerns)) return true;
    if (std::any_of(unknown.begin(), unknown.end(), touches)) return false;
    Placement placement(exact, X_WR, q);
    for (const wide::Unknown& pair : unknown) {
      if (!concerns(pair)) continue;
      // The truth is dear for meshes; of primitives the first stage knows nearly as much as their hulls would tell.
      if (exact.involves_mesh(pair.a, pair.b) && placement.hulls_apart(pair.a, pair.b)) continue;
      if (placement.share_a_point(pair.a, pair.b)) return false;
      ++asked;
      if (placement.collide(pair.a, pair.b)) return false;
    }
    return true;
  }

  /// Pairs that the first stage cannot tell apart in rows [first, first + count) of a batch, count <= kLanes; row
  /// first + i is lane i. first_only: rows after one that collides do not matter. Valid until the thread asks again.
  std::span<const wide::Unknown> unknown_pairs(const ConfigurationBatch& batch, int first, int count,
                                               bool first_only = false) const {
    static const std::array<float, 12> kUsual = wide_pose(Eigen::Isometry3d::Identity());
    thread_local wide::World::Buffers buffers;
    wide::Query query = wide_query(batch, first, count, kUsual);
    query.first_only = first_only;
    const int pairs = fixed.sweep(query, buffers, portable);
    return {buffers.found.data(), static_cast<std::size_t>(pairs)};
  }

  /// Asks for such rows at once. Calls verdict(row, free) for each in turn until it returns true.
  template <typename Verdict>
  void sweep_rows(const ConfigurationBatch& batch, int first, int count, const Verdict& verdict,
                  CollisionCounts& counts, bool first_only = false) const {
    const std::span<const wide::Unknown> unknown = unknown_pairs(batch, first, count, first_only);
    counts.configurations += count;
    for (int row = first; row < first + count; ++row) {
      const Eigen::Map<const Eigen::VectorXd> q(batch.row(row).data(), batch.cols());
      const auto lane = static_cast<unsigned>(row - first);
      if (verdict(row, !constant_collision && settle(unknown, lane, exact.X_WR, q, counts.pairs))) return;
    }
  }

  /// Sweeps a whole batch so.
  template <typename Verdict>
  void sweep_batch(const ConfigurationBatch& batch, const Verdict& verdict, CollisionCounts& counts,
                   bool first_only) const {
    require_batch(batch);
    bool ended = false;
    for (int first = 0; first < batch.rows() && !ended; first += wide::kLanes) {
      const int count = std::min(wide::kLanes, static_cast<int>(batch.rows()) - first);
      sweep_rows(
          batch, first, count, [&](int row, bool free) { return ended = verdict(row, free); }, counts, first_only);
    }
  }

 private:
  mutable std::once_flag flying_once;
  mutable std::unique_ptr<const wide::World> flying_made;
};

CollisionChecker::CollisionChecker(const RobotModel& robot, const Scene& scene, std::vector<BodyPair> touching,
                                   const CollisionSettings& settings)
    : world_(std::make_unique<const World>(robot, scene, touching, settings)) {}
CollisionChecker::~CollisionChecker() = default;
CollisionChecker::CollisionChecker(CollisionChecker&&) noexcept = default;
CollisionChecker& CollisionChecker::operator=(CollisionChecker&&) noexcept = default;

bool CollisionChecker::free(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  world_->require_configuration(q);
  if (too_large(q)) return exact_free(q);
  bool free = false;
  CollisionCounts counts;
  world_->sweep_rows(
      q.transpose(), 0, 1, [&](int, bool verdict) { return free = verdict; }, counts);
  return free;
}

bool CollisionChecker::free(const Eigen::Isometry3d& X_WR, const Eigen::Ref<const Eigen::VectorXd>& q) const {
  const World& w = *world_;
  w.require_configuration(q);
  const Eigen::Isometry3d X_SR = w.exact.X_WR.inverse() * X_WR;
  if (too_large(q) || !w.flying().reaches(X_SR)) return w.exact_free(X_WR, q);
  const std::array<float, 12> root = wide_pose(X_SR);
  const ConfigurationBatch row = q.transpose();
  thread_local wide::World::Buffers buffers;
  const int pairs = w.flying().sweep(wide_query(row, 0, 1, root), buffers, w.portable);
  const std::span<const wide::Unknown> unknown(buffers.found.data(), static_cast<std::size_t>(pairs));
  std::int64_t asked = 0;
  return !w.constant_self_collision && w.settle(unknown, 0, X_WR, q, asked);
}

std::vector<bool> CollisionChecker::free_rows(const ConfigurationBatch& batch, CollisionCounts* counts) const {
  std::vector<bool> verdicts;
  CollisionCounts own;
  const auto keep = [&](int, bool free) {
    verdicts.push_back(free);
    return false;
  };
  world_->sweep_batch(batch, keep, counts != nullptr ? *counts : own, false);
  return verdicts;
}

std::optional<int> CollisionChecker::first_colliding(const ConfigurationBatch& batch, CollisionCounts* counts) const {
  std::optional<int> colliding;
  CollisionCounts own;
  const auto keep = [&](int row, bool free) {
    if (!free) colliding = row;
    return !free;
  };
  world_->sweep_batch(batch, keep, counts != nullptr ? *counts : own, true);
  return colliding;
}

std::vector<bool> CollisionChecker::cleared_rows(const ConfigurationBatch& batch) const {
  const World& w = *world_;
  w.require_batch(batch);
  std::vector<bool> cleared(static_cast<std::size_t>(batch.rows()), !w.constant_collision);
  for (int first = 0; first < batch.rows(); first += wide::kLanes) {
    const int count = std::min(wide::kLanes, static_cast<int>(batch.rows()) - first);
    for (const wide::Unknown& pair : w.unknown_pairs(batch, first, count)) {
      for (int lane = 0; lane < count; ++lane) {
        if ((pair.lanes >> lane & 1U) != 0) cleared[static_cast<std::size_t>(first + lane)] = false;
      }
    }
  }
  return cleared;
}

bool CollisionChecker::exact_free(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  world_->require_configuration(q);
  return world_->exact_free(world_->exact.X_WR, q);
}

std::vector<BodyPair> CollisionChecker::colliding_pairs(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  return colliding_pairs(world_->exact.X_WR, q);
}

std::vector<BodyPair> CollisionChecker::colliding_pairs(const Eigen::Isometry3d& X_WR,
                                                        const Eigen::Ref<const Eigen::VectorXd>& q) const {
  world_->require_configuration(q);
  const CollisionWorld& exact = world_->exact;
  Placement placement(exact, X_WR, q);
  std::set<BodyPair> pairs;
  for (int i = 0; i < exact.robot_parts; ++i) {
    for (const int j : exact.partners[static_cast<std::size_t>(i)]) {
      if (placement.collide(i, j)) pairs.insert(exact.names_of(i, j));
    }
  }
  return {pairs.begin(), pairs.end()};
}

CollisionChecker::Clearance CollisionChecker::clearance(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  world_->require_configuration(q);
  struct Candidate {
    double bound;
    int a;
    int b;
  };
  const CollisionWorld& exact = world_->exact;
  Placement placement(exact, exact.X_WR, q);
  // Nearest bounds first, so that few exact distances are needed. Equal bounds stay in the order of the pairs.
  std::vector<Candidate> candidates;
  for (int i = 0; i < exact.robot_parts; ++i) {
    for (const int j : exact.partners[static_cast<std::size_t>(i)]) {
      candidates.push_back({placement.distance_bound(i, j), i, j});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& x, const Candidate& y) { return x.bound < y.bound; });
  Clearance result{std::numeric_limits<double>::infinity(), {}};
  for (const Candidate& candidate : candidates) {
    if (candidate.bound >= result.distance) break;
    const double distance = placement.separation(candidate.a, candidate.b);
    if (distance < result.distance) result = {distance, exact.names_of(candidate.a, candidate.b)};
    if (distance == 0.0) break;
  }
  return result;
}

std::vector<std::string> CollisionChecker::open_meshes() const {
  std::set<std::string> names;
  const CollisionWorld& exact = world_->exact;
  for (std::size_t i = 0; i < exact.parts.size(); ++i) {
    if (exact.parts[i].shape.open_surface()) names.insert(exact.name_of(static_cast<int>(i)));
  }
  return {names.begin(), names.end()};
}

}  // namespace opponens::robot
