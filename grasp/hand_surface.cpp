// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/hand_surface.hpp"

#include <algorithm>
#include <map>
#include <variant>

#include <Eigen/Geometry>

#include "core/require.hpp"
#include "robot/mesh.hpp"

namespace opponens::grasp {
namespace {

constexpr double kSparseSpacing = 0.02;     // m
constexpr double kCoarseSpacing = 0.009;    // m
constexpr double kDenseSpacing = 0.0025;    // m
constexpr double kLinkGridSpacing = 0.003;  // m, of link meshes
constexpr double kLinkGridMargin = 0.02;    // m, fingers pass each other nearer than this only rarely
constexpr std::size_t kLinkGridNodes = 100000;
constexpr double kWholeHand = 1.0;  // m, no hand is larger

std::vector<Eigen::Vector3d> samples(const std::vector<robot::Geometry>& geometry, double spacing) {
  std::vector<Eigen::Vector3d> points;
  for (const robot::Geometry& g : geometry) {
    for (const Eigen::Vector3d& p : robot::surface_samples(g, spacing)) points.push_back(p);
  }
  return points;
}

bool is_mesh(const robot::Geometry& g) {
  return std::holds_alternative<std::shared_ptr<const robot::TriangleMesh>>(g.shape);
}

/// Whether both are the same meshes at the same places; links of primitives are quick to make again.
bool same_meshes(const std::vector<robot::Geometry>& a, const std::vector<robot::Geometry>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const robot::Geometry& x, const robot::Geometry& y) {
    const auto* mesh_x = std::get_if<std::shared_ptr<const robot::TriangleMesh>>(&x.shape);
    const auto* mesh_y = std::get_if<std::shared_ptr<const robot::TriangleMesh>>(&y.shape);
    return mesh_x != nullptr && mesh_y != nullptr && *mesh_x == *mesh_y && x.X_BG.matrix() == y.X_BG.matrix();
  });
}

std::vector<std::shared_ptr<const LinkShape>> link_shapes(const std::vector<robot::Link>& links) {
  std::vector<std::shared_ptr<const LinkShape>> shapes;
  for (std::size_t i = 0; i < links.size(); ++i) {
    std::size_t twin = 0;
    while (twin < i && !(same_meshes(links[twin].collision, links[i].collision) && !links[i].collision.empty())) ++twin;
    shapes.push_back(twin < i ? shapes[twin] : std::make_shared<const LinkShape>(links[i].collision));
  }
  return shapes;
}

void add_bounding_spheres(HandSurface& surface) {
  for (const auto& shape : surface.shapes) {
    const bool empty = shape->points.empty();
    surface.link_center.push_back(empty ? Eigen::Vector3d::Zero().eval() : shape->points.center());
    surface.link_radius.push_back((empty ? 0.0 : shape->points.radius()) + kDenseSpacing);
  }
}

std::vector<std::vector<int>> find_strangers(const robot::RobotModel& hand) {
  const robot::RobotDescription& d = hand.description();
  const auto parent = [&](int link) {
    const int joint = d.links[static_cast<std::size_t>(link)].joint;
    return joint < 0 ? -1 : d.joints[static_cast<std::size_t>(joint)].parent;
  };
  const int count = static_cast<int>(d.links.size());
  std::vector<std::vector<int>> strangers(d.links.size());
  for (int a = 0; a < count; ++a) {
    for (int b = 0; b < count; ++b) {
      const bool joined = a == b || parent(a) == b || parent(b) == a;
      const bool empty = d.links[static_cast<std::size_t>(b)].collision.empty();
      if (joined || empty || d.allowed_collisions.contains({std::min(a, b), std::max(a, b)})) continue;
      strangers[static_cast<std::size_t>(a)].push_back(b);
    }
  }
  return strangers;
}

std::vector<LinkDrive> find_drives(const robot::RobotModel& hand) {
  const robot::RobotDescription& d = hand.description();
  std::map<std::string, int> index;
  for (int i = 0; i < hand.dof(); ++i) index[hand.joint_names()[static_cast<std::size_t>(i)]] = i;
  std::vector<LinkDrive> drives(d.links.size());
  for (std::size_t link = 0; link < d.links.size(); ++link) {
    if (d.links[link].joint < 0) continue;
    const robot::Joint& joint = d.joints[static_cast<std::size_t>(d.links[link].joint)];
    const auto driver = index.find(joint.mimic ? joint.mimic->joint : joint.name);
    if (joint.type == robot::JointType::fixed || driver == index.end()) continue;
    drives[link] = {driver->second, joint.mimic ? joint.mimic->multiplier : 1.0};
  }
  return drives;
}

/// For each link and each index in q whether that joint, or a joint that mimics it, lies between palm and link.
std::vector<std::vector<bool>> moved_by(const robot::RobotModel& hand, const std::vector<LinkDrive>& drives) {
  const robot::RobotDescription& d = hand.description();
  std::vector<std::vector<bool>> moves(d.links.size(), std::vector<bool>(static_cast<std::size_t>(hand.dof()), false));
  for (std::size_t link = 0; link < d.links.size(); ++link) {
    if (d.links[link].joint < 0) continue;
    const robot::Joint& joint = d.joints[static_cast<std::size_t>(d.links[link].joint)];
    moves[link] = moves[static_cast<std::size_t>(joint.parent)];
    if (drives[link].index >= 0) moves[link][static_cast<std::size_t>(drives[link].index)] = true;
  }
  return moves;
}

std::vector<Finger> find_fingers(const robot::RobotModel& hand, const std::vector<std::vector<bool>>& moves) {
  const robot::RobotDescription& d = hand.description();
  std::vector<int> branch(d.links.size(), -1);  // finger of each link; links fixed to the palm belong to none
  std::vector<Finger> fingers;
  for (std::size_t link = 0; link < d.links.size(); ++link) {
    if (std::none_of(moves[link].begin(), moves[link].end(), [](bool m) { return m; })) continue;
    const auto parent = static_cast<std::size_t>(d.joints[static_cast<std::size_t>(d.links[link].joint)].parent);
    if (branch[parent] < 0) fingers.emplace_back();
    branch[link] = branch[parent] < 0 ? static_cast<int>(fingers.size()) - 1 : branch[parent];
    Finger& finger = fingers[static_cast<std::size_t>(branch[link])];
    finger.links.push_back(static_cast<int>(link));
    for (int j = 0; j < hand.dof(); ++j) {
      const bool known = std::find(finger.joints.begin(), finger.joints.end(), j) != finger.joints.end();
      if (moves[link][static_cast<std::size_t>(j)] && !known) finger.joints.push_back(j);
    }
  }
  return fingers;
}

void find_approach(const robot::RobotModel& hand, const Eigen::VectorXd& q, HandSurface& surface) {
  const std::vector<Eigen::Isometry3d> X_HL = hand.link_poses(q);
  Eigen::Vector3d palm_normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d palm_point = Eigen::Vector3d::Zero();
  Eigen::Vector3d any_normal = Eigen::Vector3d::Zero();
  int palm_points = 0;
  for (const robot::SurfacePoint& point : hand.description().contact_points) {
    const auto link = static_cast<std::size_t>(point.link);
    const Eigen::Vector3d n = X_HL[link].linear() * point.n_L;
    any_normal += n;
    if (point.link != hand.palm()) continue;
    palm_normal += n;
    palm_point += X_HL[link] * point.p_L;
    ++palm_points;
  }
  const bool use_palm = palm_points > 0 && palm_normal.norm() > 0.1;
  surface.palm_center = palm_points > 0 ? Eigen::Vector3d(palm_point / palm_points) : Eigen::Vector3d::Zero();
  surface.approach = use_palm ? palm_normal : any_normal;
  require(surface.approach.norm() > 1e-6, "grasp search: the hand's contact points do not tell where its palm looks");
  surface.approach.normalize();
}

}  // namespace

LinkShape::LinkShape(const std::vector<robot::Geometry>& geometry)
    : sparse(samples(geometry, kSparseSpacing)),
      coarse(samples(geometry, kCoarseSpacing)),
      points(samples(geometry, kDenseSpacing)),
      body(geometry) {
  if (std::none_of(geometry.begin(), geometry.end(), is_mesh) || points.empty()) return;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points.points()) box.extend(p);
  grid = std::make_unique<const DistanceGrid>(
      [this](const Eigen::Vector3d& p) { return body.query(p, kWholeHand).value; }, box,
      DistanceGrid::Layout{kLinkGridSpacing, kLinkGridMargin, kLinkGridNodes}, 1);
}

double LinkShape::rough(const Eigen::Vector3d& p_L) const {
  return grid ? grid->bound(p_L) : body.query(p_L, kWholeHand).value;
}

HandSurface hand_surface(const robot::RobotModel& hand, const Eigen::VectorXd& q) {
  require(hand.palm() == 0, "grasp search: the hand model must be rooted at its palm link (load_hand)");
  require(!hand.description().contact_points.empty(), "grasp search: the hand has no contact_points");
  HandSurface surface;
  surface.shapes = link_shapes(hand.links());
  add_bounding_spheres(surface);
  surface.strangers = find_strangers(hand);
  surface.drives = find_drives(hand);
  surface.moves = moved_by(hand, surface.drives);
  for (std::size_t link = 0; link < surface.moves.size(); ++link) {
    if (std::count(surface.moves[link].begin(), surface.moves[link].end(), true) == 0) {
      surface.palm_links.push_back(static_cast<int>(link));
    }
  }
  surface.fingers = find_fingers(hand, surface.moves);
  find_approach(hand, q, surface);
  return surface;
}

}  // namespace opponens::grasp
