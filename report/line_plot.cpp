// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/line_plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/require.hpp"
#include "report/plot_frame.hpp"
#include "report/svg.hpp"
#include "report/text.hpp"

namespace opponens::report {
namespace {

constexpr Eigen::Index kMaxPoints = 500;  // of a drawn curve: one per pixel is enough

void widen(Range& range, double value) {
  if (!std::isfinite(value)) return;
  range.low = std::min(range.low, value);
  range.high = std::max(range.high, value);
}

Range empty_range() { return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}; }

void check(const LinePlot& plot) {
  for (const auto& series : plot.series) {
    const bool band_fits =
        !series.band || (series.band->low.size() == series.x.size() && series.band->high.size() == series.x.size());
    require(series.x.size() == series.y.size() && band_fits, [&] {
      return concat({"plot series '", series.label, "': x, y and band differ in size"});
    });
    require(series.x.allFinite(), [&] { return concat({"plot series '", series.label, "': x is not finite"}); });
  }
}

struct DataRange {
  Range x = empty_range();
  Range y = empty_range();
};

DataRange data_range(const LinePlot& plot) {
  DataRange range;
  for (const auto& series : plot.series) {
    for (Eigen::Index i = 0; i < series.x.size(); ++i) {
      if (std::isfinite(series.y(i))) widen(range.x, series.x(i));
      widen(range.y, series.y(i));
      if (!series.band) continue;
      widen(range.y, series.band->low(i));
      widen(range.y, series.band->high(i));
    }
  }
  for (const auto& mark : plot.marks) widen(mark.horizontal ? range.y : range.x, mark.value);
  return range;
}

/// Indices to draw: all, or evenly thinned, the last included.
std::vector<Eigen::Index> thinned(Eigen::Index count) {
  std::vector<Eigen::Index> indices;
  const Eigen::Index step = std::max<Eigen::Index>(1, (count + kMaxPoints - 1) / kMaxPoints);
  for (Eigen::Index i = 0; i < count; i += step) indices.push_back(i);
  if (!indices.empty() && indices.back() != count - 1) indices.push_back(count - 1);
  return indices;
}

using Points = std::vector<Eigen::Vector2d>;

/// The curve cut at values that are not finite, in pixels relative to the frame's corner.
std::vector<Points> pieces(const PlotFrame& frame, const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  std::vector<Points> found(1);
  for (const auto i : thinned(x.size())) {
    if (std::isfinite(y(i))) {
      found.back().emplace_back(frame.x(x(i)) - frame.left, frame.y(y(i)) - frame.top);
    } else if (!found.back().empty()) {
      found.emplace_back();
    }
  }
  if (found.back().empty()) found.pop_back();
  return found;
}

void draw_band(Svg& svg, const PlotFrame& frame, const Series& series) {
  const auto lower = pieces(frame, series.x, series.band->low);
  const auto upper = pieces(frame, series.x, series.band->high);
  if (lower.size() != 1 || upper.size() != 1) return;  // a band with gaps is not drawn
  Points outline = lower.front();
  outline.insert(outline.end(), upper.front().rbegin(), upper.front().rend());
  svg.polygon(outline, concat({"fill=\"", series.color, "\" fill-opacity=\"0.16\" stroke=\"none\""}));
}

void draw_series(Svg& svg, const PlotFrame& frame, const Series& series) {
  const auto curves = pieces(frame, series.x, series.y);
  for (const auto& curve : curves) {
    if (series.line) {
      svg.polyline(curve, concat({"fill=\"none\" stroke=\"", series.color, "\" stroke-width=\"1.7\"",
                                  series.dashed ? " stroke-dasharray=\"5 3\"" : ""}));
    }
    if (!series.markers) continue;
    for (const auto& point : curve) {
      svg.circle(point.x(), point.y(), series.dashed ? 2.0 : 2.6, concat({"fill=\"", series.color, "\""}));
    }
  }
}

void draw_mark(Svg& svg, const PlotFrame& frame, const Mark& mark) {
  const double x = frame.x(mark.value) - frame.left;
  const double y = frame.y(mark.value) - frame.top;
  const std::string style =
      concat({"stroke=\"", mark.color, "\" stroke-width=\"1.6\"", mark.dashed ? " stroke-dasharray=\"5 3\"" : ""});
  if (mark.horizontal) {
    svg.line(0.0, y, frame.width, y, style);
  } else {
    svg.line(x, 0.0, x, frame.height, style);
  }
}

std::vector<LegendEntry> legend_of(const LinePlot& plot) {
  std::vector<LegendEntry> entries;
  for (const auto& series : plot.series) {
    if (!series.label.empty()) entries.push_back({series.label, series.color, series.dashed});
  }
  for (const auto& mark : plot.marks) {
    if (!mark.label.empty()) entries.push_back({mark.label, mark.color, mark.dashed});
  }
  return entries;
}

}  // namespace

std::string render(const LinePlot& plot) {
  check(plot);
  DataRange data = data_range(plot);
  const bool empty = data.x.low > data.x.high || data.y.low > data.y.high;
  if (empty) data = {{0.0, 1.0}, {0.0, 1.0}};
  const Range x = axis_range(plot.x, data.x, 0.0);
  const Range y = axis_range(plot.y, data.y, 0.05);
  const PlotFrame frame = make_frame(plot.x, plot.y, x, y, plot.width, plot.height);
  const auto legend = legend_of(plot);
  Svg svg(plot.width, plot.height + legend_height(legend, frame.width), plot.title);
  draw_frame(svg, frame, plot.x, plot.y);
  if (empty) {
    svg.text(frame.left + 0.5 * frame.width, frame.top + 0.5 * frame.height, "no data",
             "class=\"axis\" text-anchor=\"middle\"");
    return svg.str();
  }
  svg.open_clip(frame.left, frame.top, frame.width, frame.height);
  for (const auto& series : plot.series) {
    if (series.band) draw_band(svg, frame, series);
  }
  for (const auto& mark : plot.marks) draw_mark(svg, frame, mark);
  for (const auto& series : plot.series) draw_series(svg, frame, series);
  svg.close_clip();
  draw_legend(svg, legend, frame.left, plot.height, frame.width);
  return svg.str();
}

std::string render(const Histogram& histogram) {
  require(histogram.bins >= 1 && histogram.low < histogram.high, "a histogram needs bins >= 1 and low < high");
  const double bin_width = (histogram.high - histogram.low) / histogram.bins;
  std::vector<std::vector<int>> counts;
  std::vector<LegendEntry> legend;
  int tallest = 1;
  for (const auto& sample : histogram.samples) {
    std::vector<int> bins(static_cast<std::size_t>(histogram.bins), 0);
    int outside = 0;
    for (const double value : sample.values) {
      const bool inside = value >= histogram.low && value <= histogram.high;  // false for NaN
      if (!inside) {
        ++outside;
        continue;
      }
      const int bin = std::min(histogram.bins - 1, static_cast<int>((value - histogram.low) / bin_width));
      tallest = std::max(tallest, ++bins[static_cast<std::size_t>(bin)]);
    }
    counts.push_back(std::move(bins));
    std::string label = sample.label;
    if (outside > 0) label += concat({" (", std::to_string(outside), " outside)"});
    legend.push_back({std::move(label), sample.color, false, true});
  }
  const Range y = axis_range({"", 0.0, {}}, {0.0, static_cast<double>(tallest)}, 0.08);
  const PlotFrame frame =
      make_frame(histogram.x, histogram.y, {histogram.low, histogram.high}, y, histogram.width, histogram.height);
  Svg svg(histogram.width, histogram.height + legend_height(legend, frame.width), histogram.title);
  draw_frame(svg, frame, histogram.x, histogram.y);
  const double bar = 0.9 * frame.width / histogram.bins / std::max<double>(1.0, static_cast<double>(counts.size()));
  for (std::size_t s = 0; s < counts.size(); ++s) {
    for (int bin = 0; bin < histogram.bins; ++bin) {
      const int count = counts[s][static_cast<std::size_t>(bin)];
      if (count == 0) continue;
      const double left = frame.x(histogram.low + bin_width * (bin + 0.05)) + bar * static_cast<double>(s);
      svg.rect(left, frame.y(count), bar, frame.y(0.0) - frame.y(count),
               concat({"fill=\"", histogram.samples[s].color, "\""}));
    }
  }
  draw_legend(svg, legend, frame.left, histogram.height, frame.width);
  return svg.str();
}

}  // namespace opponens::report
