// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/readers/csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "core/require.hpp"

namespace opponens::storage {
namespace {

constexpr std::string_view kBlank = " \t\r";

std::string_view strip(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

/// Values in messages are cut short: a binary file has long "cells".
std::string shown(const std::string& value) {
  constexpr std::size_t kLongest = 60;
  return value.size() <= kLongest ? value : value.substr(0, kLongest) + "...";
}

}  // namespace

void throw_input(const std::filesystem::path& file, long line, const std::string& field, const std::string& value,
                 const std::string& expectation) {
  const std::string place = line > 0 ? ":" + std::to_string(line) : "";
  throw InputError(file.string() + place + ": " + field + " is '" + shown(value) + "': expected " + expectation);
}

CsvReader::CsvReader(std::string_view text, std::filesystem::path file) : rest_(text), file_(std::move(file)) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
  std::string_view line;
  if (!next_line(line)) throw InputError(file_.string() + ": the file is empty: expected a header line");
  split(line);
  header_ = cells_;
  for (auto name = header_.begin(); name != header_.end(); ++name) {
    if (name->empty()) throw_input(file_, line_, "a column's name", "", "a name in every cell of the header");
    if (std::find(header_.begin(), name, *name) != name) {
      throw_input(file_, line_, "column name", std::string(*name), "each name once");
    }
  }
}

bool CsvReader::next_line(std::string_view& line) {
  if (rest_.find_first_not_of(" \t\r\n") == std::string_view::npos) return false;  // blank lines at the end
  const std::size_t end = std::min(rest_.find('\n'), rest_.size());
  line = rest_.substr(0, end);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  ++line_;
  return true;
}

void CsvReader::split(std::string_view line) {
  cells_.clear();
  while (true) {
    const std::size_t comma = line.find(',');
    cells_.push_back(strip(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

std::size_t CsvReader::column(const std::string& name, const std::string& what) const {
  const auto found = std::find(header_.begin(), header_.end(), name);
  if (found != header_.end()) return static_cast<std::size_t>(found - header_.begin());
  std::string list;
  for (const auto column : header_) list += (list.empty() ? "" : ", ") + std::string(column);
  throw_input(file_, 1, "header", list, "a " + what + " '" + name + "'");
}

bool CsvReader::next() {
  std::string_view line;
  if (!next_line(line)) return false;
  split(line);
  if (cells_.size() != header_.size()) {
    throw_input(file_, line_, "number of columns", std::to_string(cells_.size()),
                std::to_string(header_.size()) + " as in the header");
  }
  return true;
}

double CsvReader::number(std::size_t column) const {
  const std::string_view text = cells_[column];
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    fail(column, "a finite number");
  }
  return value;
}

void CsvReader::fail(std::size_t column, const std::string& expectation) const {
  throw_input(file_, line_, "field '" + std::string(header_[column]) + "'", std::string(cells_[column]), expectation);
}

}  // namespace opponens::storage
