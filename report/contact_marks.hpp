// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/grasp.hpp"
#include "report/picture.hpp"
#include "report/svg.hpp"

namespace opponens::report {

/// Colour of a finger's contacts by its number (finger_names), of the palm's for -1. The same in both themes of the
/// page, since pictures keep a light ground. Repeats after five.
Paint contact_paint(int finger);
std::string css(const Paint& paint);

/// A contact to draw.
struct ContactMark {
  Contact contact;
  int finger = -1;      ///< of finger_names; -1: palm
  bool hidden = false;  ///< the object or another link stands before it
};

/// Outline (px) of a friction cone: apex at the contact, axis along the normal, half angle atan(mu), sides `length` m
/// long, seen along an orthographic view. Convex; two points, the normal, for mu = 0. base: the rim, 24 points.
struct ConeOutline {
  std::vector<Eigen::Vector2d> silhouette;
  std::vector<Eigen::Vector2d> base;
  Eigen::Vector2d tip;  ///< where the axis meets the base
};
ConeOutline cone_outline(const Contact& contact, double length, const View& view);

/// Draws every contact over the bodies, the nearest last: its friction cone (none when the contact model has no
/// friction, cones = false), its normal as an arrow into the object, a dot (hidden: a ring, and the cone dashed), and
/// its number, from 1, where it covers no dot and no other number.
void draw_contacts(Svg& svg, const View& view, const std::vector<ContactMark>& marks, bool cones);

/// Hull of points in the plane, counter-clockwise, no three on a line (Andrew 1979, doi:10.1016/0020-0190(79)90072-3).
std::vector<Eigen::Vector2d> convex_outline(std::vector<Eigen::Vector2d> points);

}  // namespace opponens::report
