// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

#include "core/require.hpp"
#include "report/line_plot.hpp"
#include "report/paper_tables.hpp"
#include "report/sections.hpp"
#include "report/svg.hpp"

namespace opponens::report {
namespace {

constexpr const char* kNoInterval = "no interval: too few clusters";

/// Percent of the variance in the first i + 1 synergies.
Eigen::VectorXd cumulative_percent(const Eigen::VectorXd& variance) {
  Eigen::VectorXd sum(variance.size());
  double so_far = 0.0;
  for (Eigen::Index i = 0; i < variance.size(); ++i) sum[i] = so_far += variance[i];
  const double total = variance.sum();
  return total > 0.0 ? Eigen::VectorXd(100.0 * sum / total)
                     : Eigen::VectorXd(100.0 * Eigen::VectorXd::Ones(variance.size()));
}

int kept(const SynergyItem& item) { return static_cast<int>(item.group.box.half_width.size()); }

bool is_pre_grasp(const SynergyItem& item) { return item.group.phase == "pre-grasp"; }

/// The row of Table 1 that a group is compared with; with groups by object only the pre-grasp's, as context.
const PaperVariance* reference_of(const SynergyPart& part, const SynergyItem& item) {
  if (is_pre_grasp(item)) return paper_variance("pre-grasp");
  return part.grouped_by == "family" && item.group.phase == "grasp" ? paper_variance(item.group.name) : nullptr;
}

/// Percent at which the plots of all groups start, so that they can be compared by eye.
double lowest_percent(const SynergyPart& part) {
  double lowest = 100.0;
  for (const auto& item : part.groups) {
    if (item.group.basis.variance.size() > 0)
      lowest = std::min(lowest, cumulative_percent(item.group.basis.variance)[0]);
    if (item.cumulative_low.size() > 0) lowest = std::min(lowest, 100.0 * item.cumulative_low[0]);
    if (const auto* paper = reference_of(part, item)) lowest = std::min(lowest, paper->percent[0]);
  }
  return 10.0 * std::floor(std::max(0.0, lowest) / 10.0);
}

Markup variance_plot(const SynergyPart& part, const SynergyItem& item, int color) {
  const auto& group = item.group;
  const Eigen::VectorXd percent_sum = cumulative_percent(group.basis.variance);
  const Eigen::VectorXd count =
      Eigen::VectorXd::LinSpaced(percent_sum.size(), 1.0, static_cast<double>(percent_sum.size()));
  LinePlot plot;
  plot.title = concat({"Cumulative variance of ", group.name});
  plot.x = {"number of synergies", 0.5, static_cast<double>(percent_sum.size()) + 0.5, true};
  plot.y = {"cumulative variance (%)", lowest_percent(part), 101.0};
  plot.width = 510.0;
  plot.height = 270.0;
  Series ours{"this analysis", count, percent_sum, series_color(color), {}};
  ours.markers = true;
  if (item.cumulative_low.size() > 0) {
    ours.band = Band{100.0 * item.cumulative_low, 100.0 * item.cumulative_high};
    ours.label += concat({" (band: ", percent(part.interval_level, 0), " interval)"});
  } else {
    ours.label += concat({" (", kNoInterval, ")"});
  }
  plot.series.push_back(ours);
  const bool compared = part.grouped_by == "family";
  if (const auto* paper = reference_of(part, item)) {
    Series theirs{concat({"Table 1, ", paper->name, compared ? "" : " (context)"}),
                  Eigen::VectorXd::LinSpaced(9, 1.0, 9.0),
                  Eigen::Map<const Eigen::VectorXd>(paper->percent.data(), 9),
                  "var(--paper)",
                  {}};
    theirs.dashed = true;
    theirs.markers = true;
    plot.series.push_back(theirs);
  }
  plot.marks.push_back(
      {concat({"k = ", std::to_string(kept(item))}), static_cast<double>(kept(item)), series_color(color)});
  plot.marks.push_back({percent(1.0 - group.box.beta, 0), 100.0 * (1.0 - group.box.beta), "var(--soft)", true, true});
  std::string caption = is_pre_grasp(item) ? std::string("Pre-grasp phase, all groups together.")
                                           : concat({"Grasp phase, ", part.grouped_by, " ", group.name, "."});
  if (group.phase == "all") caption = concat({"Whole movement, ", group.name, "."});
  return figure(render(plot), caption);
}

std::string coverage_words(const Coverage& coverage) {
  std::string words =
      concat({percent(coverage.in_sample), " / ", coverage.held_out ? percent(*coverage.held_out) : "n/a"});
  words += coverage.interval ? concat({" [", fixed(100.0 * coverage.interval->low, 1), ", ",
                                       fixed(100.0 * coverage.interval->high, 1), "]"})
                             : concat({" [", kNoInterval, "]"});
  return words + concat({" of ", percent(coverage.nominal)});
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const auto& word : words) out += concat({out.empty() ? "" : ", ", word});
  return out.empty() ? std::string("none") : out;
}

Markup number_table(const SynergyPart& part) {
  Table table(
      "Synergies and boxes. Half widths in rad of the scaled space (scale 1: rad).",
      {"group", "samples", "k", "k in Table 1", "dof effective", "half widths of the k-box", "dropped channels"});
  for (const auto& item : part.groups) {
    std::string widths;
    for (const double h : item.group.box.half_width) widths += concat({widths.empty() ? "" : "  ", fixed(h, 3)});
    const auto* paper = reference_of(part, item);
    table.row({text(item.group.name), text(grouped(item.samples)), text(std::to_string(kept(item))),
               text(paper ? std::to_string(paper->k) : std::string()), text(std::to_string(item.group.dof_effective)),
               text(widths), text(joined(item.group.dropped_channels))});
  }
  return table.str();
}

Markup coverage_table(const SynergyPart& part) {
  Table table(concat({"Share of the samples inside the box: in-sample / held out [", percent(part.interval_level, 0),
                      " interval] of nominal. Held out: one cluster of the group left out at a time."}),
              {"group", "cluster", "full box (all effective axes)", "first k coordinates"});
  for (const auto& item : part.groups) {
    if (!item.full_box && !item.reduced_box) continue;
    table.row({text(item.group.name), text(item.cluster),
               text(item.full_box ? coverage_words(*item.full_box) : std::string()),
               text(item.reduced_box ? coverage_words(*item.reduced_box) : std::string())});
  }
  return table.empty() ? Markup{} : table.str();
}

Series dots(const std::string& label, const std::vector<std::pair<double, double>>& points, int color) {
  Series series{label, Eigen::VectorXd(static_cast<Eigen::Index>(points.size())), {}, series_color(color), {}};
  series.y.resize(series.x.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::tie(series.x[static_cast<Eigen::Index>(i)], series.y[static_cast<Eigen::Index>(i)]) = points[i];
  }
  series.line = false;
  series.markers = true;
  return series;
}

/// Coverage of one kind of box per group: dots in-sample and held out, the interval as a bar, the nominal as a line
/// across the group's place.
Markup coverage_plot(const SynergyPart& part, std::optional<Coverage> SynergyItem::*box, const std::string& what) {
  LinePlot plot;
  plot.title = concat({"Coverage of ", what});
  plot.x = {"group", 0.5, static_cast<double>(part.groups.size()) + 0.5, true};
  plot.y = {"samples inside (%)", std::nullopt, 100.0};
  plot.width = 510.0;
  plot.height = 250.0;
  std::vector<std::pair<double, double>> inside;
  std::vector<std::pair<double, double>> outside;
  std::string names;
  for (std::size_t i = 0; i < part.groups.size(); ++i) {
    const auto& coverage = part.groups[i].*box;
    const auto& group = part.groups[i].group;
    names += concat({i == 0 ? "" : ", ", std::to_string(i + 1), ": ",
                     group.phase == "grasp" ? concat({part.grouped_by, " "}) : std::string(), group.name});
    if (!coverage) continue;
    const double x = static_cast<double>(i) + 1.0;
    Series nominal{inside.empty() ? "nominal" : "",
                   Eigen::Vector2d(x - 0.3, x + 0.3),
                   Eigen::Vector2d::Constant(100.0 * coverage->nominal),
                   "var(--soft)",
                   {}};
    nominal.dashed = true;
    plot.series.push_back(nominal);
    inside.emplace_back(x - 0.1, 100.0 * coverage->in_sample);
    if (coverage->held_out) outside.emplace_back(x + 0.1, 100.0 * *coverage->held_out);
    if (!coverage->interval) continue;
    const double at = coverage->held_out ? x + 0.1 : x - 0.1;
    Series bar{"",
               Eigen::Vector2d(at, at),
               100.0 * Eigen::Vector2d(coverage->interval->low, coverage->interval->high),
               series_color(1),
               {}};
    plot.series.push_back(bar);
  }
  if (inside.empty()) return {};
  plot.series.push_back(dots("in-sample", inside, 0));
  if (!outside.empty()) {
    plot.series.push_back(dots(concat({"held out (bar: ", percent(part.interval_level, 0), " interval)"}), outside, 1));
  }
  return figure(render(plot), concat({"Coverage of ", what, ". ", names, "."}));
}

Markup paper_table() {
  Table table("The paper's Table 1: accumulated sample variance (%) after k synergies (100 at k = 16)",
              {"group", "k = 1", "2", "3", "4", "5", "6", "7", "8", "9", "k for 95 %"});
  for (const auto& row : kPaperTable1) {
    std::vector<Markup> cells{text(row.name)};
    for (const double value : row.percent) cells.push_back(text(fixed(value, 3)));
    cells.push_back(text(std::to_string(row.k)));
    table.row(cells);
  }
  return table.str();
}

std::string comparison_words(const SynergyPart& part) {
  if (part.grouped_by == "family") {
    return "Dashed: the paper's Table 1 for the same phase and family (its recordings are not published; only these "
           "figures are).";
  }
  return concat({"Groups here are formed by ", part.grouped_by,
                 ", the paper's by grasp family: Table 1 is not comparable group by group. Its pre-grasp column is "
                 "drawn dashed as context, and the table is given in full below."});
}

}  // namespace

void check_sizes(const SynergyPart& part) {
  const auto n = static_cast<Eigen::Index>(part.joint_names.size());
  for (const auto& item : part.groups) {
    const auto& group = item.group;
    const auto fits = [&](Eigen::Index size) { return size == n || size == 0; };
    require(group.basis.variance.size() == n && group.basis.mean.size() == n && group.basis.axes.rows() == n &&
                group.basis.axes.cols() == n && group.box.scale.size() == n && group.box.half_width.size() <= n &&
                fits(item.cumulative_low.size()) && item.cumulative_high.size() == item.cumulative_low.size(),
            [&] {
              return concat({"synergy group '", group.name, "': sizes do not fit the joint names"});
            });
  }
}

Markup synergy_section(const ReportInput& input) {
  if (!input.synergies) return note("The demonstrations have not been analysed yet: no synergies.");
  const auto& part = *input.synergies;
  check_sizes(part);
  Markup out =
      paragraph(concat({"Synergies are the principal axes of the hand's joint positions in one phase: of all "
                        "movements together before the transition, of each group after it. k is the number of "
                        "them that holds the stated share of the variance. ",
                        comparison_words(part)}));
  std::vector<Markup> plots;
  int color = 0;
  for (const auto& item : part.groups) plots.push_back(variance_plot(part, item, color++));
  out += row_of(plots);
  out += number_table(part);
  if (!part.groups.empty()) {
    const auto& box = part.groups.front().group.box;
    out += note(concat({"Boxes are sized for alpha = ", percent(box.alpha), " and beta = ", percent(box.beta),
                        ", root ", part.box_root, "."}));
  }
  out += row_of({coverage_plot(part, &SynergyItem::full_box, "the full box (all effective axes)"),
                 coverage_plot(part, &SynergyItem::reduced_box, "the first k coordinates")});
  out += coverage_table(part);
  out += details("Table 1 of the paper", paper_table());
  return out;
}

}  // namespace opponens::report
