// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "report/facets.hpp"
#include "report/svg.hpp"

namespace opponens::report {

/// The colour of a body, before light.
struct Paint {
  int red = 0, green = 0, blue = 0;  ///< 0..255
  bool shows_through = false;        ///< drawn as a faint ghost where bodies without this hide it
};

/// An orthographic camera and the window it fills. Right-handed: right, up, toward the viewer.
struct View {
  Eigen::Vector3d right, up, toward;                 ///< unit
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< m, along right and up
  double scale = 1.0;                                ///< px per m
  double width = 0.0, height = 0.0;                  ///< px

  Eigen::Vector2d project(const Eigen::Vector3d& p) const;  ///< px, y down
};

/// A camera looking along -toward with up as upright as possible, zoomed so that all points lie inside the window less
/// the margin (px). points must not be empty; toward not parallel to up.
View fit_view(const Eigen::Vector3d& toward, const Eigen::Vector3d& up, const std::vector<Eigen::Vector3d>& points,
              double width, double height, double margin);

/// Draws the facets into svg, hidden ones left out, lit from the upper left, cut off at the window. Needs the page's
/// style sheet (class "solid").
void draw_facets(Svg& svg, const View& view, std::vector<Facet> facets, const std::vector<Paint>& paints);

}  // namespace opponens::report
