// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::robot {

struct CollisionWorld;

/// Names of two bodies: robot links, or scene bodies.
using BodyPair = std::pair<std::string, std::string>;

/// Configurations to check together, [B x d] rad: one a row, contiguous.
using ConfigurationBatch = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct CollisionSettings {
  bool portable = false;  ///< do without the instructions that only some processors have; the verdicts are the same
};

/// What checks took.
struct CollisionCounts {
  std::int64_t configurations = 0;  ///< evaluated
  std::int64_t pairs = 0;           ///< of shapes, that the truth was asked about, as nothing cheaper decided
};

/// The collision truth (design: "Collision truth"): FCL on the chosen geometry of every link pair that is not allowed
/// and every link-body pair, plus containment: closed meshes are solids. `free` asks in two stages: single-precision
/// kinematics, sphere covers and oriented boxes for eight configurations at a time (AVX2 where the processor has it; as
/// VAMP does: Thomason, Kingston and Kavraki 2024, doi:10.1109/ICRA57147.2024.10611190) say "apart" or "unknown" of
/// each pair, and the truth is asked for the unknown pairs only. The verdict is the truth's. Thread-safe: all queries
/// are const and keep no state.
class CollisionChecker {
 public:
  static constexpr int kTogether = 8;  ///< rows that a batch is checked by

  /// touching: extra pairs that are not checked (link name, scene body name), e.g. the contacts of a grasp.
  CollisionChecker(const RobotModel& robot, const Scene& scene, std::vector<BodyPair> touching = {},
                   const CollisionSettings& settings = {});
  ~CollisionChecker();
  CollisionChecker(CollisionChecker&&) noexcept;
  CollisionChecker& operator=(CollisionChecker&&) noexcept;

  /// Whether no pair collides at q. Stops at the first colliding pair. q: [d] rad.
  bool free(const Eigen::Ref<const Eigen::VectorXd>& q) const;

  /// The same for each row of a batch; eight at a time take little more than one. Adds to counts when given.
  std::vector<bool> free_rows(const ConfigurationBatch& batch, CollisionCounts* counts = nullptr) const;
  /// The first row that is not free. Rows are asked eight at a time: put those that decide first, as along a motion
  /// from coarse to fine.
  std::optional<int> first_colliding(const ConfigurationBatch& batch, CollisionCounts* counts = nullptr) const;

  /// Rows that the first stage alone shows to be free; the others may be free too. What a check would cost if no pair
  /// were ever unknown.
  std::vector<bool> cleared_rows(const ConfigurationBatch& batch) const;

  /// free() by the truth alone: what tests compare with.
  bool exact_free(const Eigen::Ref<const Eigen::VectorXd>& q) const;

  /// Every colliding pair at q, sorted by name.
  std::vector<BodyPair> colliding_pairs(const Eigen::Ref<const Eigen::VectorXd>& q) const;

  struct Clearance {
    double distance;  ///< m; 0 when colliding, infinite when there is no pair to check
    BodyPair pair;    ///< the nearest pair; when several collide, one of them
  };
  Clearance clearance(const Eigen::Ref<const Eigen::VectorXd>& q) const;

  /// Links and scene bodies with a mesh that is not closed, sorted: such a mesh is a surface, nothing is inside it.
  std::vector<std::string> open_meshes() const;

  /// The same for a free-flying robot: root at X_WR instead of the scene's (hand-only searches).
  bool free(const Eigen::Isometry3d& X_WR, const Eigen::Ref<const Eigen::VectorXd>& q) const;
  std::vector<BodyPair> colliding_pairs(const Eigen::Isometry3d& X_WR,
                                        const Eigen::Ref<const Eigen::VectorXd>& q) const;

  /// What is checked against what; for other questions about the same pairs.
  const CollisionWorld& shapes() const;

 private:
  struct World;
  std::unique_ptr<const World> world_;
};

}  // namespace opponens::robot
