// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <optional>
#include <string>

#include "experiments/table2_planning/output.hpp"
#include "report/paper_tables.hpp"

namespace opponens::table2 {
namespace {

std::string format(const char* form, double value) {
  char text[48];
  std::snprintf(text, sizeof text, form, value);
  return text;
}

std::string cell(const std::optional<Estimate>& estimate, const char* form) {
  if (!estimate) return "-";
  return format(form, estimate->value) + " [" + format(form, estimate->low) + ", " + format(form, estimate->high) + "]";
}

/// median [interval]; mean [interval].
std::string cell(const Column& column, const char* form) {
  if (column.count == 0) return "-";
  return cell(column.median, form) + "; " + cell(column.mean, form);
}

std::string share(int part, int whole) { return whole == 0 ? "-" : std::to_string(part) + "/" + std::to_string(whole); }

std::string paper_rows() {
  std::string text;
  for (const auto& row : report::kPaperTable2) {
    text += "| " + std::string(row.name) + " | - | " + format("%.0f %%", row.success_percent) + " | " +
            format("%.0f", 1e3 * row.planning_seconds) + " | " + format("%.0f", row.iterations) + " | " +
            format("%.0f", row.collision_checks) + " | " + format("%.1f", row.valid_percent) + " | " +
            format("%.2f", row.length_rad) + " | " + format("%.1f", row.likeness_percent) + " | - | - |\n";
  }
  return text;
}

std::string table(const std::vector<Summary>& rows) {
  std::string text =
      "| case | range, rad | solved | planning CPU, ms | iterations | collision checks | valid segments, % | "
      "length_rad | "
      "human-likeness, % | planning over checking the path | verified "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Summary& row : rows) {
    text += "| " + row.planner + " | " + format("%g", row.range) + " | " + share(row.solved, row.runs) + " | " +
            cell(row.cpu_ms, "%.1f") + " | " + cell(row.iterations, "%.1f") + " | " + cell(row.checks, "%.0f") + " | " +
            cell(row.valid_percent, "%.1f") + " | " + cell(row.length, "%.2f") + " | " + cell(row.likeness, "%.1f") +
            " | " + cell(row.time_ratio, "%.1f") + " | " + share(row.verified, row.verified_of) + " |\n";
  }
  return text;
}

std::string further(const std::vector<Summary>& rows) {
  std::string text =
      "| case | CPU 99 %, ms | checks with confirmation | sum of joint movements, rad | arm's length, rad | hand's "
      "length, "
      "rad | families reached |\n|---|---|---|---|---|---|---|\n";
  for (const Summary& row : rows) {
    text += "| " + row.planner + " | " + format("%.1f", row.cpu_ms_99) + " | " + cell(row.all_checks, "%.0f") + " | " +
            cell(row.length_l1, "%.2f") + " | " + cell(row.arm_length, "%.2f") + " | " + cell(row.hand_length, "%.2f") +
            " | " + std::to_string(row.grasp_groups) + " |\n";
  }
  return text;
}

std::string tried(const std::vector<Summary>& rows) {
  std::string text =
      "| case | range, rad | solved | collision checks, median | CPU, ms, median |\n|---|---|---|---|---|\n";
  for (const Summary& row : rows) {
    text += "| " + row.planner + " | " + format("%g", row.range) + " | " + share(row.solved, row.runs) + " | " +
            format("%.0f", row.checks.median->value) + " | " + format("%.1f", row.cpu_ms.median->value) + " |\n";
  }
  return text;
}

std::string compared(const std::vector<Comparison>& rows) {
  std::string text =
      "| case against | checks, geometric ratio | checks, ratio of means | checks with confirmation | CPU | length "
      "difference, rad | length ratio | ratio of sums of joint movements | human-likeness difference | solved by both "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Comparison& one : rows) {
    text += "| " + one.planner + " against " + one.baseline + " | " + cell(one.checks_ratio, "%.2f") + " | " +
            cell(one.checks_mean_ratio, "%.2f") + " | " + cell(one.all_checks_ratio, "%.2f") + " | " +
            cell(one.cpu_ratio, "%.2f") + " | " + cell(one.length_difference, "%.2f") + " | " +
            cell(one.length_ratio, "%.2f") + " | " + cell(one.length_l1_ratio, "%.2f") + " | " +
            cell(one.likeness_difference, "%.1f") + " | " + share(one.solved_pairs, one.pairs) + " |\n";
  }
  return text;
}

}  // namespace

std::string markdown_of(const Report& report) {
  const Queries& queries = report.queries;
  std::string unreachable;
  for (const int seeds : queries.unreachable) unreachable += (unreachable.empty() ? "" : ", ") + std::to_string(seeds);
  std::string text = "# " + report.scene + ", " + report.robot + "\n\n" + std::to_string(queries.seeds) +
                     " seeds from " + std::to_string(report.reported_with.first_seed) + ", at most " +
                     std::to_string(report.reported_with.budget) + " checks a run; " +
                     std::to_string(queries.bases_rejected) + " bases drawn again, " + format("%.1f", queries.goals) +
                     " goals on average; seeds whose base does not reach grasp 1, 2, ...: " + unreachable +
                     ".\nMedian [95 %]; mean [95 %]. Human-likeness against " + report.likeness_reference +
                     ". Checks are those of the search; the paper's are averages on another machine.\n\n";
  text += table(report.rows) + paper_rows() + "\n" + further(report.rows) + "\n";
  if (!report.comparisons.empty()) text += compared(report.comparisons) + "\n";
  if (!report.tried.empty()) {
    text += "Ranges tried on " + std::to_string(report.tuned_with.seeds) + " other seeds:\n\n" + tried(report.tried);
  }
  return text;
}

}  // namespace opponens::table2
