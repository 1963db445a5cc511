// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: a YAML mapping whose keys must all be known.

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/require.hpp"
#include "storage/readers/source.hpp"

namespace YAML {
class Node;
}

namespace opponens::storage {

/// "a, b, c"
std::string joined(const std::vector<std::string>& names);

/// Every complaint names file, line, key, value and expectation. The functions without a default throw when the key is
/// missing.
class Section {
 public:
  Section(const YAML::Node& node, std::filesystem::path file, std::string name, const std::vector<std::string>& keys);

  bool has(const std::string& key) const;
  bool is_map(const std::string& key) const;   ///< there, and a mapping
  bool is_list(const std::string& key) const;  ///< there, and a list
  Section inside(const std::string& key, const std::vector<std::string>& keys) const;
  /// The items of a list of mappings; none when the key is missing.
  std::vector<Section> items(const std::string& key, const std::vector<std::string>& keys) const;

  std::string text(const std::string& key) const;
  std::string text(const std::string& key, const std::string& otherwise) const;
  double positive(const std::string& key, double otherwise) const;
  double positive(const std::string& key) const;
  std::size_t count(const std::string& key, std::size_t largest) const;       ///< 0 when the key is missing
  double sign(const std::string& key) const;                                  ///< 1 or -1; 1 when the key is missing
  bool flag(const std::string& key) const;                                    ///< true or false; false when missing
  Pair pair(const std::string& key) const;                                    ///< two different numbers
  std::vector<std::string> texts(const std::string& key) const;               ///< empty when the key is missing
  std::map<std::string, std::string> text_map(const std::string& key) const;  ///< empty when the key is missing
  /// Name -> text or mapping: the texts in the first, {constant: text} in the second.
  std::pair<std::map<std::string, std::string>, std::map<std::string, std::string>> labels(
      const std::string& key) const;

  template <typename Enum>
  Enum choice(const std::string& key, const std::vector<std::pair<std::string, Enum>>& options) const {
    if (!has(key)) return options.front().second;
    const std::string chosen = text(key);
    std::vector<std::string> names;
    for (const auto& [name, value] : options) {
      if (name == chosen) return value;
      names.push_back(name);
    }
    fail(key, "one of " + joined(names));
  }

  /// "key is 'value': expected ...", where the key's value stands (the section, when it is missing).
  [[noreturn]] void fail(const std::string& key, const std::string& expectation) const;
  [[noreturn]] void fail_as(const std::string& field, const std::string& key, const std::string& expectation) const;

 private:
  YAML::Node at(const std::string& key) const;
  std::string full(const std::string& key) const { return name_.empty() ? key : name_ + "." + key; }
  [[noreturn]] void fail_node(const YAML::Node& node, const std::string& field, const std::string& expectation) const;
  std::string text_of(const YAML::Node& node, const std::string& field) const;
  double number(const YAML::Node& node, const std::string& field, const std::string& expectation) const;

  std::shared_ptr<const YAML::Node> node_;
  std::filesystem::path file_;
  std::string name_;
};

/// Every fact has one source: throws when parts, cells and run_by give a name twice, or one that the reader gives.
void require_distinct_facts(const Section& root, const SourceDescription& source);

}  // namespace opponens::storage
