// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/grasp_views.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "report/text.hpp"

namespace opponens::report {
namespace {

constexpr double kOutside = -0.003;  // m along a contact's normal: clear of a drawn object that was simplified
constexpr double kInside = 0.002;    // m along a contact's normal: clear of the link that touches there
constexpr double kApart = 0.7071;    // cosine of the least angle between two views, 45 degrees
constexpr double kSeenAgain = 0.4;   // worth of a contact that an earlier view shows as well
constexpr int kAround = 12;
constexpr std::array<double, 3> kElevations{0.25, 0.7, 1.15};  // rad above the horizon

/// Lines of sight toward the viewer, from points in the plane across.
struct Lines {
  Eigen::Vector3d toward, right, up;
  std::vector<Eigen::Vector2d> at;  ///< [m] across
  std::vector<double> height;       ///< [m] along toward, where each begins

  Eigen::Vector2d across(const Eigen::Vector3d& p) const { return {right.dot(p), up.dot(p)}; }
};

/// Lines that begin at the contacts, `along` m along their normals.
Lines lines_of_sight(const std::vector<Contact>& contacts, double along, const Eigen::Vector3d& toward) {
  Lines lines;
  lines.toward = toward;
  lines.right = toward.unitOrthogonal();
  lines.up = toward.cross(lines.right);
  for (const auto& contact : contacts) {
    const Eigen::Vector3d begin = contact.p_OC + along * contact.n_O;
    lines.at.push_back(lines.across(begin));
    lines.height.push_back(toward.dot(begin));
  }
  return lines;
}

/// Marks the lines that pass through a facet turned to the viewer beyond their beginning. A closed body that stands in
/// the way, or that a line begins in, always has one.
void block(const Lines& lines, const Facet& facet, std::vector<bool>& blocked) {
  const double slope = facet.normal.dot(lines.toward);
  if (slope <= 1e-9) return;
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d high = -low;
  std::vector<Eigen::Vector2d> outline;
  outline.reserve(facet.corners.size());
  for (const auto& corner : facet.corners) {
    outline.push_back(lines.across(corner));
    low = low.min(outline.back().array());
    high = high.max(outline.back().array());
  }
  for (std::size_t i = 0; i < lines.at.size(); ++i) {
    const Eigen::Vector2d& at = lines.at[i];
    if (blocked[i] || (at.array() < low).any() || (at.array() > high).any()) continue;
    bool inside = true;
    for (std::size_t c = 0; c < outline.size() && inside; ++c) {
      const Eigen::Vector2d edge = outline[(c + 1) % outline.size()] - outline[c];
      const Eigen::Vector2d to = at - outline[c];
      inside = edge.x() * to.y() - edge.y() * to.x() >= 0.0;
    }
    if (!inside) continue;
    const Eigen::Vector3d base = at.x() * lines.right + at.y() * lines.up;
    blocked[i] = facet.normal.dot(facet.corners.front() - base) / slope > lines.height[i];
  }
}

std::vector<bool> blocked_by(const Lines& lines, const std::vector<Facet>& body) {
  std::vector<bool> blocked(lines.at.size(), false);
  for (const auto& facet : body) block(lines, facet, blocked);
  return blocked;
}

/// Where a direction lies as a person holding the hand would say it: its largest part, and the next when that is large
/// too, so that two views 45 degrees apart have different words.
std::string words_of(const GraspBodies& bodies, const Eigen::Vector3d& toward) {
  const auto& hand = bodies.hand;
  std::array<std::pair<double, const char*>, 6> sides{{{toward.dot(hand.palm), "before the palm"},
                                                       {-toward.dot(hand.palm), "behind the hand"},
                                                       {toward.dot(hand.thumb), "the thumb's side"},
                                                       {-toward.dot(hand.thumb), "the side away from the thumb"},
                                                       {toward.dot(hand.fingers), "the fingertips"},
                                                       {-toward.dot(hand.fingers), "the wrist"}}};
  std::stable_sort(sides.begin(), sides.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string words = concat({"from ", sides[0].second});
  if (sides[1].first > 0.45) words += concat({" and ", sides[1].second});
  return concat({words, toward.dot(bodies.up) > 0.6 ? ", from above" : ""});
}

std::vector<Eigen::Vector3d> candidates(const GraspBodies& bodies) {
  Eigen::Vector3d ahead = bodies.hand.palm - bodies.up * bodies.up.dot(bodies.hand.palm);
  if (ahead.norm() < 0.2) ahead = bodies.hand.fingers - bodies.up * bodies.up.dot(bodies.hand.fingers);
  ahead = ahead.norm() > 1e-9 ? Eigen::Vector3d(ahead.normalized()) : bodies.up.unitOrthogonal();
  const Eigen::Vector3d left = bodies.up.cross(ahead);
  std::vector<Eigen::Vector3d> directions;
  for (const double elevation : kElevations) {
    for (int i = 0; i < kAround; ++i) {
      const double azimuth = 2.0 * std::numbers::pi * i / kAround;
      directions.emplace_back(std::cos(elevation) * (std::cos(azimuth) * ahead + std::sin(azimuth) * left) +
                              std::sin(elevation) * bodies.up);
    }
  }
  return directions;
}

/// What a view of each contact is worth, 0 to 1.
std::vector<double> worth(const GraspView& view, const std::vector<Contact>& contacts) {
  std::vector<double> values;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const double seen = view.sights[i] == Sight::open ? 1.0 : view.sights[i] == Sight::behind_link ? 0.5 : 0.0;
    const double along = contacts[i].n_O.dot(view.toward);
    values.push_back(seen * (0.4 + 0.6 * std::sqrt(std::max(0.0, 1.0 - along * along))));
  }
  return values;
}

}  // namespace

std::vector<Sight> sights(const GraspBodies& bodies, const std::vector<Contact>& contacts,
                          const Eigen::Vector3d& toward) {
  const Lines outside = lines_of_sight(contacts, kOutside, toward);
  const Lines inside = lines_of_sight(contacts, kInside, toward);
  std::vector<Sight> result(contacts.size(), Sight::open);
  const auto by_object = blocked_by(outside, bodies.object);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (by_object[i]) result[i] = Sight::behind_others;
  }
  for (std::size_t link = 0; link < bodies.links.size(); ++link) {
    const auto by_other = blocked_by(outside, bodies.links[link]);
    const auto by_own = blocked_by(inside, bodies.links[link]);
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const bool own = bodies.contact_links[i] == static_cast<int>(link);
      if (result[i] == Sight::behind_others || !(own ? by_own[i] : by_other[i])) continue;
      result[i] = own ? Sight::behind_link : Sight::behind_others;
    }
  }
  return result;
}

std::vector<GraspView> grasp_views(const GraspBodies& bodies, const std::vector<Contact>& contacts, int count) {
  std::vector<GraspView> all;
  for (const auto& toward : candidates(bodies)) {
    all.push_back({toward, words_of(bodies, toward), sights(bodies, contacts, toward)});
  }
  std::vector<GraspView> chosen;
  std::vector<bool> shown(contacts.size(), false);
  while (static_cast<int>(chosen.size()) < count) {
    const GraspView* best = nullptr;
    double best_value = -1.0;
    for (const auto& view : all) {
      const bool apart = std::all_of(chosen.begin(), chosen.end(),
                                     [&](const GraspView& other) { return other.toward.dot(view.toward) < kApart; });
      if (!apart) continue;
      double value = 0.0;
      const auto values = worth(view, contacts);
      for (std::size_t i = 0; i < contacts.size(); ++i) value += (shown[i] ? kSeenAgain : 1.0) * values[i];
      if (value <= best_value + 1e-9) continue;  // of equal ones the first, whatever the rounding
      best = &view;
      best_value = value;
    }
    if (best == nullptr) break;
    chosen.push_back(*best);
    for (std::size_t i = 0; i < contacts.size(); ++i) shown[i] = shown[i] || best->sights[i] == Sight::open;
  }
  return chosen;
}

}  // namespace opponens::report
