// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/propose_contacts.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "robot/palm_patch.hpp"
#include "robot/phalanges.hpp"

namespace opponens::robot {

namespace {

using Eigen::Vector3d;

constexpr int kFingerPads = 3;
constexpr int kThumbPads = 2;
constexpr std::size_t kPalmPoints = 3;
constexpr double kPadFacing = 0.5;  // cosine of a pad's normal with the pad side, at least
constexpr double kTipFacing = 0.9;  // cosine of a tip's normal with its direction, where there is such a place

struct Hand {
  const RobotModel& robot;
  std::vector<Eigen::Isometry3d> X_PL;  ///< at rest
};

SurfacePoint surface_point(const Hand& hand, const SurfaceHit& hit, const std::string& finger,
                           const std::string& name) {
  const Eigen::Isometry3d X_LP = hand.X_PL[static_cast<std::size_t>(hit.link)].inverse();
  return {name, finger, hit.link, X_LP * hit.p, X_LP.linear() * hit.normal};
}

/// The middle of a body's width around a place along its bone, and half of that width.
Eigen::Vector2d middle_across(const Phalanx& phalanx, double along) {
  const double reach = 0.3 * (phalanx.to - phalanx.from);
  const Eigen::Matrix3Xd near = slab(phalanx.body.vertices, phalanx.bone, along - reach, along + reach);
  const Eigen::Vector2d extent = extent_along(near, phalanx.across());
  return {0.5 * (extent[0] + extent[1]), 0.5 * (extent[1] - extent[0])};
}

/// The pad near a fraction of the bone: of a 5 x 5 grid of rays the one whose normal and place are best.
std::optional<SurfaceHit> pad_at(const Phalanx& phalanx, double fraction) {
  const double length = phalanx.to - phalanx.from;
  const double along = phalanx.from + fraction * length;
  const Eigen::Vector2d width = middle_across(phalanx, along);
  std::optional<SurfaceHit> best;
  double least = std::numeric_limits<double>::infinity();
  for (int i = -2; i <= 2; ++i) {
    for (int j = -2; j <= 2; ++j) {
      const Vector3d p =
          (along + 0.06 * i * length) * phalanx.bone + (width[0] + 0.2 * j * width[1]) * phalanx.across();
      const std::optional<SurfaceHit> hit = outermost(phalanx.body, p, phalanx.side);
      if (!hit || hit->normal.dot(phalanx.side) < kPadFacing) continue;
      const double cost = 1.0 - hit->normal.dot(phalanx.side) + 0.02 * (std::abs(i) + std::abs(j));
      if (cost >= least) continue;
      least = cost;
      best = hit;
    }
  }
  return best;
}

/// Where the last body reaches furthest 30 deg from its end to the pad side; moved towards the pad until the surface
/// there faces that way (the end of a box is an edge).
std::optional<SurfaceHit> tip_of(const Phalanx& last) {
  const Vector3d outward = std::sqrt(0.75) * last.side + 0.5 * last.bone;
  const Vector3d along = std::sqrt(0.75) * last.bone - 0.5 * last.side;
  const Eigen::Matrix3Xd& vertices = last.body.vertices;
  const Eigen::Vector2d reach = extent_along(vertices, last.bone);
  const Eigen::Matrix3Xd end = slab(vertices, last.bone, reach[1] - 0.25 * (reach[1] - last.from), reach[1]);
  const Eigen::Vector2d across = extent_along(end, last.across());
  const Eigen::Vector2d thick = extent_along(end, last.side);
  const double furthest = extent_along(end, outward)[1];
  const Eigen::Matrix3Xd top = slab(end, outward, furthest - 0.05 * (thick[1] - thick[0]), furthest);
  const double place = (along.transpose() * top).mean();
  std::optional<SurfaceHit> best;
  for (const double shift : {0.0, 0.05, 0.1, 0.2, 0.3, 0.4}) {
    const Vector3d p = (place - shift * (thick[1] - thick[0])) * along + across.mean() * last.across();
    const std::optional<SurfaceHit> hit = outermost(last.body, p, outward);
    if (!hit) continue;
    if (!best || hit->normal.dot(outward) > best->normal.dot(outward)) best = hit;
    if (best->normal.dot(outward) > kTipFacing) break;
  }
  return best;
}

/// How many pads each phalanx gets: one each of the outermost ones, those left over to the longest.
std::vector<int> pads_per_phalanx(const std::vector<Phalanx>& phalanges, int pads) {
  std::vector<int> count(phalanges.size(), 0);
  int left = pads;
  for (std::size_t i = phalanges.size(); i-- > 0 && left > 0; --left) count[i] = 1;
  for (; left > 0 && !phalanges.empty(); --left) {
    const auto spacing = [&](std::size_t i) { return (phalanges[i].to - phalanges[i].from) / (count[i] + 1); };
    std::size_t longest = 0;
    for (std::size_t i = 1; i < phalanges.size(); ++i) {
      if (spacing(i) > spacing(longest) + 1e-9) longest = i;
    }
    ++count[longest];
  }
  return count;
}

void append_pads(const Hand& hand, const FingerBones& finger, ContactProposal& proposal) {
  const int wanted = finger.thumb ? kThumbPads : kFingerPads;
  const std::vector<int> count = pads_per_phalanx(finger.phalanges, wanted);
  int number = 0;
  for (std::size_t i = 0; i < finger.phalanges.size(); ++i) {
    for (int k = 0; k < count[i]; ++k) {
      const std::optional<SurfaceHit> pad = pad_at(finger.phalanges[i], (k + 1.0) / (count[i] + 1.0));
      const std::string name = finger.name + "_" + std::to_string(++number);
      if (pad) {
        proposal.contact_points.push_back(surface_point(hand, *pad, finger.name, name));
      } else {
        proposal.notes.push_back(name + ": no surface there that faces the pad side");
      }
    }
  }
}

/// Where the surface is that a given tip means: some lie a little off the shapes that count.
std::optional<SurfaceHit> surface_at(const Hand& hand, const FingerBones& finger, const SurfacePoint& tip) {
  constexpr double kNear = 0.005;  // m
  const Eigen::Isometry3d& X_PL = hand.X_PL[static_cast<std::size_t>(tip.link)];
  const Vector3d p = X_PL * tip.p_L;
  const std::optional<SurfaceHit> hit = outermost(finger.phalanges.back().body, p, X_PL.linear() * tip.n_L);
  return hit && (hit->p - p).norm() < kNear ? hit : std::nullopt;
}

void append_tip(const Hand& hand, const FingerBones& finger, ContactProposal& proposal) {
  const auto& given = hand.robot.description().tips;
  const auto known =
      std::find_if(given.begin(), given.end(), [&](const SurfacePoint& tip) { return tip.finger == finger.name; });
  std::optional<SurfaceHit> hit;
  if (known != given.end()) hit = surface_at(hand, finger, *known);
  if (!hit) hit = tip_of(finger.phalanges.back());
  if (known != given.end()) proposal.tips.push_back(*known);
  if (!hit) {
    proposal.notes.push_back("finger '" + finger.name + "': no tip found");
    return;
  }
  if (known == given.end()) proposal.tips.push_back(surface_point(hand, *hit, finger.name, finger.name));
  proposal.contact_points.push_back(surface_point(hand, *hit, finger.name, finger.name + "_tip"));
}

void append_palm(const Hand& hand, const std::vector<FingerBones>& fingers, ContactProposal& proposal) {
  const Vector3d side = palm_directions(fingers).side;
  const HandBody palm = hand_body(hand.robot, {hand.robot.palm()}, hand.X_PL);
  std::vector<SurfaceHit> points;
  if (side.norm() > 0.0) points = patch_points(palm, side);
  for (std::size_t i = 0; i < points.size(); ++i) {
    proposal.contact_points.push_back(surface_point(hand, points[i], "palm", "palm_" + std::to_string(i + 1)));
  }
  if (points.size() == kPalmPoints) return;
  proposal.notes.push_back(side.norm() == 0.0
                               ? std::string("the fingers do not tell which side of the palm faces an object")
                               : "the palm link has no flat patch for " + std::to_string(kPalmPoints - points.size()) +
                                     " of its points");
}

}  // namespace

ContactProposal propose_contacts(const RobotModel& robot) {
  const Hand hand{robot, rest_in_palm(robot)};
  const std::vector<FingerBones> fingers = finger_bones(robot, hand.X_PL);
  ContactProposal proposal;
  if (fingers.empty()) proposal.notes.push_back("no finger leaves the palm '" + robot.description().palm_link + "'");
  for (const FingerBones& finger : fingers) {
    proposal.notes.insert(proposal.notes.end(), finger.notes.begin(), finger.notes.end());
    if (finger.phalanges.empty()) continue;
    append_pads(hand, finger, proposal);
    append_tip(hand, finger, proposal);
  }
  if (!fingers.empty()) append_palm(hand, fingers, proposal);
  return proposal;
}

}  // namespace opponens::robot
