// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Prints the accumulated variance that the newest synergies of each given store hold, beside the paper's Table 1.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/require.hpp"
#include "report/paper_tables.hpp"
#include "storage/store.hpp"

namespace opponens {
namespace {

using Json = nlohmann::json;
constexpr std::size_t kRows = 9;  // of the paper's table

struct Column {
  std::string name;
  int k = 0;
  std::vector<double> percent;
  std::vector<std::pair<double, double>> interval;  ///< empty with a single cluster
};

std::vector<Column> columns_of(const storage::Store& store) {
  const auto sets = store.list_as_produced("synergy_set");
  if (sets.empty()) throw InputError(store.directory().string() + ": no synergies; run: opponens analyze");
  const storage::Record record = store.read(sets.back().id);
  const Json analysis = Json::parse(std::get<std::string>(record.fields.at("analysis")));
  std::vector<Column> columns;
  for (const Json& group : analysis.at("groups")) {
    Column column{group.at("name"), group.at("k"), {}, {}};
    for (const Json& share : group.at("cumulative_variance")) column.percent.push_back(100.0 * share.get<double>());
    for (const Json& pair : group.at("cumulative_variance_interval")) {
      column.interval.emplace_back(100.0 * pair.at(0).get<double>(), 100.0 * pair.at(1).get<double>());
    }
    columns.push_back(std::move(column));
  }
  return columns;
}

std::string cell(const Column& column, std::size_t row) {
  if (row >= column.percent.size()) return "-";
  char text[64];
  if (row < column.interval.size()) {
    std::snprintf(text, sizeof text, "%.1f [%.1f, %.1f]", column.percent[row], column.interval[row].first,
                  column.interval[row].second);
  } else {
    std::snprintf(text, sizeof text, "%.1f", column.percent[row]);
  }
  return text;
}

void print_table(const std::vector<Column>& columns) {
  std::string head = "| k |";
  std::string line = "|---|";
  for (const auto& paper : report::kPaperTable1) {
    head += " paper, " + std::string(paper.name) + " |";
    line += "---|";
  }
  for (const Column& column : columns) {
    head += " " + column.name + " |";
    line += "---|";
  }
  std::printf("%s\n%s\n", head.c_str(), line.c_str());
  for (std::size_t row = 0; row < kRows; ++row) {
    std::printf("| %zu |", row + 1);
    for (const auto& paper : report::kPaperTable1) std::printf(" %.1f |", paper.percent[row]);
    for (const Column& column : columns) std::printf(" %s |", cell(column, row).c_str());
    std::printf("\n");
  }
  std::printf("| k for 95 %% |");
  for (const auto& paper : report::kPaperTable1) std::printf(" %d |", paper.k);
  for (const Column& column : columns) std::printf(" %d |", column.k);
  std::printf("\n\n");
}

std::size_t shares_in_interval(const Column& column, const report::PaperVariance& paper) {
  std::size_t inside = 0;
  for (std::size_t row = 0; row < std::min(kRows, column.interval.size()); ++row) {
    const auto& [low, high] = column.interval[row];
    inside += paper.percent[row] >= low && paper.percent[row] <= high ? 1 : 0;
  }
  return inside;
}

void append(std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; }

/// One sentence: what agrees with the paper and what does not.
void print_sentence(const std::vector<Column>& columns) {
  std::size_t inside = 0;
  std::size_t compared = 0;
  std::string ours;
  std::string papers;
  std::string others;
  for (const Column& column : columns) {
    const report::PaperVariance* paper = report::paper_variance(column.name);
    if (paper == nullptr) {
      append(others, column.name + " " + std::to_string(column.k));
      continue;
    }
    inside += shares_in_interval(column, *paper);
    compared += kRows;
    append(ours, std::to_string(column.k));
    append(papers, std::to_string(paper->k));
  }
  std::printf(
      "Of the paper's %zu shares that can be compared, %zu lie in the interval found here, and 95 %% of the variance "
      "take %s synergies (paper: %s)%s%s.\n\n",
      compared, inside, ours.c_str(), papers.c_str(),
      others.empty() ? ""
                     : "; of groups that are no family of the "
                       "paper (there 4 or 5): ",
      others.c_str());
}

}  // namespace
}  // namespace opponens

int main(int count, char** arguments) {
  if (count < 2) {
    std::fprintf(stderr, "usage: table1_variance STORE...\n");
    return 2;
  }
  try {
    for (int i = 1; i < count; ++i) {
      const auto columns = opponens::columns_of(opponens::storage::Store(arguments[i], false));
      std::printf("%s\n\n", arguments[i]);
      opponens::print_table(columns);
      opponens::print_sentence(columns);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "table1_variance: %s\n", error.what());
    return 2;
  }
  return 0;
}
