// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// What is to be checked against what, in rows.
#include <algorithm>
#include <cmath>
#include <limits>

#include "robot/wide_world.hpp"

namespace opponens::robot::wide {

void World::add_checks(const CollisionWorld& world, bool fixed_root) {
  const int scene_parts = static_cast<int>(parts_.size()) - robot_parts_;
  for (int j = 0; j < scene_parts; ++j) add_scene_box(parts_[static_cast<std::size_t>(robot_parts_ + j)]);
  for (int row = 0; row * kLanes < scene_parts; ++row) add_scene_row(row);
  std::vector<std::vector<PartPair>> pairs(groups_.size());
  for (int i = 0; i < robot_parts_; ++i) {
    const Part& part = parts_[static_cast<std::size_t>(i)];
    partner_ranges_.push_back({0, 0});
    for (const int j : world.partners[static_cast<std::size_t>(i)]) {
      const Part& other = parts_[static_cast<std::size_t>(j)];
      const float reach = part.ball_radius + other.ball_radius;
      if (part.frame == other.frame || (fixed_root && part.frame == kRoot && other.frame == kWorld)) {
        constant_pairs_.emplace_back(i, j);
        continue;
      }
      const int group = group_of_[static_cast<std::size_t>(i)];
      if (j >= robot_parts_ && fixed_root && out_of_reach(group, other)) continue;
      pairs[static_cast<std::size_t>(group)].push_back({i, j, reach * reach});
      add_partner(i, j);
    }
  }
  for (int group = 0; group < static_cast<int>(groups_.size()); ++group) {
    add_checks_of(group, pairs[static_cast<std::size_t>(group)]);
  }
}

/// Partners come in ascending order, for one part after the other.
void World::add_partner(int part, int other) {
  const bool scene = other >= robot_parts_;
  const int index = scene ? other - robot_parts_ : other;
  RowRange& range = partner_ranges_[static_cast<std::size_t>(part)];
  int& rows = scene ? range.of_scene : range.of_robot;
  if (rows == 0 || partners_.back().row != index / kLanes) {
    partners_.push_back({{}, 0, index / kLanes});
    ++rows;
  }
  const float reach = parts_[static_cast<std::size_t>(part)].ball_radius +
                      (scene ? 0.0F : parts_[static_cast<std::size_t>(other)].ball_radius);
  partners_.back().squared_reach[index % kLanes] = reach * reach;
  partners_.back().wanted |= 1U << (index % kLanes);
}

/// pairs: of the parts of one group, each with later parts.
void World::add_checks_of(int group, const std::vector<PartPair>& pairs) {
  const float radius = groups_[static_cast<std::size_t>(group)].radius;
  RowRange range{0, 0};
  for (int row = 0; row < group_rows() + static_cast<int>(scene_rows_.size()); ++row) {
    const bool scene = row >= group_rows();
    GroupRow partners{0, scene ? row - group_rows() : row, static_cast<int>(pairs_.size())};
    for (int place = 0; place < kLanes; ++place) {
      const int begin = static_cast<int>(part_pairs_.size());
      const int partner = partners.row * kLanes + place;
      float reach = radius;
      for (const PartPair& pair : pairs) {
        const bool of_scene = pair.b >= robot_parts_;
        const int own = of_scene ? pair.b - robot_parts_ : group_of_[static_cast<std::size_t>(pair.b)];
        if (of_scene != scene || own != partner) continue;
        if (!scene) reach = radius + groups_[static_cast<std::size_t>(partner)].radius;
        part_pairs_.push_back(pair);
      }
      const int end = static_cast<int>(part_pairs_.size());
      if (end > begin) partners.wanted |= 1U << place;
      pairs_.push_back({reach * reach, begin, end});
    }
    if (partners.wanted == 0) {
      pairs_.resize(static_cast<std::size_t>(partners.pairs));
      continue;
    }
    group_partners_.push_back(partners);
    ++(scene ? range.of_scene : range.of_robot);
  }
  group_ranges_.push_back(range);
}

/// Boxes with the root's axes around kLanes parts of the scene.
void World::add_scene_row(int row) {
  BoxRow boxes;
  for (int place = 0; place < kLanes; ++place) {
    const std::size_t index = static_cast<std::size_t>(robot_parts_ + row * kLanes + place);
    for (int axis = 0; axis < 3; ++axis) {
      float half = -std::numeric_limits<float>::max();  // overlaps nothing
      if (index < parts_.size()) {
        const Part& part = parts_[index];
        half = 0.0F;
        for (int k = 0; k < 3; ++k) half += std::abs(part.box_axes[3 * axis + k]) * part.half_extents[k];
        half *= 1.0F + kRadiusRounding;
        boxes.center[axis][place] = part.box_center[axis];
      } else {
        boxes.center[axis][place] = 0.0F;
      }
      boxes.half[axis][place] = half;
    }
  }
  scene_rows_.push_back(boxes);
}

void World::add_scene_box(const Part& part) {
  SceneBox box;
  const auto fill = [](float* lanes, float value) { std::fill_n(lanes, kLanes, value); };
  for (int k = 0; k < 3; ++k) {
    fill(box.center[k], part.box_center[k]);
    fill(box.half[k], part.half_extents[k]);
  }
  for (int k = 0; k < 9; ++k) fill(box.axes[k], part.box_axes[k]);
  const Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> axes(part.box_axes);
  box.aligned = axes.isIdentity(0.0F);
  scene_boxes_.push_back(box);
}

/// Whether a group of the robot never meets a part of the scene, wherever the joints turn.
bool World::out_of_reach(int group, const Part& other) const {
  const Group& own = groups_[static_cast<std::size_t>(group)];
  const Reach& reach = reach_[static_cast<std::size_t>(own.frame)];
  const OrientedBox box{Eigen::Map<const Eigen::Vector3f>(other.box_center).cast<double>(),
                        Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(other.box_axes).cast<double>(),
                        Eigen::Map<const Eigen::Vector3f>(other.half_extents).cast<double>()};
  const double around = Eigen::Map<const Eigen::Vector3f>(own.center).cast<double>().norm() + own.radius;
  return point_box_distance(reach.center, box) > reach.radius + around + margin_;
}

}  // namespace opponens::robot::wide
