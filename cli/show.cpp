// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <set>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/stored.hpp"

namespace opponens::cli {
namespace {

constexpr std::size_t kShort = 12;  // digits of an id for a person

Json field_json(const storage::Field& field) {
  return std::visit(
      [](const auto& value) -> Json {
        using T = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<T, Eigen::VectorXd>) {
          return array(value);
        } else if constexpr (std::is_same_v<T, Eigen::MatrixXd>) {
          return rows(value);
        } else if constexpr (std::is_same_v<T, double>) {
          return number(value);
        } else {
          return value;
        }
      },
      field);
}

Json record_json(const std::string& id, const storage::Record& record) {
  Json fields = Json::object();
  for (const auto& [name, field] : record.fields) fields[name] = field_json(field);
  const auto& origin = record.provenance;
  return {{"id", id},
          {"kind", record.kind},
          {"name", record.name},
          {"provenance",
           {{"command", origin.command},
            {"inputs", origin.inputs},
            {"files", origin.files},
            {"parameters", parameters_of(record)},
            {"seed", origin.seed},
            {"program_version", origin.program_version}}},
          {"fields", fields}};
}

std::string line_of(const storage::Record& record, const std::string& id) {
  return id.substr(0, kShort) + "  " + record.kind + "  " + record.name + "  (" + record.provenance.command + " " +
         record.provenance.parameters + ", seed " + std::to_string(record.provenance.seed) + ")";
}

int list_store(const storage::Store& store, const Console& console) {
  Json objects = Json::array();
  for (const auto& entry : store.list()) {
    console.say(entry.id.substr(0, kShort) + "  " + entry.kind + "  " + entry.name);
    objects.push_back({{"id", entry.id}, {"kind", entry.kind}, {"name", entry.name}, {"file", entry.file}});
  }
  Json result = document("show");
  result["objects"] = objects;
  console.document(result.dump());
  return kDone;
}

/// Prints the chain depth first, each object once; many inputs of one kind are counted after the first.
void print_chain(const storage::Store& store, const std::string& id, int depth, std::set<std::string>& seen,
                 const Console& console, Json& chain) {
  if (!seen.insert(id).second) return;
  const auto record = store.read(id);
  console.say(std::string(static_cast<std::size_t>(2 * depth), ' ') + line_of(record, id));
  chain.push_back({{"id", id},
                   {"kind", record.kind},
                   {"name", record.name},
                   {"command", record.provenance.command},
                   {"depth", depth},
                   {"inputs", record.provenance.inputs}});
  for (const auto& input : record.provenance.inputs) print_chain(store, input, depth + 1, seen, console, chain);
}

}  // namespace

int show(const ShowOptions& options, const Console& console) {
  const storage::Store store(options.common.store, false);
  if (options.id.empty()) return list_store(store, console);
  const auto record = store.read(options.id);
  const std::string id = storage::content_hash(record);
  console.say(record_json(id, record).dump(2));
  Json result = document("show");
  result["object"] = record_json(id, record);
  console.document(result.dump());
  return kDone;
}

int why(const ShowOptions& options, const Console& console) {
  const storage::Store store(options.common.store, false);
  const std::string id = storage::content_hash(store.read(options.id));
  std::set<std::string> seen;
  Json chain = Json::array();
  print_chain(store, id, 0, seen, console, chain);
  Json result = document("why");
  result["chain"] = chain;
  console.document(result.dump());
  return kDone;
}

}  // namespace opponens::cli
