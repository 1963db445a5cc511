// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: delimited text, line by line.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace opponens::storage {

/// Throws InputError "file:line: field 'x' is 'value': expected ...". line 0: the file as a whole.
[[noreturn]] void throw_input(const std::filesystem::path& file, long line, const std::string& field,
                              const std::string& value, const std::string& expectation);

/// How lines are cut into cells.
struct TextLayout {
  bool header = true;          ///< the first line names the columns; else their names are "1", "2", ...
  bool commas = true;          ///< cells end at commas; else at runs of blanks, commas, semicolons and brackets
  std::size_t columns = 0;     ///< without a header: how many a line has
  std::size_t skip_lines = 0;  ///< before the first
  bool transposed = false;     ///< rows and columns change places
};

/// Walks over delimited text line by line. Cells are stripped of spaces and tabs; CRLF and a UTF-8 byte order
/// mark are accepted, quotes are not. Every line must have as many cells as the first. Refers to the text it is given.
class CsvReader {
 public:
  CsvReader(std::string_view text, std::filesystem::path file, const TextLayout& layout = {});

  const std::vector<std::string_view>& header() const { return header_; }

  /// Position of a column; throws when there is none of that name. what: for the message, e.g. "time column".
  std::size_t column(const std::string& name, const std::string& what) const;

  bool next();                         ///< to the next line; false at the end
  long line() const { return line_; }  ///< of a transposed text: the number of the column
  std::string_view cell(std::size_t column) const { return cells_[column]; }
  double number(std::size_t column) const;  ///< finite, or throws
  [[noreturn]] void fail(std::size_t column, const std::string& expectation) const;

 private:
  bool next_line(std::string_view& line);
  void split(std::string_view line);
  void read_header();
  void number_columns(std::size_t count);
  void transpose();

  std::string_view rest_;
  std::filesystem::path file_;
  TextLayout layout_;
  std::vector<std::string> numbers_;  // names of columns that have none
  std::vector<std::string_view> header_;
  std::vector<std::string_view> cells_;
  std::vector<std::vector<std::string_view>> turned_;  // of a transposed text: its lines
  long line_ = 0;
};

}  // namespace opponens::storage
