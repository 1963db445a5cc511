// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/contact_cases.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "cli/json.hpp"
#include "core/require.hpp"

namespace opponens::cli {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

/// One object of the file with what stands around it: a field that it lacks is looked for further out.
class Fields {
 public:
  Fields(const Json& object, std::string path, const Fields* around)
      : object_(object), path_(std::move(path)), around_(around) {
    if (!object.is_object()) fail(path_, object, "an object");
  }

  const Json* find(const std::string& name) const {
    for (const Fields* at = this; at != nullptr; at = at->around_) {
      if (const auto found = at->object_.find(name); found != at->object_.end()) return &*found;
    }
    return nullptr;
  }
  const Json* own(const std::string& name) const {
    const auto found = object_.find(name);
    return found != object_.end() ? &*found : nullptr;
  }
  std::string path(const std::string& name) const { return path_ + (path_.back() == ':' ? " " : ".") + name; }

  [[noreturn]] static void fail(const std::string& path, const Json& found, const std::string& expected) {
    std::string text = found.dump();
    if (text.size() > 80) text = text.substr(0, 80) + "...";
    throw InputError(path + ": expected " + expected + ", found " + text);
  }

  double number(const std::string& name, double otherwise, double least, double most,
                const std::string& expected) const {
    const Json* const value = find(name);
    if (value == nullptr) return otherwise;
    if (!value->is_number()) fail(path(name), *value, expected);
    const double number = value->get<double>();
    if (!(number >= least && number <= most)) fail(path(name), *value, expected);
    return number;
  }

  template <typename Enum>
  Enum word(const std::string& name, Enum otherwise, const std::map<std::string, Enum>& words) const {
    const Json* const value = find(name);
    if (value == nullptr) return otherwise;
    const auto found = value->is_string() ? words.find(value->get<std::string>()) : words.end();
    if (found != words.end()) return found->second;
    std::vector<std::string> names;
    for (const auto& [text, unused] : words) names.push_back(text);
    fail(path(name), *value, "one of " + joined(names));
  }

 private:
  const Json& object_;
  std::string path_;
  const Fields* around_;
};

Vector3d vector_of(const Json& value, const std::string& path, const std::string& unit) {
  const bool numbers =
      value.is_array() && value.size() == 3 && value[0].is_number() && value[1].is_number() && value[2].is_number();
  if (!numbers) Fields::fail(path, value, "3 numbers" + unit);
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

Vector3d direction_of(const Json& value, const std::string& path) {
  const Vector3d direction = vector_of(value, path, "");
  if (!(direction.norm() > 0.0)) Fields::fail(path, value, "a direction, not zero");
  return direction.normalized();
}

const std::map<std::string, ContactModel> kModels{
    {"frictionless", ContactModel::frictionless}, {"pcwf", ContactModel::point_with_friction},
    {"point", ContactModel::point_with_friction}, {"point_with_friction", ContactModel::point_with_friction},
    {"soft", ContactModel::soft_finger},          {"soft_finger", ContactModel::soft_finger}};
const std::map<std::string, ForceUnit> kForceUnits{{"normal", ForceUnit::normal}, {"force", ForceUnit::force}};
const std::map<std::string, FrictionCone> kCones{{"pyramid", FrictionCone::pyramid},
                                                 {"quadratic", FrictionCone::quadratic}};

QualityConvention convention_of(const Fields& fields, const QualityOptions& options) {
  QualityConvention convention;
  convention.model =
      options.model.empty() ? fields.word("model", convention.model, kModels) : kModels.at(options.model);
  convention.unit =
      options.unit.empty() ? fields.word("unit", convention.unit, kForceUnits) : kForceUnits.at(options.unit);
  convention.cone = options.cone.empty() ? fields.word("cone", convention.cone, kCones) : kCones.at(options.cone);
  convention.mu = options.mu.value_or(fields.number("mu", convention.mu, 0.0, 1e6, "a friction coefficient >= 0"));
  const std::string whole = "a whole number from 3 to 1024";
  const double edges = fields.number("edges", convention.edges, 3.0, 1024.0, whole);
  if (edges != std::floor(edges)) Fields::fail(fields.path("edges"), edges, whole);
  convention.edges = options.edges.value_or(static_cast<int>(edges));
  const double rho = fields.number("rho_mm", 1e3 * convention.rho, 1e-9, 1e12, "a length in mm > 0");
  convention.rho = 1e-3 * rho;
  const bool soft = convention.model == ContactModel::soft_finger;
  const std::string radius = "a length in mm > 0, which a soft finger needs";
  if (soft && fields.find("torsion_radius_mm") == nullptr)
    Fields::fail(fields.path("torsion_radius_mm"), nullptr, radius);
  if (soft) convention.torsion_radius = 1e-3 * fields.number("torsion_radius_mm", 0.0, 1e-9, 1e12, radius);
  if (const Json* const cog = fields.find("cog_mm")) {
    convention.origin = 1e-3 * vector_of(*cog, fields.path("cog_mm"), " (mm)");
  }
  return convention;
}

std::vector<Contact> contacts_of(const Fields& fields, const QualityConvention& convention, bool given_friction) {
  const Json* const list = fields.own("contacts");
  if (list == nullptr || !list->is_array()) {
    Fields::fail(fields.path("contacts"), list == nullptr ? Json(nullptr) : *list,
                 "a list of contacts {p, n_into_object}");
  }
  std::vector<Contact> contacts;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string path = fields.path("contacts[" + std::to_string(i) + "]");
    const Fields contact((*list)[i], path, nullptr);
    const std::string normal = contact.own("n_into_object") == nullptr ? "n" : "n_into_object";
    if (contact.own("p") == nullptr) Fields::fail(path + ".p", nullptr, "3 numbers (mm)");
    if (contact.own(normal) == nullptr) Fields::fail(path + ".n_into_object", nullptr, "3 numbers");
    const Json* const link = contact.own(contact.own("link") != nullptr ? "link" : "link_name");
    const double mu = contact.number("mu", convention.mu, 0.0, 1e6, "a friction coefficient >= 0");
    contacts.push_back({link != nullptr && link->is_string() ? link->get<std::string>() : "",
                        1e-3 * vector_of(*contact.own("p"), path + ".p", " (mm)"),
                        direction_of(*contact.own(normal), path + "." + normal), given_friction ? convention.mu : mu});
  }
  return contacts;
}

TaskInput task_of(const Fields& fields, const QualityConvention& convention) {
  TaskInput task;
  task.p_OM = convention.origin;
  task.mass = fields.number("mass_kg", 0.0, 0.0, 1e9, "a mass in kg >= 0");
  if (const Json* const com = fields.find("com_mm")) {
    task.p_OM = 1e-3 * vector_of(*com, fields.path("com_mm"), " (mm)");
  }
  const Json* const down = fields.find("down");
  const std::string way = "the direction of gravity, 3 numbers, or a list of such, since there is mass_kg";
  if (task.mass > 0.0 && (down == nullptr || !down->is_array() || down->empty())) {
    Fields::fail(fields.path("down"), down == nullptr ? Json(nullptr) : *down, way);
  }
  if (task.mass > 0.0) {
    const Json several = (*down)[0].is_array() ? *down : Json::array({*down});
    for (const Json& one : several) task.down.push_back(direction_of(one, fields.path("down")));
  }
  const Json* const list = fields.find("disturbances");
  if (list == nullptr) return task;
  if (!list->is_array()) Fields::fail(fields.path("disturbances"), *list, "a list of {force, torque}");
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string path = fields.path("disturbances[" + std::to_string(i) + "]");
    const Fields wrench((*list)[i], path, nullptr);
    const Json zero = {0.0, 0.0, 0.0};
    const Json* const force = wrench.own("force");
    const Json* const torque = wrench.own("torque");
    task.disturbances.emplace_back(vector_of(force == nullptr ? zero : *force, path + ".force", " (N)"),
                                   vector_of(torque == nullptr ? zero : *torque, path + ".torque", " (N m)"));
    const auto& [f, t] = task.disturbances.back();
    if (!(f.norm() + t.norm() > 0.0)) Fields::fail(path, (*list)[i], "a force (N) or a torque (N m), not zero");
  }
  return task;
}

/// The option's norms, or those of `norm` (a word or a list), or those of the results that came with the case, or both.
std::vector<WrenchNorm> norms_of(const Fields& fields, const QualityOptions& options) {
  Json words = Json::array();
  if (!options.norm.empty()) {
    words = options.norm == "both" ? Json{"L1", "Linf"} : Json::array({options.norm});
  } else if (const Json* const norm = fields.find("norm")) {
    words = norm->is_array() ? *norm : Json::array({*norm});
  } else if (const Json* const results = fields.own("results"); results != nullptr && results->is_array()) {
    for (const Json& result : *results)
      words.push_back(result.is_object() && result.contains("norm") ? result["norm"] : Json());
  }
  if (words.empty()) words = {"L1", "Linf"};
  std::vector<WrenchNorm> norms;
  for (const Json& word : words) {
    if (word != "L1" && word != "Linf") Fields::fail(fields.path("norm"), word, "L1 or Linf");
    const WrenchNorm norm = word == "L1" ? WrenchNorm::l1 : WrenchNorm::linf;
    if (std::find(norms.begin(), norms.end(), norm) == norms.end()) norms.push_back(norm);
  }
  return norms;
}

std::string name_of(const Fields& fields, std::size_t number) {
  if (const Json* const name = fields.own("name")) return name->is_string() ? name->get<std::string>() : name->dump();
  if (const Json* const rank = fields.own("rank")) return "grasp " + rank->dump();
  return "case " + std::to_string(number + 1);
}

Json parse(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || fs::is_directory(file)) throw InputError(file.string() + ": cannot be read");
  try {
    return Json::parse(stream);
  } catch (const Json::exception& error) {
    throw InputError(file.string() + ": not JSON: " + error.what());
  }
}

}  // namespace

std::vector<ContactCase> read_contact_cases(const fs::path& file, const QualityOptions& options) {
  const Json document = parse(file);
  const Json whole = document.is_array() ? Json{{"cases", document}} : document;
  const Fields top(whole, file.string() + ":", nullptr);
  const bool grasps = top.own("cases") == nullptr && top.own("grasps") != nullptr;
  const std::string key = grasps ? "grasps" : "cases";
  const bool single = top.own(key) == nullptr && top.own("contacts") != nullptr;
  const Json alone = Json::array({whole});
  const Json* const list = single ? &alone : top.own(key);
  if (list == nullptr || !list->is_array()) {
    Fields::fail(top.path(key), list == nullptr ? Json(nullptr) : *list, "a list of contact sets");
  }
  std::vector<ContactCase> cases;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const Fields fields((*list)[i], single ? file.string() + ":" : top.path(key + "[" + std::to_string(i) + "]"), &top);
    ContactCase one{name_of(fields, i), {}, convention_of(fields, options), norms_of(fields, options), {}};
    one.contacts = contacts_of(fields, one.convention, options.mu.has_value());
    one.task = task_of(fields, one.convention);
    cases.push_back(std::move(one));
  }
  if (cases.empty()) throw InputError(top.path(key) + ": expected at least one contact set, found []");
  return cases;
}

}  // namespace opponens::cli
