// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/production_order.hpp"

#include <algorithm>
#include <compare>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <sstream>
#include <utility>

namespace opponens::storage {
namespace {

using nlohmann::json;

/// When an object was made: after how many others were written, then by line of the log, then by place in its commit.
struct Moment {
  std::size_t after = 0;
  std::size_t line = 0;  ///< 0: when its file was written
  std::size_t place = 0;
  auto operator<=>(const Moment&) const = default;
};

struct Production {
  std::vector<std::string> ids;
  std::string after;
};

std::optional<Production> read_line(const std::string& line) {
  const json document = json::parse(line, nullptr, false);
  if (!document.is_object() || !document.contains("produced")) return std::nullopt;
  try {
    return Production{document.at("produced"), document.at("after")};
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

}  // namespace

std::string production_line(const std::vector<std::string>& ids, const std::string& after) {
  return json{{"produced", ids}, {"after", after}}.dump();
}

std::vector<IndexEntry> in_order_of_production(std::vector<IndexEntry> entries, const std::string& run_log) {
  std::map<std::string, std::size_t> position;
  std::vector<Moment> moments;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    position[entries[i].id] = i;
    moments.push_back({i, 0, 0});
  }
  std::istringstream lines(run_log);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::optional<Production> production = read_line(line);
    if (!production || !position.contains(production->after)) continue;
    for (std::size_t i = 0; i < production->ids.size(); ++i) {
      const auto found = position.find(production->ids[i]);
      if (found == position.end()) continue;
      Moment& moment = moments[found->second];
      moment = std::max(moment, Moment{position.at(production->after), number, i});
    }
  }
  std::vector<std::size_t> order(entries.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return moments[a] < moments[b]; });
  std::vector<IndexEntry> result;
  for (const std::size_t i : order) result.push_back(std::move(entries[i]));
  return result;
}

}  // namespace opponens::storage
