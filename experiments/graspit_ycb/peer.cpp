// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/graspit_ycb/peer.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace opponens::experiments {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::stringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) {
    if (!field.empty() && field.back() == '\r') field.pop_back();  // lines end as on another system
    fields.push_back(field);
  }
  return fields;
}

std::vector<double> numbers(const std::string& text) {
  std::vector<double> values;
  std::stringstream stream(text);
  for (double value = 0.0; stream >> value;) values.push_back(value);
  return values;
}

}  // namespace

std::map<std::string, PeerResult> read_peer(const std::filesystem::path& csv) {
  std::ifstream file(csv);
  std::string line;
  if (!std::getline(file, line)) throw std::runtime_error(csv.string() + ": cannot be read");
  const std::vector<std::string> header = split(line);
  const auto column = [&](const std::string& name) {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end()) throw std::runtime_error(csv.string() + ": no column " + name);
    return static_cast<std::size_t>(found - header.begin());
  };
  const std::size_t object = column("object");
  const std::size_t method = column("method");
  const std::size_t qhull = column("eps_top5_qt");
  const std::size_t face = column("eps_top5_facenormal");
  std::map<std::string, PeerResult> results;
  while (std::getline(file, line)) {
    const std::vector<std::string> fields = split(line);
    if (fields.size() <= std::max(qhull, face) || fields[method] != "random_preshape") continue;
    results[fields[object]] = {numbers(fields[face]), numbers(fields[qhull])};
  }
  return results;
}

}  // namespace opponens::experiments
