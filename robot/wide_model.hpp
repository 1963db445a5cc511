// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Internal to robot/: the single-precision picture of a collision world that the wide sweep runs over, in plain arrays.
#pragma once

namespace opponens::robot::wide {

inline constexpr int kLanes = 8;  ///< configurations at a time
inline constexpr int kWorld = 0;  ///< frame of the scene; everything is expressed in the robot's usual root
inline constexpr int kRoot = 1;   ///< frame of the robot's root link

enum class Motion { none, turn, slide };  ///< about, along the frame's z axis

/// A moving frame F in its parent P: X_PF = [rotation, translation] turned about, or moved along, its own z.
struct Frame {
  int parent;
  Motion motion;
  int joint;  ///< index in the configuration
  double multiplier;
  double offset;      ///< rad or m; position = multiplier q + offset
  float rotation[9];  ///< row-major
  float translation[3];
};

enum class Form {
  box,       ///< the box is the shape itself
  cylinder,  ///< about the box's z axis
  other,     ///< anything in the box and in its sphere tree
};

/// One shape, fixed to a frame. Radii and half extents are enlarged by the margin for rounding.
struct Part {
  int frame;
  float ball_center[3];
  float ball_radius;
  float box_center[3];
  float box_axes[9];  ///< row-major; columns are the box's axes in the frame
  float half_extents[3];
  Form form;
  int root;  ///< first node of its sphere tree; unused where boxes and cylinders are the shape
};

/// A ball of a sphere tree, in the part's frame.
struct Node {
  float center[3];
  float radius;
  int first_child;
  int children;
};

/// A frame for one configuration, in double precision, every number four times: what the columns of the parent's pose
/// are multiplied with.
struct alignas(32) SpreadFrame {
  double column[3][3][4];  ///< of the rotation
  double translation[3][4];
};

/// A part for one configuration: what the columns of its frame's pose are multiplied with for two vectors at a time,
/// each number four times.
struct alignas(4 * kLanes) SpreadPart {
  float box[2][3][kLanes];  ///< [place of two, column] for center and first axis, and for second and third axis
  float rest[2][kLanes];    ///< the fourth places of these vectors (PlacedPart)
  float ball_center[3][4];
  int frame;
};

/// A part's box in the root frame: center, axes, and in the fourth places its half extents, enlarged by the margin for
/// one configuration, and its form.
struct alignas(32) PlacedPart {
  float center[4];
  float axis[3][4];
};

/// Up to kLanes partners of a part, in a row of the robot's parts or of the scene's: which of them to check, and for
/// balls how near their centers may come.
struct alignas(4 * kLanes) PartnerRow {
  float squared_reach[kLanes];  ///< m^2, of the sum of the radii; of the part alone where the partners are of the scene
  unsigned wanted;              ///< as bits
  int row;
};

/// How many rows of partners a part or a group has: first of the robot, then of the scene.
struct RowRange {
  int of_robot;
  int of_scene;
};

/// Parts of one frame that lie close together, in one ball.
struct Group {
  int frame;
  float center[3];
  float radius;
};

/// Two parts to check, the first one of the robot.
struct PartPair {
  int a;
  int b;
  float squared_reach;  ///< m^2, of the sum of the balls' radii
};

/// A group and a partner (another group, or a part of the scene): which of their parts to check against each other.
struct GroupPair {
  float squared_reach;  ///< m^2, of the sum of the radii; of a group alone where the partner is of the scene
  int begin;            ///< of part pairs
  int end;
};

/// Up to kLanes partners of a group, in a row of the robot's groups or of the scene's parts: which of them to check.
struct GroupRow {
  unsigned wanted;  ///< as bits
  int row;
  int pairs;  ///< first of kLanes pairs
};

/// A box of the scene, each number repeated for all lanes: center, half extents, and the axes by columns.
struct alignas(4 * kLanes) SceneBox {
  float center[3][kLanes];
  float half[3][kLanes];
  float axes[9][kLanes];
  bool aligned;  ///< with the root's axes
};

/// Up to kLanes boxes aligned with the root's axes, side by side. Unused ones are far away.
struct alignas(4 * kLanes) BoxRow {
  float center[3][kLanes];
  float half[3][kLanes];
};

/// Views of arrays; the sweep allocates nothing and calls nothing that is compiled elsewhere.
struct Model {
  float margin;         ///< m, by which sizes are enlarged; above the error of a point's place
  float single_margin;  ///< m, the same for one configuration
  const Frame* frames;
  const SpreadFrame* spread_frames;
  int frame_count;
  const Part* parts;  ///< of the robot, then of the scene
  const SpreadPart* spread_parts;
  int robot_part_count;
  int part_count;
  const Node* nodes;
  const Group* groups;  ///< of the robot
  int group_count;
  int group_rows;               ///< rows of kLanes groups
  const SceneBox* scene_boxes;  ///< [parts of the scene]
  const BoxRow* scene_rows;     ///< around them
  int scene_row_count;
  const RowRange* group_ranges;  ///< [groups]
  const GroupRow* group_partners;
  const GroupPair* pairs;
  const PartPair* part_pairs;
  // For one configuration, whose partners are asked in rows: first of the robot's parts, then of the scene's.
  const PlacedPart* scene_parts;
  int part_rows;                   ///< rows of kLanes parts of the robot
  const RowRange* partner_ranges;  ///< [robot parts]
  const PartnerRow* partners;
};

/// A pair that the sweep could not tell apart in some lanes.
struct Unknown {
  int a;  ///< part of the robot
  int b;  ///< part of the robot or the scene
  unsigned lanes;
  unsigned touching;  ///< lanes of them in which a point was found that is inside both by more than the margin
};

struct Query {
  const double* q[kLanes];  ///< [d] each; idle lanes repeat another
  unsigned lanes;           ///< asked for
  const float* root;        ///< X of the robot's root in its usual place, rotation row-major then translation [12]
  bool first_only = false;  ///< lanes after one that touches do not matter
};

struct SingleQuery {
  const double* q;     ///< [d]
  const double* root;  ///< as of Query, [12]
};

/// Floats of memory that either sweep needs, to be aligned to 64 bytes.
int workspace_size(const Model& model);

/// Writes at most one Unknown for each pair into found and returns how many. A lane found to touch is not pursued
/// further. A lane that matters and that no Unknown names is free of collision: by single-precision kinematics with an
/// error far below the margin, balls around the shapes (ball, ball tree) and the separating axis theorem on oriented
/// boxes. Portable; sweep_avx2 is the same for a processor with AVX2 and FMA.
int sweep(const Model& model, const Query& query, float* workspace, Unknown* found);
int sweep_avx2(const Model& model, const Query& query, float* workspace, Unknown* found);

/// The same for one configuration (lane 0), with a smaller margin as kinematics are in double precision. Stops at the
/// first pair that touches, which is then the last that it writes.
int sweep(const Model& model, const SingleQuery& query, float* workspace, Unknown* found);
int sweep_avx2(const Model& model, const SingleQuery& query, float* workspace, Unknown* found);

/// Index of the point farthest along n of a padded list, [3 x count]: one coordinate after the other.
int farthest_portable(const float* xyz, int count, const float* n);
int farthest_avx2(const float* xyz, int count, const float* n);

}  // namespace opponens::robot::wide
