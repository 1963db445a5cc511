// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/readers/csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <set>
#include <utility>

#include "core/require.hpp"

namespace opponens::storage {
namespace {

constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// Between the cells of a text without a fixed separator.
constexpr bool is_separator(char c) {
  return is_blank(c) || c == ',' || c == ';' || c == '[' || c == ']' || c == '(' || c == ')' || c == '{' || c == '}';
}

std::string_view strip(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
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

CsvReader::CsvReader(std::string_view text, std::filesystem::path file, const TextLayout& layout)
    : rest_(text), file_(std::move(file)), layout_(layout) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
  std::string_view line;
  for (std::size_t i = 0; i < layout_.skip_lines; ++i) next_line(line);
  if (layout_.transposed) {
    transpose();
  } else if (layout_.header) {
    read_header();
  } else {
    number_columns(layout_.columns);
  }
}

void CsvReader::read_header() {
  std::string_view line;
  if (!next_line(line)) throw InputError(file_.string() + ": the file is empty: expected a header line");
  split(line);
  header_ = cells_;
  std::set<std::string_view> seen;
  for (const auto name : header_) {
    if (name.empty()) throw_input(file_, line_, "a column's name", "", "a name in every cell of the header");
    if (!seen.insert(name).second) throw_input(file_, line_, "column name", std::string(name), "each name once");
  }
}

void CsvReader::number_columns(std::size_t count) {
  for (std::size_t i = 1; i <= count; ++i) numbers_.push_back(std::to_string(i));
  header_.assign(numbers_.begin(), numbers_.end());
}

void CsvReader::transpose() {
  std::string_view line;
  while (next_line(line)) {
    split(line);
    if (!turned_.empty() && cells_.size() != turned_.front().size()) {
      throw_input(file_, line_, "number of columns", std::to_string(cells_.size()),
                  std::to_string(turned_.front().size()) + " as in the first line");
    }
    turned_.push_back(cells_);
  }
  if (turned_.empty()) throw InputError(file_.string() + ": the file is empty");
  line_ = 0;
  if (!layout_.header) {
    number_columns(turned_.size());
    return;
  }
  next();
  header_ = cells_;
  std::set<std::string_view> seen;
  for (const auto name : header_) {
    if (!seen.insert(name).second) throw_input(file_, 0, "channel name", std::string(name), "each name once");
  }
}

bool CsvReader::next_line(std::string_view& line) {
  if (rest_.find_first_not_of(" \t\r\n") == std::string_view::npos) return false;  // blank lines at the end
  const void* newline = std::memchr(rest_.data(), '\n', rest_.size());
  const std::size_t end =
      newline == nullptr ? rest_.size() : static_cast<std::size_t>(static_cast<const char*>(newline) - rest_.data());
  line = rest_.substr(0, end);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  ++line_;
  return true;
}

void CsvReader::split(std::string_view line) {
  cells_.clear();
  if (!layout_.commas) {
    std::size_t i = 0;
    while (true) {
      while (i < line.size() && is_separator(line[i])) ++i;
      if (i == line.size()) return;
      const std::size_t begin = i;
      while (i < line.size() && !is_separator(line[i])) ++i;
      cells_.push_back(line.substr(begin, i - begin));
    }
  }
  std::size_t begin = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {  // cells are too short for memchr to pay
    if (line[i] != ',') continue;
    cells_.push_back(strip(line.substr(begin, i - begin)));
    begin = i + 1;
  }
  cells_.push_back(strip(line.substr(begin)));
}

std::size_t CsvReader::column(const std::string& name, const std::string& what) const {
  const auto found = std::find(header_.begin(), header_.end(), name);
  if (found != header_.end()) return static_cast<std::size_t>(found - header_.begin());
  if (!numbers_.empty()) {
    throw_input(file_, 0, what, name, "a column number from 1 to " + std::to_string(numbers_.size()));
  }
  std::string list;
  for (const auto column : header_) list += (list.empty() ? "" : ", ") + std::string(column);
  throw_input(file_, 1, "header", list, "a " + what + " '" + name + "'");
}

bool CsvReader::next() {
  if (layout_.transposed) {
    const auto column = static_cast<std::size_t>(line_);
    if (column >= turned_.front().size()) return false;
    cells_.clear();
    for (const auto& row : turned_) cells_.push_back(row[column]);
    ++line_;
    return true;
  }
  std::string_view line;
  if (!next_line(line)) return false;
  split(line);
  if (cells_.size() != header_.size()) {
    throw_input(file_, line_, "number of columns", std::to_string(cells_.size()),
                std::to_string(header_.size()) + (layout_.header ? " as in the header" : " (table.columns)"));
  }
  return true;
}

double CsvReader::number(std::size_t column) const {
  std::string_view text = cells_[column];
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  // Out of range is also what is too small to be told from 0.
  if (error == std::errc::result_out_of_range && end == text.data() + text.size() &&
      std::abs(std::strtod(std::string(text).c_str(), nullptr)) < 1.0) {
    return 0.0;
  }
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    fail(column, "a finite number");
  }
  return value;
}

void CsvReader::fail(std::size_t column, const std::string& expectation) const {
  const std::string place = layout_.transposed ? " in column " + std::to_string(line_) : "";
  throw_input(file_, layout_.transposed ? 0 : line_, "field '" + std::string(header_[column]) + "'" + place,
              std::string(cells_[column]), expectation);
}

}  // namespace opponens::storage
