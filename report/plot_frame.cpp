// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/plot_frame.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "report/text.hpp"

namespace opponens::report {
namespace {

constexpr double kFont = 11.0;          // px
constexpr double kLegendRow = 18.0;     // px
constexpr double kLegendSample = 22.0;  // px, of the drawn line before its label

struct Ticks {
  std::vector<double> at;
  double step = 1.0;
};

Ticks ticks_of(const Axis& axis, Range range, int target) {
  Ticks ticks{nice_ticks(range.low, range.high, target)};
  if (ticks.at.size() > 1) ticks.step = ticks.at[1] - ticks.at[0];
  if (axis.integer && ticks.step < 1.0) {
    ticks = {};
    const auto last = static_cast<long long>(std::floor(range.high + 1e-9));
    for (auto i = static_cast<long long>(std::ceil(range.low - 1e-9)); i <= last; ++i) {
      ticks.at.push_back(static_cast<double>(i));
    }
  }
  return ticks;
}

/// Calls place(entry, x, row) for each legend entry, wrapped to the width; returns the number of rows.
int lay_out(const std::vector<LegendEntry>& entries, double width,
            const std::function<void(const LegendEntry&, double, int)>& place) {
  double x = 0.0;
  int row = 0;
  for (const auto& entry : entries) {
    const double need = kLegendSample + 6.0 + text_width(entry.label, kFont) + 16.0;
    if (x > 0.0 && x + need > width + 16.0) {
      x = 0.0;
      ++row;
    }
    place(entry, x, row);
    x += need;
  }
  return entries.empty() ? 0 : row + 1;
}

}  // namespace

Range axis_range(const Axis& axis, Range data, double margin) {
  const double span = data.high - data.low;
  Range range{axis.low.value_or(data.low - margin * span), axis.high.value_or(data.high + margin * span)};
  const double least = 1e-9 * std::max({1e-3, std::abs(range.low), std::abs(range.high)});
  if (range.high - range.low < least) {
    const double widen = range.low == 0.0 ? 1.0 : 0.05 * std::abs(range.low);
    range = {range.low - widen, std::max(range.low, range.high) + widen};
  }
  return range;
}

PlotFrame make_frame(const Axis& x, const Axis& y, Range x_range, Range y_range, double width, double height) {
  double widest = 0.0;
  const Ticks ticks = ticks_of(y, y_range, 6);
  for (const double value : ticks.at) widest = std::max(widest, text_width(tick_label(value, ticks.step), kFont));
  const double left = widest + 14.0 + (y.label.empty() ? 0.0 : 18.0);
  const double bottom = x.label.empty() ? 24.0 : 42.0;
  return {left,        10.0,         width - left - 16.0, height - 10.0 - bottom,
          x_range.low, x_range.high, y_range.low,         y_range.high};
}

void draw_frame(Svg& svg, const PlotFrame& frame, const Axis& x, const Axis& y) {
  const double bottom = frame.top + frame.height;
  const double right = frame.left + frame.width;
  const Ticks x_ticks = ticks_of(x, {frame.x_low, frame.x_high}, frame.width < 320.0 ? 5 : 8);
  const Ticks y_ticks = ticks_of(y, {frame.y_low, frame.y_high}, frame.height < 140.0 ? 4 : 6);
  for (const double value : x_ticks.at) {
    const double at = frame.x(value);
    svg.line(at, frame.top, at, bottom, "class=\"grid\"");
    svg.text(at, bottom + 15.0, tick_label(value, x_ticks.step), "class=\"tick\" text-anchor=\"middle\"");
  }
  for (const double value : y_ticks.at) {
    const double at = frame.y(value);
    svg.line(frame.left, at, right, at, "class=\"grid\"");
    svg.text(frame.left - 6.0, at + 3.8, tick_label(value, y_ticks.step), "class=\"tick\" text-anchor=\"end\"");
  }
  svg.rect(frame.left, frame.top, frame.width, frame.height, "class=\"frame\"");
  if (!x.label.empty()) {
    svg.text(frame.left + 0.5 * frame.width, bottom + 33.0, x.label, "class=\"axis\" text-anchor=\"middle\"");
  }
  if (!y.label.empty()) {
    const std::string middle = compact(frame.top + 0.5 * frame.height);
    svg.text(13.0, frame.top + 0.5 * frame.height, y.label,
             concat({"class=\"axis\" text-anchor=\"middle\" transform=\"rotate(-90 13 ", middle, ")\""}));
  }
}

double legend_height(const std::vector<LegendEntry>& entries, double width) {
  return kLegendRow * lay_out(entries, width, [](const LegendEntry&, double, int) {});
}

void draw_legend(Svg& svg, const std::vector<LegendEntry>& entries, double left, double top, double width) {
  lay_out(entries, width, [&](const LegendEntry& entry, double x, int row) {
    const double middle = top + kLegendRow * (row + 0.5);
    if (entry.box) {
      svg.rect(left + x + 6.0, middle - 5.0, 10.0, 10.0, concat({"fill=\"", entry.color, "\""}));
    } else {
      svg.line(left + x, middle, left + x + kLegendSample, middle,
               concat({"stroke=\"", entry.color, "\" stroke-width=\"2.2\"",
                       entry.dashed ? " stroke-dasharray=\"5 3\"" : ""}));
    }
    svg.text(left + x + kLegendSample + 6.0, middle + 4.0, entry.label, "class=\"tick\"");
  });
}

}  // namespace opponens::report
