// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <map>

#include "core/require.hpp"
#include "report/html.hpp"
#include "report/report.hpp"
#include "report/text.hpp"

namespace opponens::report {
namespace {

/// The page's style sheet without its themes for other media, so that a picture looks the same wherever it is shown.
std::string light_style() {
  std::string style(style_sheet());
  for (std::size_t begin = style.find("@media"); begin != std::string::npos; begin = style.find("@media", begin)) {
    std::size_t end = style.find('{', begin);
    for (int depth = 1; depth > 0 && ++end < style.size();) {
      if (style[end] == '{') ++depth;
      if (style[end] == '}') --depth;
    }
    style.erase(begin, end + 1 - begin);
  }
  return style;
}

/// The anchor of the section that holds a place of the page.
std::string anchor_at(const std::string& page, std::size_t place) {
  const std::string mark = "<section id=\"";
  const std::size_t section = page.rfind(mark, place);
  if (section == std::string::npos) return "page";
  const std::size_t begin = section + mark.size();
  return page.substr(begin, page.find('"', begin) - begin);
}

/// Past the end of the picture that begins there; clips inside it are <svg> elements too.
std::size_t end_of_picture(const std::string& page, std::size_t begin) {
  const std::string open = "<svg";
  const std::string close = "</svg>";
  std::size_t at = begin + open.size();
  for (int depth = 1; depth > 0;) {
    const std::size_t end = page.find(close, at);
    require(end != std::string::npos, "svg_files: a picture of the page is not closed");
    const std::size_t inner = page.find(open, at);
    depth += inner < end ? 1 : -1;
    at = inner < end ? inner + open.size() : end + close.size();
  }
  return at;
}

}  // namespace

std::vector<SvgFile> svg_files(const std::string& page) {
  const std::string style = concat({"<style>\n", light_style(), "</style>"});
  std::vector<SvgFile> files;
  std::map<std::string, int> counts;
  std::size_t end = 0;
  for (std::size_t begin = page.find("<svg"); begin != std::string::npos; begin = page.find("<svg", end)) {
    end = end_of_picture(page, begin);
    std::string svg = page.substr(begin, end - begin);
    const std::string anchor = anchor_at(page, begin);
    const int number = ++counts[anchor];
    if (svg.find("xmlns=") == std::string::npos) svg.insert(4, " xmlns=\"http://www.w3.org/2000/svg\"");
    svg.insert(svg.find('>') + 1, style);
    files.push_back({concat({anchor, "_", std::to_string(number), ".svg"}),
                     concat({"<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n", svg, "\n"})});
  }
  return files;
}

}  // namespace opponens::report
