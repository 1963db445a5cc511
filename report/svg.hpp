// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace opponens::report {

/// Builds one inline SVG. Coordinates are pixels, x right, y down, written with one decimal; they must be finite
/// (std::invalid_argument otherwise). Attributes are markup of our own; texts and titles are escaped here.
class Svg {
 public:
  /// title is read out by screen readers and shown on hovering. The picture shrinks with the page.
  Svg(double width, double height, std::string_view title);

  void open_group(std::string_view attributes);
  void close_group();
  /// Opens a nested viewport that clips to the rectangle; coordinates inside count from its corner.
  void open_clip(double x, double y, double width, double height);
  void close_clip();
  void line(double x1, double y1, double x2, double y2, std::string_view attributes);
  void rect(double x, double y, double width, double height, std::string_view attributes);
  void circle(double x, double y, double radius, std::string_view attributes);
  void polyline(const std::vector<Eigen::Vector2d>& points, std::string_view attributes);
  void polygon(const std::vector<Eigen::Vector2d>& points, std::string_view attributes);
  void text(double x, double y, std::string_view content, std::string_view attributes);
  void raw(std::string_view markup) { body_ += markup; }

  /// The finished element.
  std::string str() const;

 private:
  void points(std::string_view element, const std::vector<Eigen::Vector2d>& points, std::string_view attributes);
  void number(std::string_view name, double value);

  std::string body_;
};

/// Round tick positions that cover [low, high] from inside: steps of 1, 2 or 5 times a power of ten, about `target` of
/// them. low < high, both finite.
std::vector<double> nice_ticks(double low, double high, int target);

/// Text of a tick whose neighbours are `step` away: just enough decimals.
std::string tick_label(double value, double step);

/// Estimated width of text in px at a font size; deterministic, errs on the wide side.
double text_width(std::string_view text, double font_size);

/// Colour-blind safe series colours (Okabe and Ito 2008, jfly.uni-koeln.de/color), as CSS custom properties of the
/// page's style sheet so that the dark theme can lighten them. Repeats after eight.
std::string series_color(int index);

}  // namespace opponens::report
