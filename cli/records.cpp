// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/records.hpp"

#include <array>
#include <cstdio>
#include <type_traits>
#include <variant>

#include "cli/json.hpp"
#include "cli/stored.hpp"

namespace opponens::cli {
namespace {

constexpr std::size_t kShownText = 200;
constexpr Eigen::Index kShownValues = 8;
constexpr std::size_t kShownInputs = 5;

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

std::string short_number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.5g", value);
  return text.data();
}

template <typename Derived>
std::string range(const Eigen::DenseBase<Derived>& values) {
  if (values.size() == 0) return "empty";
  return short_number(values.minCoeff()) + " to " + short_number(values.maxCoeff());
}

/// Cut at a whole character.
std::string shortened(const std::string& text) {
  if (text.size() <= kShownText) return text;
  std::size_t end = kShownText;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + "... (" + std::to_string(text.size()) + " bytes)";
}

struct FieldText {
  std::string operator()(double value) const { return short_number(value); }
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(const std::string& value) const { return shortened(value); }
  std::string operator()(const std::vector<std::string>& values) const {
    std::string text;
    for (const auto& value : values) text.append(text.empty() ? "" : " ").append(value);
    return std::string("[").append(std::to_string(values.size())).append("] ").append(shortened(text));
  }
  std::string operator()(const Eigen::VectorXd& values) const {
    std::string text = std::string("[").append(std::to_string(values.size())).append("]");
    if (values.size() > kShownValues) return text.append(" ").append(range(values));
    for (const double value : values) text.append(" ").append(short_number(value));
    return text;
  }
  std::string operator()(const Eigen::MatrixXd& values) const {
    return std::string("[")
        .append(std::to_string(values.rows()))
        .append(" x ")
        .append(std::to_string(values.cols()))
        .append("] ")
        .append(range(values));
  }
};

}  // namespace

std::string short_id(const std::string& id) { return id.substr(0, kShortId); }

Json record_json(const std::string& id, const storage::Record& record) {
  Json fields = Json::object();
  for (const auto& [name, field] : record.fields) fields[name] = field_json(field);
  const auto& origin = record.provenance;
  // Objects of others need not have parameters in JSON.
  Json parameters = Json::parse(origin.parameters, nullptr, false);
  if (parameters.is_discarded()) parameters = origin.parameters;
  return {{"id", id},
          {"kind", record.kind},
          {"name", record.name},
          {"provenance",
           {{"command", origin.command},
            {"inputs", origin.inputs},
            {"files", origin.files},
            {"parameters", parameters},
            {"seed", origin.seed},
            {"program_version", origin.program_version}}},
          {"fields", fields}};
}

Json entry_json(const storage::IndexEntry& entry) {
  return {{"id", entry.id}, {"kind", entry.kind}, {"name", entry.name}};
}

std::vector<std::string> record_lines(const std::string& id, const storage::Record& record) {
  const auto& origin = record.provenance;
  std::vector<std::string> lines{record.kind + "  " + record.name, "  id          " + id,
                                 "  made by     " + origin.command + ", program " + origin.program_version + ", seed " +
                                     std::to_string(origin.seed),
                                 "  parameters  " + shortened(origin.parameters)};
  for (std::size_t i = 0; i < origin.inputs.size(); ++i) {
    if (i == kShownInputs) {
      lines.push_back("  made from   " + std::to_string(origin.inputs.size() - i) + " more objects");
      break;
    }
    lines.push_back("  made from   " + short_id(origin.inputs[i]));
  }
  for (const auto& [file, hash] : origin.files) lines.push_back("  file        " + file + "  " + short_id(hash));
  for (const auto& [name, field] : record.fields) {
    std::string line = "  " + name;
    line.resize(std::max<std::size_t>(line.size() + 2, 30), ' ');
    lines.push_back(line + std::visit(FieldText{}, field));
  }
  return lines;
}

}  // namespace opponens::cli
