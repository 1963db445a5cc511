// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "report/line_plot.hpp"
#include "report/svg.hpp"

namespace opponens::report {

/// Maps data to pixels inside the frame of a plot. Shared by line plots and histograms.
struct PlotFrame {
  double left, top, width, height;  ///< px, the data area
  double x_low, x_high, y_low, y_high;

  double x(double value) const { return left + width * (value - x_low) / (x_high - x_low); }
  double y(double value) const { return top + height * (y_high - value) / (y_high - y_low); }
};

struct Range {
  double low, high;
};

/// The range to show: fixed ends where the axis gives them, else the data's with a margin (a fraction of the span). A
/// range of no extent is widened, so that low < high always.
Range axis_range(const Axis& axis, Range data, double margin);

struct LegendEntry {
  std::string label;
  std::string color;
  bool dashed = false;
  bool box = false;  ///< a filled square instead of a line
};

/// The frame of a plot of the given outer size; room on the left for the tick labels.
PlotFrame make_frame(const Axis& x, const Axis& y, Range x_range, Range y_range, double width, double height);

/// Ticks, grid lines, labels and the axes' names.
void draw_frame(Svg& svg, const PlotFrame& frame, const Axis& x, const Axis& y);

/// Rows of px height 18 that the entries need, and the entries themselves from y downward.
double legend_height(const std::vector<LegendEntry>& entries, double width);
void draw_legend(Svg& svg, const std::vector<LegendEntry>& entries, double left, double top, double width);

}  // namespace opponens::report
