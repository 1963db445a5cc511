// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/grasp.hpp"
#include "report/facets.hpp"
#include "report/hand_drawing.hpp"

namespace opponens::report {

/// Hand and object of a grasp where they are drawn, in the object's frame O.
struct GraspBodies {
  std::vector<std::vector<Facet>> links;  ///< of the hand, by link index
  std::vector<Facet> object;
  std::vector<int> contact_links;  ///< [m] index of the link that touches; -1: the hand has none of that name
  HandAxes hand;                   ///< in O
  Eigen::Vector3d up;              ///< unit, the world's up in O
};

/// What stands between a contact and the viewer.
enum class Sight {
  open,           ///< nothing
  behind_link,    ///< only the link that touches: the point lies on its far side, and its mark drawn on the link tells
  behind_others,  ///< the object, or another link
};

/// How each contact [m] is seen along an orthographic view from `toward` (unit). Lines of sight begin 3 mm outside the
/// object, since the drawn object may be simplified; for the link that touches, 2 mm inside. Cost O(F m).
std::vector<Sight> sights(const GraspBodies& bodies, const std::vector<Contact>& contacts,
                          const Eigen::Vector3d& toward);

/// A direction to look from.
struct GraspView {
  Eigen::Vector3d toward = Eigen::Vector3d::UnitX();  ///< unit, to the viewer
  std::string words;                                  ///< "from the thumb's side, from above"
  std::vector<Sight> sights;                          ///< [m]
};

/// `count` directions out of 36 (twelve around the object's vertical, at three elevations), chosen one after the other:
/// the next is the one that shows most contacts, those in sight already counting less, and lies at least 45 degrees
/// from those before. A contact counts more when its cone is seen from the side. Deterministic; the grasp turned about
/// the vertical is seen from directions turned alike. Fewer when no further direction is far enough from the others.
std::vector<GraspView> grasp_views(const GraspBodies& bodies, const std::vector<Contact>& contacts, int count);

}  // namespace opponens::report
