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

constexpr double kTouching = 1e-5;  ///< m; nearer pairs may collide in one pose and not in another, by rounding

/// A pose as the sweep takes it: rotation row-major, translation.
std::array<double, 12> rows_of(const Eigen::Isometry3d& X) {
  std::array<double, 12> pose;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) pose[static_cast<std::size_t>(3 * i + j)] = X.linear()(i, j);
    pose[static_cast<std::size_t>(9 + i)] = X.translation()[i];
  }
  return pose;
}

constexpr std::array<double, 12> kUsualRoot{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};

/// Rows [first, first + count) of a batch. Idle lanes repeat the last, and lanes that the sweep does not hold for rest
/// at zero: a number that is not finite would spoil the boxes around all lanes.
wide::Query wide_query(const wide::World& world, const ConfigurationBatch& batch, int first, int count,
                       const Eigen::VectorXd& zero) {
  static constexpr std::array<float, 12> kUsual{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  wide::Query query{{}, 0, kUsual.data()};
  for (int lane = 0; lane < count; ++lane) {
    const double* const q = batch.row(first + lane).data();
    const bool held = world.holds(q, static_cast<int>(batch.cols()));
    query.q[lane] = held ? q : zero.data();
    if (held) query.lanes |= 1U << lane;
  }
  for (int lane = count; lane < wide::kLanes; ++lane) query.q[lane] = query.q[count - 1];
  return query;
}

static_assert(CollisionChecker::kTogether == wide::kLanes);

}  // namespace

struct CollisionChecker::World {
  CollisionWorld exact;
  wide::World fixed;  ///< the robot's root where the scene puts it
  bool portable;
  Eigen::VectorXd zero;                            ///< [d]
  std::vector<std::pair<int, int>> constant;       ///< what no joint moves and touches, or nearly so
  std::vector<std::pair<int, int>> constant_self;  ///< of these, the robot's own

  World(const RobotModel& robot, const Scene& scene, const std::vector<BodyPair>& touching,
        const CollisionSettings& settings)
      : exact(robot, scene, touching),
        fixed(exact, true),
        portable(settings.portable),
        zero(Eigen::VectorXd::Zero(robot.dof())) {
    Placement::Memory memory;
    Placement placement(exact, exact.X_WR, zero, memory);
    // The truth is asked each time about those that are not apart for certain: of faces that just touch, rounding
    // decides it, and rounding differs from pose to pose.
    for (const auto& [a, b] : fixed.constant_pairs()) {
      if (placement.relation(a, b) == Solids::apart || placement.separation(a, b) > kTouching) continue;
      constant.emplace_back(a, b);
      if (!exact.of_scene(b)) constant_self.emplace_back(a, b);
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
    // Nothing but finite numbers is zero times zero; Eigen's allFinite asks them one by one.
    require(batch.cols() == exact.robot.dof() && (batch.array() * 0.0).sum() == 0.0,
            "CollisionChecker: a batch needs one finite number for each joint");
  }

  bool exact_free(const Eigen::Isometry3d& X_WR, const Eigen::Ref<const Eigen::VectorXd>& q) const {
    Placement placement(exact, X_WR, q, own_memory());
    return !exact.any_pair([&](int a, int b) { return placement.collide(a, b); });
  }

  /// Whether none of the pairs collides.
  bool apart(const std::vector<std::pair<int, int>>& pairs, const Eigen::Isometry3d& X_WR,
             const Eigen::Ref<const Eigen::VectorXd>& q) const {
    if (pairs.empty()) return true;
    Placement placement(exact, X_WR, q, own_memory());
    return std::none_of(pairs.begin(), pairs.end(),
                        [&](const auto& pair) { return placement.collide(pair.first, pair.second); });
  }

  /// Whether no unknown pair of a lane collides. One that touches for certain spares the kinematics too.
  bool settle(std::span<const wide::Unknown> unknown, unsigned lane, const Eigen::Isometry3d& X_WR,
              const Eigen::Ref<const Eigen::VectorXd>& q, std::int64_t& asked) const {
    const auto concerns = [lane](const wide::Unknown& pair) { return (pair.lanes >> lane & 1U) != 0; };
    const auto touches = [lane](const wide::Unknown& pair) { return (pair.touching >> lane & 1U) != 0; };
    if (std::none_of(unknown.begin(), unknown.end(), concerns)) return true;
    if (std::any_of(unknown.begin(), unknown.end(), touches)) return false;
    Placement placement(exact, X_WR, q, own_memory());
    for (const wide::Unknown& pair : unknown) {
      if (!concerns(pair)) continue;
      const Solids relation = placement.relation(pair.a, pair.b);
      if (relation == Solids::apart) continue;
      if (relation == Solids::touching) return false;
      ++asked;
      if (placement.collide(pair.a, pair.b)) return false;
    }
    return true;
  }

  /// What the first stage says of rows [first, first + count) of a batch, count <= kLanes; row first + i is lane i.
  struct FirstStage {
    std::span<const wide::Unknown> unknown;  ///< pairs that it cannot tell apart
    unsigned lanes;                          ///< in which it says anything
  };
  /// Valid until the thread asks again. first_only: rows after one that collides do not matter.
  FirstStage first_stage(const ConfigurationBatch& batch, int first, int count, bool first_only = false) const {
    if (count == 1) return first_stage(fixed, kUsualRoot.data(), batch.row(first).data());
    wide::World::Buffers& buffers = own_buffers();
    wide::Query query = wide_query(fixed, batch, first, count, zero);
    query.first_only = first_only;
    const int pairs = fixed.sweep(query, buffers, portable);
    return {{buffers.found.data(), static_cast<std::size_t>(pairs)}, query.lanes};
  }

  /// The same for one configuration, of the robot with its root there.
  FirstStage first_stage(const wide::World& world, const double* root, const double* q) const {
    if (!world.holds(q, exact.robot.dof())) return {{}, 0};
    wide::World::Buffers& buffers = own_buffers();
    const int pairs = world.sweep(wide::SingleQuery{q, root}, buffers, portable);
    return {{buffers.found.data(), static_cast<std::size_t>(pairs)}, 1U};
  }

  static Placement::Memory& own_memory() {
    thread_local Placement::Memory memory;
    return memory;
  }
  static wide::World::Buffers& own_buffers() {
    thread_local wide::World::Buffers buffers;
    return buffers;
  }

  /// One configuration in both stages. fixed_pairs: those to check in which nothing moves.
  bool free(const wide::World& world, const double* root, const std::vector<std::pair<int, int>>& fixed_pairs,
            const Eigen::Isometry3d& X_WR, const Eigen::Ref<const Eigen::VectorXd>& q) const {
    const FirstStage stage = first_stage(world, root, q.data());
    if (stage.lanes == 0) return exact_free(X_WR, q);
    std::int64_t asked = 0;
    return apart(fixed_pairs, X_WR, q) && settle(stage.unknown, 0, X_WR, q, asked);
  }

  /// Asks for such rows at once. Calls verdict(row, free) for each in turn until it returns true.
  template <typename Verdict>
  void sweep_rows(const ConfigurationBatch& batch, int first, int count, const Verdict& verdict,
                  CollisionCounts& counts, bool first_only = false) const {
    const FirstStage stage = first_stage(batch, first, count, first_only);
    counts.configurations += count;
    for (int row = first; row < first + count; ++row) {
      const Eigen::Map<const Eigen::VectorXd> q(batch.row(row).data(), batch.cols());
      const auto lane = static_cast<unsigned>(row - first);
      const bool free = (stage.lanes >> lane & 1U) != 0
                            ? apart(constant, exact.X_WR, q) && settle(stage.unknown, lane, exact.X_WR, q, counts.pairs)
                            : exact_free(exact.X_WR, q);
      if (verdict(row, free)) return;
    }
  }

  /// Sweeps a whole batch so. first_only: its first row alone, as the end of a motion decides more often than others.
  template <typename Verdict>
  void sweep_batch(const ConfigurationBatch& batch, const Verdict& verdict, CollisionCounts& counts,
                   bool first_only) const {
    require_batch(batch);
    bool ended = false;
    int count = 0;
    for (int first = 0; first < batch.rows() && !ended; first += count) {
      const int most = first_only && first == 0 ? 1 : wide::kLanes;
      count = std::min(most, static_cast<int>(batch.rows()) - first);
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
  return world_->free(world_->fixed, kUsualRoot.data(), world_->constant, world_->exact.X_WR, q);
}

bool CollisionChecker::free(const Eigen::Isometry3d& X_WR, const Eigen::Ref<const Eigen::VectorXd>& q) const {
  const World& w = *world_;
  w.require_configuration(q);
  const Eigen::Isometry3d X_SR = w.exact.X_WR.inverse() * X_WR;
  if (!w.flying().reaches(X_SR)) return w.exact_free(X_WR, q);
  return w.free(w.flying(), rows_of(X_SR).data(), w.constant_self, X_WR, q);
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
  std::vector<bool> cleared(static_cast<std::size_t>(batch.rows()), w.constant.empty());
  for (int first = 0; first < batch.rows(); first += wide::kLanes) {
    const int count = std::min(wide::kLanes, static_cast<int>(batch.rows()) - first);
    const World::FirstStage stage = w.first_stage(batch, first, count);
    unsigned free = stage.lanes;
    for (const wide::Unknown& pair : stage.unknown) free &= ~pair.lanes;
    for (int lane = 0; lane < count; ++lane) {
      if ((free >> lane & 1U) == 0) cleared[static_cast<std::size_t>(first + lane)] = false;
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
  Placement::Memory memory;
  Placement placement(exact, X_WR, q, memory);
  std::set<BodyPair> pairs;
  exact.any_pair([&](int a, int b) {
    if (placement.collide(a, b)) pairs.insert(exact.names_of(a, b));
    return false;
  });
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
  Placement::Memory memory;
  Placement placement(exact, exact.X_WR, q, memory);
  // Nearest bounds first, so that few exact distances are needed. Equal bounds stay in the order of the pairs.
  std::vector<Candidate> candidates;
  exact.any_pair([&](int a, int b) {
    candidates.push_back({placement.distance_bound(a, b), a, b});
    return false;
  });
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

const CollisionWorld& CollisionChecker::shapes() const { return world_->exact; }

std::vector<std::string> CollisionChecker::open_meshes() const {
  std::set<std::string> names;
  const CollisionWorld& exact = world_->exact;
  for (std::size_t i = 0; i < exact.parts.size(); ++i) {
    if (exact.parts[i].shape.open_surface()) names.insert(exact.name_of(static_cast<int>(i)));
  }
  return {names.begin(), names.end()};
}

}  // namespace opponens::robot
