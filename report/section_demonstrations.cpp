// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/require.hpp"
#include "report/line_plot.hpp"
#include "report/sections.hpp"
#include "report/svg.hpp"

namespace opponens::report {
namespace {

Markup group_table(const DemonstrationPart& part) {
  Table table("Recordings by " + part.grouped_by,
              {part.grouped_by, "recordings", "samples", "mean duration (s)", "range (s)"});
  int recordings = 0;
  int samples = 0;
  for (const auto& group : part.groups) {
    table.row({text(group.name), text(grouped(group.recordings)), text(grouped(group.samples)),
               text(fixed(group.mean_duration, 2)),
               text(concat({fixed(group.duration.low, 2), " to ", fixed(group.duration.high, 2)}))});
    recordings += group.recordings;
    samples += group.samples;
  }
  table.row({text("all"), text(grouped(recordings)), text(grouped(samples)), text(""), text("")});
  return table.str();
}

/// How well the mapping follows each fingertip, and which joints it holds at a limit.
Markup mapping_tables(const DemonstrationPart& part) {
  Markup out;
  Table tips("Distance of each robot fingertip from its target, root mean square over all samples",
             {"fingertip", "mm"});
  for (const auto& [name, residual] : part.tip_residuals) tips.row({text(name), text(fixed(1000.0 * residual, 1))});
  if (!tips.empty()) out += tips.str();
  Table joints("Joints held at a limit: share of all samples", {"joint", "share"});
  for (const auto& [name, share] : part.clamped_shares) joints.row({text(name), text(percent(share))});
  if (!joints.empty()) out += details("Joints held at a limit", joints.str());
  return out;
}

Markup example_recording(const Demonstration& example) {
  require(example.q_h.rows() == example.time.size() &&
              example.q_h.cols() == static_cast<Eigen::Index>(example.joint_names.size()),
          [&] {
            return concat({"example demonstration '", example.id, "': sizes of time, q_h, joint_names differ"});
          });
  std::string labels;
  for (const auto& [name, value] : example.labels) labels += concat({labels.empty() ? "" : ", ", name, " ", value});
  Markup out = subheading(concat({"Example: ", example.id, example.origin == Origin::simulated ? " (SIMULATED)" : ""}));
  if (!labels.empty()) out += note(labels);
  std::vector<TimeMark> marks;
  if (example.known_transition) marks.push_back({"known transition", *example.known_transition});
  out += joint_charts(example.joint_names, example.time, "time (s)", example.q_h, marks, 4);
  return out;
}

LinePlot cost_plot(const TransitionCurves& curves, const Eigen::VectorXd& cost, const std::string& title,
                   const std::string& axis, const std::optional<double>& found, int color) {
  require(cost.size() == curves.time.size(), [&] {
    return concat({"transition curves of '", curves.demonstration, "': sizes differ"});
  });
  LinePlot plot;
  plot.title = title;
  plot.x.label = "time of the split (s)";
  plot.y.label = axis;
  plot.series.push_back({"", curves.time, cost, series_color(color), {}});
  if (found) plot.marks.push_back({concat({"minimum, ", fixed(*found, 2), " s"}), *found, series_color(color)});
  if (curves.known_time) {
    plot.marks.push_back(
        {concat({"known, ", fixed(*curves.known_time, 2), " s"}), *curves.known_time, "var(--fg)", false, true});
  }
  plot.width = 510.0;
  plot.height = 260.0;
  return plot;
}

Markup example_curves(const TransitionCurves& curves) {
  Markup out = subheading(concat({"One recording: ", curves.demonstration}));
  std::vector<Markup> plots;
  plots.push_back(
      figure(render(cost_plot(curves, curves.log_likeness, "Likeness of the two phases against the split time",
                              "log likeness", curves.likeness_time, 0)),
             "Likeness, Eq. (1): log of the overlap of the Gaussians before and after the split."));
  if (curves.changepoint_cost.size() > 0) {
    plots.push_back(
        figure(render(cost_plot(curves, curves.changepoint_cost, "Change-point cost against the split time",
                                "change-point cost", curves.changepoint_time, 1)),
               "Change point: n1 log|S1 + r\u00B2I| + n2 log|S2 + r\u00B2I|, the best split into two Gaussians."));
  }
  out += row_of(plots);
  return out;
}

using Member = std::optional<double> TransitionFractions::*;

std::vector<double> collect(const std::vector<TransitionFractions>& all, Member member) {
  std::vector<double> values;
  for (const auto& item : all) {
    if (item.*member) values.push_back(*(item.*member));
  }
  return values;
}

/// Differences a - b of the recordings that have both.
std::vector<double> differences(const std::vector<TransitionFractions>& all, Member a, Member b) {
  std::vector<double> values;
  for (const auto& item : all) {
    if (item.*a && item.*b) values.push_back(*(item.*a) - *(item.*b));
  }
  return values;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
}

void difference_row(Table& table, const std::string& name, const std::vector<double>& values) {
  if (values.empty()) return;
  std::vector<double> sizes;
  sizes.reserve(values.size());
  for (const double value : values) sizes.push_back(std::abs(value));
  table.row({text(name), text(std::to_string(values.size())), text(fixed(mean(values), 3)),
             text(fixed(quantile(values, 0.5), 3)), text(fixed(quantile(sizes, 0.5), 3)),
             text(fixed(quantile(sizes, 1.0), 3))});
}

Markup fractions(const std::vector<TransitionFractions>& all) {
  Histogram histogram;
  histogram.title = "Histogram of the transition as a fraction of the movement";
  histogram.x.label = "transition (fraction of the recording's duration)";
  histogram.y.label = "recordings";
  histogram.y.integer = true;
  histogram.width = 700.0;
  const auto add = [&](const std::string& label, Member member, const std::string& color) {
    auto values = collect(all, member);
    if (!values.empty()) histogram.samples.push_back({label, std::move(values), color});
  };
  add("likeness (paper)", &TransitionFractions::likeness, series_color(0));
  add("change point", &TransitionFractions::changepoint, series_color(1));
  add("known (simulated)", &TransitionFractions::known, "var(--paper)");
  Markup out = subheading(concat({"All ", std::to_string(all.size()), " recordings"}));
  out += figure(render(histogram), "Where each rule puts the transition, over all recordings.");
  Table table("How far the rules differ (fraction of the duration)",
              {"difference", "recordings", "mean", "median", "median size", "largest size"});
  using F = TransitionFractions;
  difference_row(table, "likeness - change point", differences(all, &F::likeness, &F::changepoint));
  difference_row(table, "likeness - known", differences(all, &F::likeness, &F::known));
  difference_row(table, "change point - known", differences(all, &F::changepoint, &F::known));
  if (!table.empty()) out += table.str();
  return out;
}

}  // namespace

Markup joint_charts(const std::vector<std::string>& names, const Eigen::VectorXd& time, const std::string& time_label,
                    const Eigen::MatrixXd& values, const std::vector<TimeMark>& marks, int chunk) {
  std::vector<Markup> charts;
  const int count = static_cast<int>(names.size());
  for (int first = 0; first < count; first += chunk) {
    const int size = std::min(chunk, count - first);
    const std::vector<std::string> members(names.begin() + first, names.begin() + first + size);
    LinePlot plot;
    plot.title = concat({"Joint positions over time: ", members.front(), " to ", members.back()});
    plot.x.label = time_label;
    plot.y.label = "position (rad)";
    plot.width = 510.0;
    plot.height = 220.0;
    for (int j = 0; j < size; ++j) {
      plot.series.push_back({members[static_cast<std::size_t>(j)], time, values.col(first + j), series_color(j), {}});
    }
    for (const auto& mark : marks) plot.marks.push_back({mark.label, mark.time, "var(--soft)", false, true});
    charts.push_back(figure(render(plot), ""));
  }
  return row_of(charts);
}

Markup demonstration_section(const ReportInput& input) {
  if (!input.demonstrations) return note("No demonstrations are in the store yet.");
  const auto& part = *input.demonstrations;
  Markup out;
  if (!part.source.empty()) out += paragraph(part.source);
  out += group_table(part);
  if (!part.mapping.empty()) {
    std::string words = concat({"Mapped to the robot hand with --mapping ", part.mapping, "."});
    if (part.tip_residual) {
      words += concat({" Root mean square distance of the fingertips from the human's (scaled): ",
                       fixed(1000.0 * *part.tip_residual, 1), " mm."});
    }
    out += paragraph(words);
    out += mapping_tables(part);
  }
  if (part.example) out += example_recording(*part.example);
  return out;
}

Markup transition_section(const ReportInput& input) {
  if (!input.transitions) return note("The demonstrations have not been analysed yet: no transitions.");
  const auto& part = *input.transitions;
  Markup out = paragraph(concat(
      {"A grasping movement opens the hand the same way whatever the object (pre-grasp phase) and then closes it in a "
       "way "
       "that depends on the grasp. The paper puts the transition where the distributions before and after are least "
       "alike. Known weakness: on simulated movements the likeness minimum can lie well off the true change, or have "
       "two "
       "candidates; the change-point rule is shown beside it. ",
       part.method.empty() ? "No split was made here (--phase none): every group holds its whole recordings."
                           : concat({"In force here: ", part.method, "."})}));
  if (!part.chosen_by.empty()) out += note(part.chosen_by);
  if (part.example) out += example_curves(*part.example);
  for (const TransitionCurves& curves : part.others) out += example_curves(curves);
  if (!part.all.empty()) out += fractions(part.all);
  return out;
}

}  // namespace opponens::report
