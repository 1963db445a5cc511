// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "report/line_plot.hpp"
#include "report/plot_frame.hpp"
#include "report/svg.hpp"
#include "tests/report/markup_check.hpp"

namespace opponens::report {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Ticks, AreRoundInsideAndNeitherFewNorMany) {
  Rng rng = stream(3, "ticks");
  for (int i = 0; i < 5000; ++i) {
    const double low = rng.normal() * std::pow(10.0, rng.uniform(-6.0, 6.0));
    const double span = std::abs(low) * std::pow(10.0, rng.uniform(-3.0, 3.0)) + 1e-9;
    const auto ticks = nice_ticks(low, low + span, 6);
    SCOPED_TRACE(testing::Message() << low << " to " << low + span);
    ASSERT_GE(ticks.size(), 2U);
    EXPECT_LE(ticks.size(), 11U);
    const double step = ticks[1] - ticks[0];
    const double share = step / std::pow(10.0, std::floor(std::log10(step) + 1e-7));
    EXPECT_TRUE(std::abs(share - 1) < 1e-4 || std::abs(share - 2) < 1e-4 || std::abs(share - 5) < 1e-4) << share;
    std::set<std::string> labels;
    for (const double tick : ticks) {
      EXPECT_GE(tick, low - 1e-8 * step);
      EXPECT_LE(tick, low + span + 1e-8 * step);
      EXPECT_NEAR(tick / step, std::round(tick / step), 1e-4);
      if (std::abs(tick) < 1e6 && step > 1e-4) labels.insert(tick_label(tick, step));
    }
    if (!labels.empty() && std::abs(low) + span < 1e6) {
      EXPECT_EQ(labels.size(), ticks.size()) << "labels must tell ticks apart";
    }
  }
}

TEST(Ticks, KnownCases) {
  EXPECT_EQ(nice_ticks(0.0, 1.0, 5), (std::vector<double>{0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0}));
  EXPECT_EQ(nice_ticks(-3.0, 7.0, 5), (std::vector<double>{-2.0, 0.0, 2.0, 4.0, 6.0}));
  EXPECT_EQ(tick_label(0.6000000000000001, 0.2), "0.6");
  EXPECT_EQ(tick_label(20.0, 20.0), "20");
  EXPECT_THROW(nice_ticks(1.0, 1.0, 5), std::invalid_argument);
  EXPECT_THROW(nice_ticks(0.0, kNan, 5), std::invalid_argument);
}

TEST(AxisRange, IsNeverEmpty) {
  for (const double value : {0.0, 5.0, -1e-12, 1e12}) {
    const Range range = axis_range({}, {value, value}, 0.05);
    EXPECT_LT(range.low, range.high) << value;
  }
  const Range fixed_range = axis_range({"", 1.0, 2.0}, {0.0, 9.0}, 0.05);
  EXPECT_EQ(fixed_range.low, 1.0);
  EXPECT_EQ(fixed_range.high, 2.0);
}

LinePlot two_curves() {
  LinePlot plot;
  plot.title = "a <plot> & \"more\"";
  plot.x.label = "time (s)";
  plot.y.label = "<y>";
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(50, 0.0, 2.0);
  Series first{"first", x, x.array().sin().matrix(), series_color(0), {}};
  first.band = Band{first.y.array() - 0.1, first.y.array() + 0.1};
  Series second{"second & <b>", x, x, series_color(1), {}};
  second.markers = true;
  second.dashed = true;
  plot.series = {first, second};
  plot.marks = {{"here", 1.0, "red"}, {"level", 0.5, "red", true, true}};
  return plot;
}

TEST(LinePlot, IsWellFormedAndDeterministic) {
  const std::string svg = render(two_curves());
  EXPECT_EQ(markup_problems(svg), std::vector<std::string>{});
  EXPECT_EQ(svg, render(two_curves()));
  EXPECT_NE(svg.find("second &amp; &lt;b&gt;"), std::string::npos);
  EXPECT_EQ(svg.find("<b>"), std::string::npos);
}

TEST(LinePlot, GapsSplitTheCurveAndNothingIsNan) {
  LinePlot plot = two_curves();
  plot.series.resize(1);
  plot.series[0].band.reset();
  plot.series[0].y[20] = kNan;
  plot.series[0].y[30] = std::numeric_limits<double>::infinity();
  const std::string svg = render(plot);
  std::size_t curves = 0;
  for (std::size_t at = svg.find("<polyline"); at != std::string::npos; at = svg.find("<polyline", at + 1)) ++curves;
  EXPECT_EQ(curves, 3U);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(LinePlot, WithoutDataSaysSo) {
  LinePlot plot;
  EXPECT_NE(render(plot).find("no data"), std::string::npos);
  plot.series.push_back({"", Eigen::VectorXd::Ones(3), Eigen::VectorXd::Constant(3, kNan), "red", {}});
  EXPECT_NE(render(plot).find("no data"), std::string::npos);
}

TEST(LinePlot, RefusesSizesThatDiffer) {
  LinePlot plot = two_curves();
  plot.series[0].y.conservativeResize(49);
  EXPECT_THROW(render(plot), std::invalid_argument);
  plot = two_curves();
  plot.series[0].band->high.conservativeResize(3);
  EXPECT_THROW(render(plot), std::invalid_argument);
}

TEST(Histogram, CountsEveryValueOnce) {
  Histogram histogram;
  histogram.bins = 4;
  histogram.samples = {{"a", {0.0, 0.1, 0.3, 1.0, 1.5, kNan}, "red"}};
  const std::string svg = render(histogram);
  EXPECT_EQ(markup_problems(svg), std::vector<std::string>{});
  EXPECT_NE(svg.find("a (2 outside)"), std::string::npos);
  const auto fills = attribute_values(svg, "fill");
  EXPECT_EQ(std::count(fills.begin(), fills.end(), "red"), 4);  // three bars and the legend
  histogram.bins = 0;
  EXPECT_THROW(render(histogram), std::invalid_argument);
}

TEST(Svg, RefusesCoordinatesThatAreNotFinite) {
  Svg svg(10, 10, "x");
  EXPECT_THROW(svg.line(0, 0, kNan, 0, ""), std::invalid_argument);
  EXPECT_THROW(svg.polyline({{0.0, std::numeric_limits<double>::infinity()}}, ""), std::invalid_argument);
}

TEST(MarkupCheck, FindsWhatIsBroken) {
  EXPECT_TRUE(markup_problems("<p>a &amp; b<br></p>").empty());
  for (const char* broken : {"<p>", "<p></b>", "</p>", "<p a=1></p>", "<p a=\"1\" a=\"2\"></p>", "a & b", "a > b",
                             "<p id=\"x\"></p><p id=\"x\"></p>", "<p", "<p title=\"&copy;\"></p>"}) {
    EXPECT_FALSE(markup_problems(broken).empty()) << broken;
  }
}

}  // namespace
}  // namespace opponens::report
