// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report/text.hpp"

namespace opponens::report {

/// The page's style sheet: light and dark theme, print, and the classes that the drawings use.
std::string_view style_sheet();

Markup paragraph(const Markup& content);
inline Markup paragraph(std::string_view plain) { return paragraph(text(plain)); }
/// A paragraph for what is missing or needs care when reading.
Markup note(std::string_view plain);
Markup subheading(std::string_view plain);
/// An SVG (markup of our own) with the words under it.
Markup figure(const std::string& svg, std::string_view caption);
/// Figures that flow side by side.
Markup row_of(const std::vector<Markup>& figures, std::string_view css_class = "row");
/// An id, shortened, the whole of it in the title.
Markup identifier(std::string_view id);
/// A coloured word: good (true) or bad.
Markup badge(bool good, std::string_view word);
/// Content behind a summary line that opens on a click and when printed stays as it is.
Markup details(std::string_view summary, const Markup& content);

/// A table with a caption; the first column is a row's header. Columns of numbers are set right.
class Table {
 public:
  Table(std::string_view caption, const std::vector<std::string>& headers);
  void row(const std::vector<Markup>& cells);
  Markup str() const;
  bool empty() const { return rows_.empty(); }

 private:
  std::string caption_;
  std::vector<std::string> headers_;
  std::vector<std::vector<Markup>> rows_;
};

}  // namespace opponens::report
