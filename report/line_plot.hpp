// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace opponens::report {

/// An axis: its label with the unit, and the range when it shall not follow the data.
struct Axis {
  std::string label;
  std::optional<double> low;
  std::optional<double> high;
  bool integer = false;  ///< ticks at whole numbers only
};

struct Band {
  Eigen::VectorXd low;   ///< [N], of the series' x
  Eigen::VectorXd high;  ///< [N]
};

/// One curve. Points whose y is not finite are gaps.
struct Series {
  std::string label;  ///< legend text; empty: not in the legend
  Eigen::VectorXd x;  ///< [N]
  Eigen::VectorXd y;  ///< [N]
  std::string color;  ///< CSS colour, usually series_color(i)
  std::optional<Band> band;
  bool line = true;
  bool dashed = false;
  bool markers = false;
};

/// A marked value: a line across the plot, named in the legend.
struct Mark {
  std::string label;
  double value = 0.0;
  std::string color;
  bool horizontal = false;
  bool dashed = false;
};

struct LinePlot {
  std::string title;  ///< what is seen, for hovering and screen readers
  Axis x;
  Axis y;
  std::vector<Series> series;
  std::vector<Mark> marks;
  double width = 520.0;   ///< px
  double height = 300.0;  ///< px of the plot; the legend below adds to it
};

/// An SVG of the curves. Throws std::invalid_argument when a series' sizes differ. Without one finite point: an empty
/// frame that says "no data".
std::string render(const LinePlot& plot);

/// Values counted in bins of equal width, one set of bars per named sample side by side.
struct Histogram {
  struct Sample {
    std::string label;
    std::vector<double> values;  ///< outside [low, high] or not finite: counted in the legend as "outside"
    std::string color;
  };
  std::string title;
  Axis x;
  Axis y;
  std::vector<Sample> samples;
  double low = 0.0;
  double high = 1.0;
  int bins = 20;
  double width = 520.0;
  double height = 260.0;
};

std::string render(const Histogram& histogram);

}  // namespace opponens::report
