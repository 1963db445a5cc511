// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/export_grasps.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>

#include "cli/stored.hpp"

namespace opponens::cli {
namespace {

constexpr std::array<const char*, 8> kFirstColumns{"id",      "group",      "object",        "state",
                                                   "epsilon", "min_weight", "synergy_grasp", "slack"};

/// A value of a document as the text of a cell; null is an empty one.
std::string cell_of(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_boolean()) return value.get<bool>() ? "1" : "0";
  if (value.is_string()) return cell(value.get<std::string>());
  if (value.is_number_integer()) return std::to_string(value.get<std::int64_t>());
  std::string text;
  append_number(text, value.get<double>());
  return text;
}

void flatten(const std::string& name, const Json& value, std::vector<std::pair<std::string, std::string>>& row) {
  if (value.is_object()) {
    for (const auto& [key, inner] : value.items()) flatten(name.empty() ? key : name + "." + key, inner, row);
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) flatten(name + "." + std::to_string(i), value[i], row);
  } else {
    row.emplace_back(name, cell_of(value));
  }
}

void append_cells(std::string& line, const Json& numbers) {
  for (const Json& value : numbers) line.append(",").append(cell_of(value));
}

}  // namespace

void GraspTables::add(const Json& document) {
  const std::string id = cell_of(document.at("id"));
  std::size_t contact_number = 0;
  for (const Json& contact : document.at("contacts")) {
    const std::string key = id + "," + std::to_string(++contact_number);
    std::string line = key + "," + cell_of(contact.at("link"));
    append_cells(line, contact.at("p"));
    append_cells(line, contact.at("n"));
    contacts_.append(line).append(",").append(cell_of(contact.at("mu"))).append("\n");
    std::size_t edge = 0;
    for (const Json& wrench : contact.at("wrenches")) {
      std::string edge_line = key + "," + std::to_string(++edge);
      append_cells(edge_line, wrench);
      wrenches_.append(edge_line).append("\n");
    }
  }
  Json values = document;
  values["contacts"] = contact_number;
  flatten("", values, grasps_.emplace_back());
}

void GraspTables::write_to(TableFolder& folder) const {
  if (grasps_.empty()) return;
  std::vector<std::string> columns(kFirstColumns.begin(), kFirstColumns.end());
  std::map<std::string, std::size_t> place;
  for (std::size_t i = 0; i < columns.size(); ++i) place[columns[i]] = i;
  for (const auto& row : grasps_) {
    for (const auto& [column, value] : row) {
      if (place.try_emplace(column, columns.size()).second) columns.push_back(column);
    }
  }
  std::string text;
  for (const auto& column : columns) text.append(text.empty() ? "" : ",").append(cell(column));
  text += '\n';
  for (const auto& row : grasps_) {
    std::vector<std::string> cells(columns.size());
    for (const auto& [column, value] : row) cells[place.at(column)] = value;
    for (std::size_t i = 0; i < cells.size(); ++i) text.append(i == 0 ? "" : ",").append(cells[i]);
    text += '\n';
  }
  folder.write("grasps.csv", text, {{"kind", kGrasp}, {"name", "grasps"}});
  folder.write("contacts.csv", "grasp,contact,link,p_x,p_y,p_z,n_x,n_y,n_z,mu\n" + contacts_,
               {{"kind", kGrasp}, {"name", "contacts"}});
  folder.write("wrenches.csv", "grasp,contact,edge,f_x,f_y,f_z,t_x,t_y,t_z\n" + wrenches_,
               {{"kind", kGrasp}, {"name", "wrenches"}});
}

}  // namespace opponens::cli
