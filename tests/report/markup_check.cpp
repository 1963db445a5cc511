// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/report/markup_check.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <regex>
#include <set>
#include <utility>

namespace opponens::report {
namespace {

const std::set<std::string> kVoid{"meta", "br", "hr", "img", "link", "input"};

struct Tag {
  std::string name;
  bool closing = false;
  bool self_closed = false;
  std::vector<std::pair<std::string, std::string>> attributes;
};

bool is_name(std::string_view text) {
  return !text.empty() && text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789:-_") ==
                              std::string_view::npos;
}

/// Parses what stands between < and >; nothing when it is not a tag. By hand: path data is too long for std::regex.
std::optional<Tag> parse(std::string_view text) {
  Tag tag;
  if (text.starts_with('/')) {
    tag.closing = true;
    text.remove_prefix(1);
  }
  if (text.ends_with('/')) {
    tag.self_closed = true;
    text.remove_suffix(1);
  }
  const std::size_t end = std::min(text.find(' '), text.size());
  tag.name = text.substr(0, end);
  text.remove_prefix(end);
  if (!is_name(tag.name)) return std::nullopt;
  while (text.find_first_not_of(' ') != std::string_view::npos) {
    if (text.front() != ' ') return std::nullopt;
    text.remove_prefix(text.find_first_not_of(' '));
    const std::size_t equals = text.find("=\"");
    if (equals == std::string_view::npos || !is_name(text.substr(0, equals))) return std::nullopt;
    const std::size_t close = text.find('"', equals + 2);
    if (close == std::string_view::npos) return std::nullopt;
    tag.attributes.emplace_back(text.substr(0, equals), text.substr(equals + 2, close - equals - 2));
    text.remove_prefix(close + 1);
  }
  return tag;
}

/// Calls on_tag and on_text over the markup; returns the first fatal problem, or nothing.
std::string walk(std::string_view markup, const std::function<void(const Tag&)>& on_tag,
                 const std::function<void(const std::string&)>& on_text) {
  std::size_t at = 0;
  while (at < markup.size()) {
    const std::size_t next = markup.find('<', at);
    on_text(std::string(markup.substr(at, next - at)));
    if (next == std::string_view::npos) break;
    at = next;
    const auto rest = markup.substr(at);
    if (rest.starts_with("<!")) {
      const bool comment = rest.starts_with("<!--");
      at = markup.find(comment ? "-->" : ">", at) + (comment ? 3 : 1);
      continue;
    }
    const std::size_t end = markup.find('>', at);
    if (end == std::string_view::npos) return "a tag does not end: " + std::string(rest.substr(0, 60));
    const auto inner = markup.substr(at + 1, end - at - 1);
    const auto tag = inner.find('<') == std::string_view::npos ? parse(inner) : std::nullopt;
    if (!tag) return "not a tag: " + std::string(inner.substr(0, 80));
    on_tag(*tag);
    at = end + 1;
    if (tag->name == "style" && !tag->closing) at = markup.find("</style>", at);
  }
  return "";
}

void check_text(const std::string& text, std::vector<std::string>& problems) {
  static const std::regex kEntity("^&(amp|lt|gt|quot|#[0-9]+);");
  for (std::size_t at = text.find('&'); at != std::string::npos; at = text.find('&', at + 1)) {
    if (!std::regex_search(text.substr(at, 12), kEntity)) problems.push_back("bare &: " + text.substr(at, 20));
  }
  if (text.find('>') != std::string::npos) problems.push_back("bare >: " + text.substr(0, 40));
}

}  // namespace

std::vector<std::string> markup_problems(std::string_view markup) {
  std::vector<std::string> problems;
  std::vector<std::string> open;
  std::set<std::string> ids;
  const auto on_tag = [&](const Tag& tag) {
    std::set<std::string> names;
    for (const auto& [name, value] : tag.attributes) {
      if (!names.insert(name).second) problems.push_back("attribute twice: " + name + " of " + tag.name);
      if (name == "id" && !ids.insert(value).second) problems.push_back("id twice: " + value);
      check_text(value, problems);
    }
    if (tag.self_closed || kVoid.contains(tag.name)) return;
    if (!tag.closing) {
      open.push_back(tag.name);
    } else if (open.empty() || open.back() != tag.name) {
      problems.push_back("closes " + tag.name + " inside " + (open.empty() ? "nothing" : open.back()));
    } else {
      open.pop_back();
    }
  };
  const std::string fatal = walk(markup, on_tag, [&](const std::string& text) { check_text(text, problems); });
  if (!fatal.empty()) problems.push_back(fatal);
  for (const auto& name : open) problems.push_back("not closed: " + name);
  return problems;
}

std::vector<std::string> attribute_values(std::string_view markup, std::string_view wanted) {
  std::vector<std::string> values;
  walk(
      markup,
      [&](const Tag& tag) {
        for (const auto& [name, value] : tag.attributes) {
          if (name == wanted) values.push_back(value);
        }
      },
      [](const std::string&) {});
  return values;
}

}  // namespace opponens::report
