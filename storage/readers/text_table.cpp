// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <set>
#include <string_view>
#include <utility>

#include "storage/readers/csv.hpp"
#include "storage/readers/table.hpp"
#include "storage/text.hpp"

namespace opponens::storage {
namespace {

struct Columns {
  std::vector<std::size_t> numbers;  // time, then channels
  std::vector<std::size_t> texts;    // those that make runs
};

Columns find_columns(const CsvReader& csv, const std::filesystem::path& file, const SourceDescription& source) {
  Columns columns;
  std::set<std::string_view> known(source.ignored_columns.begin(), source.ignored_columns.end());
  const auto find = [&](const std::string& name, const char* what) {
    known.insert(name);
    return csv.column(name, what);
  };
  for (const auto& name : source.time.columns) columns.numbers.push_back(find(name, "time column"));
  for (const auto& channel : source.channels) columns.numbers.push_back(find(channel.column, "channel"));
  for (const auto& name : source.table.run_by) columns.texts.push_back(find(name, "column of run_by"));
  if (source.table.format == TableFormat::text) return columns;
  for (const auto name : csv.header()) {
    if (known.contains(name)) continue;
    throw_input(file, 1, "unknown channel: column", std::string(name),
                "a column that the source's 'time', 'channels' or 'ignore' names");
  }
  return columns;
}

/// Cuts the lines into runs that are equal in the text columns, and numbers those of equal text.
class Runs {
 public:
  explicit Runs(const std::vector<std::string>& names) : names_(names) {}

  /// Whether this line begins a run.
  bool begins(const CsvReader& csv, const std::vector<std::size_t>& columns) {
    bool same = !now_.empty();
    for (std::size_t i = 0; i < columns.size() && same; ++i) same = csv.cell(columns[i]) == now_[i];
    if (same) return false;
    now_.clear();
    for (const auto column : columns) {
      if (!is_utf8(csv.cell(column)) || csv.cell(column).empty()) csv.fail(column, "a text in UTF-8");
      now_.emplace_back(csv.cell(column));
    }
    return true;
  }

  void name(Table& table) {
    std::string part;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      table.facts[names_[i]] = now_[i];
      part += (part.empty() ? "" : "_") + now_[i];
    }
    const std::string number = std::to_string(++seen_[part]);
    table.facts["run"] = number;
    table.part = part.append("_").append(number);
  }

 private:
  const std::vector<std::string>& names_;
  std::vector<std::string> now_;
  std::map<std::string, int> seen_;
};

}  // namespace

std::size_t time_width(const SourceDescription& source) {
  return source.time.variable.empty() ? source.time.columns.size() : 1;
}

void read_text_tables(const std::string& bytes, const std::filesystem::path& file, const SourceDescription& source,
                      const TakeTable& take) {
  const bool named = source.table.format == TableFormat::csv;
  CsvReader csv(bytes, file, {named, named, source.table.columns, source.table.skip_lines, source.table.transposed});
  const Columns columns = find_columns(csv, file, source);
  Runs runs(source.table.run_by);
  Table table;
  table.width = columns.numbers.size();
  const std::size_t expected = bytes.size() / 8;  // values are seldom shorter; vectors grow when they are
  if (columns.texts.empty()) table.values.reserve(expected);
  while (csv.next()) {
    if (!columns.texts.empty() && runs.begins(csv, columns.texts)) {
      if (!table.values.empty()) take(std::exchange(table, Table{{}, {}, columns.numbers.size(), {}, 0}));
      runs.name(table);
    }
    if (table.values.empty()) table.first_line = source.table.transposed ? 0 : csv.line();
    for (const auto column : columns.numbers) table.values.push_back(csv.number(column));
  }
  if (table.values.empty() && !columns.texts.empty()) throw_input(file, 0, "number of rows", "0", "at least 2 samples");
  take(std::move(table));
}

}  // namespace opponens::storage
