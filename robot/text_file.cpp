// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/text_file.hpp"

#include <algorithm>
#include <fstream>
#include <string_view>

#include <tinyxml.h>

#include "core/require.hpp"

namespace opponens::robot {

namespace {

constexpr std::size_t kMaxBytes = std::size_t{64} << 20;
constexpr int kMaxDepth = 200;

/// Past the end of the first `close` from `at` on; the end of the text when there is none.
std::size_t past(std::string_view text, std::size_t at, std::string_view close) {
  const std::size_t found = text.find(close, at);
  return found == std::string_view::npos ? text.size() : found + close.size();
}

/// The '>' that ends the tag at `at`; one inside a quoted value does not.
std::size_t tag_end(std::string_view text, std::size_t at) {
  char quote = '\0';
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      return at;
    }
  }
  return at;
}

/// Line (from 1) of the first element nested deeper than kMaxDepth; 0 when there is none.
long too_deep(std::string_view text) {
  int depth = 0;
  for (std::size_t at = text.find('<'); at < text.size(); at = text.find('<', at)) {
    const std::string_view rest = text.substr(at);
    if (rest.starts_with("<!--")) {
      at = past(text, at + 4, "-->");
    } else if (rest.starts_with("<![CDATA[")) {
      at = past(text, at, "]]>");
    } else if (rest.starts_with("<?") || rest.starts_with("<!")) {
      at = past(text, at, ">");
    } else {
      const std::size_t end = tag_end(text, at);
      const bool closing = rest.starts_with("</");
      const bool empty = end < text.size() && text[end - 1] == '/';
      if (closing) {
        --depth;
      } else if (!empty && ++depth > kMaxDepth) {
        return 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
      }
      at = end;
    }
  }
  return 0;
}

}  // namespace

std::string read_text_file(const std::filesystem::path& file, const std::string& kind) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    throw InputError(file.string() + ": is a directory, expected " + kind);
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file.string() + ": cannot be opened");
  std::string content;
  std::string block(std::size_t{1} << 16, '\0');
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) || stream.gcount() > 0) {
    content.append(block, 0, static_cast<std::size_t>(stream.gcount()));
    if (content.size() > kMaxBytes) throw InputError(file.string() + ": is longer than 64 MiB, expected " + kind);
  }
  return content;
}

void parse_xml(const std::filesystem::path& file, const std::string& text, TiXmlDocument& document) {
  if (const long line = too_deep(text); line > 0) {
    throw InputError(file.string() + ": line " + std::to_string(line) + ": more than " + std::to_string(kMaxDepth) +
                     " elements inside each other");
  }
  document.Parse(text.c_str());
  if (document.Error()) {
    throw InputError(file.string() + ": line " + std::to_string(document.ErrorRow()) +
                     ": not XML: " + document.ErrorDesc());
  }
}

}  // namespace opponens::robot
