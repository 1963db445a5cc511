// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Internal to robot/: owns what the wide sweep runs over.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Geometry>

#include "robot/collision_world.hpp"
#include "robot/wide_model.hpp"

namespace opponens::robot::wide {

inline constexpr float kRadiusRounding = 1.0e-6F;  ///< share by which a length grows when it becomes a float

inline void store(const Eigen::Vector3d& v, float* to) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(v[i]);
}
inline void store_rotation(const Eigen::Matrix3d& R, float* row_major) {
  for (int i = 0; i < 3; ++i) store(R.row(i).transpose(), row_major + 3 * i);
}

/// Whether this processor has what the AVX2 paths need.
bool has_avx2();

/// Index of the point farthest along n of a padded list, by the instructions that the processor has.
int farthest(const float* xyz, int count, const float* n);

/// The single-precision picture of a collision world. A sweep answers for kLanes configurations at a time which pairs
/// it cannot tell apart; all others are apart for certain. Immutable, thread-safe.
class World {
 public:
  /// fixed_root: the robot's root stays where the scene puts it, so that what does not move against the scene is left
  /// out (constant_pairs). Otherwise it may be anywhere.
  World(const CollisionWorld& world, bool fixed_root);

  /// Pairs of parts, in the fixed world, that no joint moves against each other.
  const std::vector<std::pair<int, int>>& constant_pairs() const { return constant_pairs_; }

  /// Whether the sweep's precision holds at q, [dof]: not for turns beyond 10,000 rad, nor for joints that slide more
  /// than 10 mm beyond their limits, nor in worlds of more than 1000 km.
  bool holds(const double* q, int dof) const;
  /// The same for the robot's root there.
  bool reaches(const Eigen::Isometry3d& X_SR) const { return X_SR.translation().norm() <= 0.5 * largest_; }

  /// Memory for sweeps, to be used again and again.
  struct Buffers {
    std::vector<float> memory;
    std::vector<Unknown> found;
  };
  /// Writes every pair that may touch to the beginning of buffers.found and returns how many there are.
  /// AnyQuery: Query or SingleQuery.
  template <typename AnyQuery>
  int sweep(const AnyQuery& query, Buffers& buffers, bool portable) const;

  /// m, by which every ball and box is enlarged: at least twice the errors of the sweep's arithmetic. 2e-5 times the
  /// largest coordinate, of which rounding of angles (2e-7 rad for each joint of a chain, times its reach), of sines
  /// and of products takes a third at most; more for chains of more than 20 joints.
  double margin() const { return margin_; }
  /// m, the same of the sweep over one configuration, of which only the places and axes of boxes are rounded, each
  /// once: an error of at most 1.2e-6 times the largest coordinate between two boxes; beyond that, FCL's tolerance.
  double single_margin() const { return 2e-6 * largest_ + 1e-6; }

  Model model() const;

 private:
  void add_frames(const RobotModel& robot);
  void add_spread_frame(const Eigen::Isometry3d& X_PF);
  void add_parts(const CollisionWorld& world);
  void add_spread_part(const CollisionShape& shape, int frame, const Eigen::Vector3d& ball_center,
                       const Eigen::Isometry3d& X_FG);
  int add_tree(const SphereTree& tree, const Eigen::Isometry3d& X_FG);
  void add_groups();
  void add_checks(const CollisionWorld& world, bool fixed_root);
  void add_checks_of(int group, const std::vector<PartPair>& pairs);
  void add_partner(int part, int other);
  void add_scene_row(int row);
  int group_rows() const { return rows_of(static_cast<int>(groups_.size())); }
  int part_rows() const { return rows_of(robot_parts_); }
  static int rows_of(int count) { return (count + kLanes - 1) / kLanes; }
  void add_scene_box(const Part& part);
  bool out_of_reach(int group, const Part& other) const;

  static constexpr double kLargestPosition = 1e4;  ///< rad or m

  /// Where a frame's origin can be: within radius of a point of the root frame.
  struct Reach {
    Eigen::Vector3d center;
    double radius;
  };
  /// Where the position of a sliding joint may be.
  struct Slide {
    int joint;  ///< index in the configuration
    double lower;
    double upper;
  };

  float* workspace(Buffers& buffers, const Model& model) const;

  std::vector<Frame> frames_;
  std::vector<SpreadFrame> spread_frames_;
  std::vector<Reach> reach_;  ///< [frames]
  std::vector<int> depth_;    ///< [frames] moving joints from the root
  std::vector<Slide> slides_;
  std::vector<int> frame_of_link_;       ///< [links]
  std::vector<Eigen::Isometry3d> X_FL_;  ///< [links]
  std::vector<Part> parts_;
  std::vector<SpreadPart> spread_parts_;
  std::vector<Node> nodes_;
  std::vector<Group> groups_;
  std::vector<int> group_of_;  ///< [robot parts]
  std::vector<SceneBox> scene_boxes_;
  std::vector<BoxRow> scene_rows_;
  std::vector<RowRange> group_ranges_;
  std::vector<GroupRow> group_partners_;
  std::vector<GroupPair> pairs_;
  std::vector<PartPair> part_pairs_;
  std::vector<PlacedPart> scene_parts_;
  std::vector<RowRange> partner_ranges_;
  std::vector<PartnerRow> partners_;
  std::vector<std::pair<int, int>> constant_pairs_;
  int robot_parts_ = 0;
  double largest_ = 0.0;  ///< m
  double margin_ = 0.0;
  bool usable_ = true;  ///< floats can hold it
};

}  // namespace opponens::robot::wide
