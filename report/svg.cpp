// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/svg.hpp"

#include <algorithm>
#include <cmath>

#include "core/require.hpp"
#include "report/text.hpp"

namespace opponens::report {

Svg::Svg(double width, double height, std::string_view title) {
  const std::string name = escape(title);
  body_ = concat({"<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-label=\"", name, "\" viewBox=\"0 0 ",
                  compact(width), " ", compact(height), "\" width=\"", compact(width), "\" height=\"", compact(height),
                  "\"><title>", name, "</title>"});
}

void Svg::number(std::string_view name, double value) {
  require(std::isfinite(value), [&] { return concat({"a drawing's coordinate is not finite: ", name}); });
  body_ += concat({" ", name, "=\"", compact(value), "\""});
}

void Svg::open_group(std::string_view attributes) { body_ += concat({"<g ", attributes, ">"}); }

void Svg::close_group() { body_ += "</g>"; }

void Svg::open_clip(double x, double y, double width, double height) {
  body_ += "<svg";
  number("x", x);
  number("y", y);
  number("width", width);
  number("height", height);
  body_ += " overflow=\"hidden\">";
}

void Svg::close_clip() { body_ += "</svg>"; }

void Svg::line(double x1, double y1, double x2, double y2, std::string_view attributes) {
  body_ += "<line";
  number("x1", x1);
  number("y1", y1);
  number("x2", x2);
  number("y2", y2);
  body_ += concat({" ", attributes, "/>"});
}

void Svg::rect(double x, double y, double width, double height, std::string_view attributes) {
  body_ += "<rect";
  number("x", x);
  number("y", y);
  number("width", width);
  number("height", height);
  body_ += concat({" ", attributes, "/>"});
}

void Svg::circle(double x, double y, double radius, std::string_view attributes) {
  body_ += "<circle";
  number("cx", x);
  number("cy", y);
  number("r", radius);
  body_ += concat({" ", attributes, "/>"});
}

void Svg::points(std::string_view element, const std::vector<Eigen::Vector2d>& points, std::string_view attributes) {
  body_ += concat({"<", element, " points=\""});
  for (std::size_t i = 0; i < points.size(); ++i) {
    require(points[i].allFinite(), "a drawing's point is not finite");
    body_ += concat({i == 0 ? "" : " ", compact(points[i].x()), ",", compact(points[i].y())});
  }
  body_ += concat({"\" ", attributes, "/>"});
}

void Svg::polyline(const std::vector<Eigen::Vector2d>& corners, std::string_view attributes) {
  points("polyline", corners, attributes);
}

void Svg::polygon(const std::vector<Eigen::Vector2d>& corners, std::string_view attributes) {
  points("polygon", corners, attributes);
}

void Svg::text(double x, double y, std::string_view content, std::string_view attributes) {
  body_ += "<text";
  number("x", x);
  number("y", y);
  body_ += concat({" ", attributes, ">", escape(content), "</text>"});
}

std::string Svg::str() const { return concat({body_, "</svg>"}); }

std::vector<double> nice_ticks(double low, double high, int target) {
  require(std::isfinite(low) && std::isfinite(high) && low < high && target >= 1,
          "nice_ticks needs low < high, finite");
  const double raw = (high - low) / target;
  const double magnitude = std::pow(10.0, std::floor(std::log10(raw)));
  const double share = raw / magnitude;  // in [1, 10)
  const double factor = share < 1.5 ? 1.0 : share < 3.5 ? 2.0 : share < 7.5 ? 5.0 : 10.0;
  const double step = factor * magnitude;
  std::vector<double> ticks;
  const double slack = 1e-9;  // of a step: keeps the ends when they are round themselves
  const double first = std::ceil(low / step - slack);
  const auto count = static_cast<int>(std::floor(high / step + slack) - first) + 1;
  for (int i = 0; i < count; ++i) {
    const double multiple = first + i;
    ticks.push_back(multiple == 0.0 ? 0.0 : multiple * step);
  }
  return ticks;
}

std::string tick_label(double value, double step) {
  const double exponent = std::floor(std::log10(step) + 1e-9);
  if (exponent < -4 || std::abs(value) >= 1e7) return significant(value, 3);
  return fixed(value, exponent < 0 ? static_cast<int>(-exponent) : 0);
}

double text_width(std::string_view text, double font_size) {
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; };
  const auto letters = std::count_if(text.begin(), text.end(), [&](char c) { return !continues(c); });
  return 0.57 * font_size * static_cast<double>(letters);
}

std::string series_color(int index) { return concat({"var(--s", std::to_string(index % 8), ")"}); }

}  // namespace opponens::report
