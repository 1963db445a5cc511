// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Geometry>

#include "core/require.hpp"
#include "report/text.hpp"

namespace opponens::report {
namespace {

constexpr int kRaster = 2;         // raster cells per px in the visibility test
constexpr double kAmbient = 0.56;  // share of a paint's brightness without light
constexpr double kGhost = 0.8;     // a facet with less of its own visible area left is drawn as a ghost too
constexpr int kShades = 24;        // brightness levels: equal neighbours merge into one path

using Polygon = std::vector<Eigen::Vector2d>;

/// Which facet is seen in each cell of a raster over the window.
class VisibilityRaster {
 public:
  VisibilityRaster(double width, double height)
      : columns_(static_cast<int>(width) * kRaster),
        rows_(static_cast<int>(height) * kRaster),
        cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -1) {}

  /// Paints a convex polygon (px): every cell whose centre lies inside.
  void fill(const Polygon& polygon, int id) {
    double top = std::numeric_limits<double>::infinity();
    double bottom = -top;
    for (const auto& p : polygon) {
      top = std::min(top, p.y() * kRaster);
      bottom = std::max(bottom, p.y() * kRaster);
    }
    const int first = std::clamp(static_cast<int>(std::ceil(std::max(top, -1.0) - 0.5)), 0, rows_);
    const int last = std::min(rows_ - 1, static_cast<int>(std::floor(std::min<double>(bottom, rows_) - 0.5)));
    for (int row = first; row <= last; ++row) fill_row(polygon, row, id);
  }

  /// Number of cells in which each of `count` facets is seen.
  std::vector<int> seen(std::size_t count) const {
    std::vector<int> cells(count, 0);
    for (const int id : cells_) {
      if (id >= 0) ++cells[static_cast<std::size_t>(id)];
    }
    return cells;
  }

 private:
  void fill_row(const Polygon& polygon, int row, int id) {
    const double y = row + 0.5;
    double left = std::numeric_limits<double>::infinity();
    double right = -left;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector2d a = polygon[i] * kRaster;
      const Eigen::Vector2d b = polygon[(i + 1) % polygon.size()] * kRaster;
      if ((a.y() <= y) == (b.y() <= y)) continue;
      const double x = a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y());
      left = std::min(left, x);
      right = std::max(right, x);
    }
    const int first = static_cast<int>(std::ceil(std::clamp<double>(left, 0.0, columns_) - 0.5));
    const int end = static_cast<int>(std::ceil(std::clamp<double>(right, 0.0, columns_) - 0.5));
    for (int column = first; column < end; ++column) {
      cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)] =
          id;
    }
  }

  int columns_, rows_;
  std::vector<int> cells_;
};

std::string shade(const Paint& paint, const Eigen::Vector3d& normal, const View& view) {
  const Eigen::Vector3d light = (0.85 * view.toward + 0.6 * view.up - 0.45 * view.right).normalized();
  const double lit = kAmbient + (1.0 - kAmbient) * std::max(0.0, normal.dot(light));
  const double level = std::round(lit * kShades) / kShades;
  std::string color = "#";
  for (const int channel : {paint.red, paint.green, paint.blue}) {
    const int value = std::clamp(static_cast<int>(std::lround(channel * level)), 0, 255);
    color += "0123456789abcdef"[value / 16];
    color += "0123456789abcdef"[value % 16];
  }
  return color;
}

/// Appends a closed outline in tenths of px, relative moves: the shortest form that keeps one decimal.
void append_outline(std::string& path, const Polygon& polygon) {
  long last_x = 0;
  long last_y = 0;
  bool first = true;
  std::string outline;
  std::size_t corners = 0;
  for (const auto& p : polygon) {
    const long x = std::lround(10.0 * p.x());
    const long y = std::lround(10.0 * p.y());
    if (!first && x == last_x && y == last_y) continue;
    outline += first ? "M" : "l";
    outline += std::to_string(first ? x : x - last_x);
    const std::string dy = std::to_string(first ? y : y - last_y);
    if (dy.front() != '-') outline += ' ';
    outline += dy;
    last_x = x;
    last_y = y;
    first = false;
    ++corners;
  }
  if (corners >= 3) path += outline + "z";
}

/// Paths of facets in order; neighbours of one colour share a path.
void emit(Svg& svg, const std::vector<std::size_t>& order, const std::vector<Polygon>& outlines,
          const std::vector<std::string>& colors, std::string_view attributes) {
  svg.open_group(concat({"class=\"solid\" transform=\"scale(.1)\"", attributes}));
  std::string path;
  std::string color;
  const auto flush = [&] {
    if (!path.empty()) svg.raw(concat({"<path color=\"", color, "\" d=\"", path, "\"/>"}));
    path.clear();
  };
  for (const std::size_t i : order) {
    if (colors[i] != color) flush();
    color = colors[i];
    append_outline(path, outlines[i]);
  }
  flush();
  svg.close_group();
}

}  // namespace

Eigen::Vector2d View::project(const Eigen::Vector3d& p) const {
  return {0.5 * width + scale * (right.dot(p) - center.x()), 0.5 * height - scale * (up.dot(p) - center.y())};
}

View fit_view(const Eigen::Vector3d& toward, const Eigen::Vector3d& up, const std::vector<Eigen::Vector3d>& points,
              double width, double height, double margin) {
  require(!points.empty(), "a view needs at least one point to look at");
  const Eigen::Vector3d right = up.cross(toward);
  require(right.norm() > 1e-6 * toward.norm() * up.norm(), "a view's direction must not be parallel to up");
  View view;
  view.toward = toward.normalized();
  view.right = right.normalized();
  view.up = view.toward.cross(view.right);
  view.width = width;
  view.height = height;
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d high = -low;
  for (const auto& p : points) {
    require(p.allFinite(), "a point to look at is not finite");
    const Eigen::Array2d flat(view.right.dot(p), view.up.dot(p));
    low = low.min(flat);
    high = high.max(flat);
  }
  const Eigen::Array2d extent = (high - low).max(1e-3);
  view.center = 0.5 * (low + high);
  view.scale = std::min((width - 2.0 * margin) / extent.x(), (height - 2.0 * margin) / extent.y());
  return view;
}

void draw_facets(Svg& svg, const View& view, std::vector<Facet> facets, const std::vector<Paint>& paints) {
  const std::vector<Facet> ordered = back_to_front(std::move(facets), view.toward);
  std::vector<Polygon> outlines;
  std::vector<std::string> colors;
  VisibilityRaster everything(view.width, view.height);
  VisibilityRaster foreground(view.width, view.height);
  for (const auto& facet : ordered) {
    Polygon outline;
    for (const auto& corner : facet.corners) outline.push_back(view.project(corner));
    const auto& paint = paints.at(static_cast<std::size_t>(facet.paint));
    everything.fill(outline, static_cast<int>(outlines.size()));
    if (paint.shows_through) foreground.fill(outline, static_cast<int>(outlines.size()));
    outlines.push_back(std::move(outline));
    colors.push_back(shade(paint, facet.normal, view));
  }
  const auto seen = everything.seen(ordered.size());
  const auto wanted = foreground.seen(ordered.size());
  std::vector<std::size_t> solid;
  std::vector<std::size_t> ghost;
  for (std::size_t i = 0; i < ordered.size(); ++i) {
    if (seen[i] > 0) solid.push_back(i);
    if (wanted[i] > 0 && seen[i] < kGhost * wanted[i]) ghost.push_back(i);
  }
  emit(svg, solid, outlines, colors, "");
  if (!ghost.empty()) emit(svg, ghost, outlines, colors, " opacity=\".4\"");
}

}  // namespace opponens::report
