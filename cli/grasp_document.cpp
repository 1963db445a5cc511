// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/grasp_document.hpp"

#include <cstddef>

#include "cli/records.hpp"
#include "cli/stored.hpp"
#include "core/grasp.hpp"
#include "core/require.hpp"
#include "grasp/quality.hpp"
#include "storage/codec.hpp"

namespace opponens::cli {
namespace {

/// Contacts with the wrenches of their edges, in the order in which the quality counts them.
Json contacts_with_wrenches(const Grasp& grasp) {
  Json result = Json::array();
  if (grasp.contacts.empty()) return result;
  const auto wrenches = grasp::contact_wrenches(grasp.contacts, grasp.quality.convention);
  const auto each = wrenches.cols() / static_cast<Eigen::Index>(grasp.contacts.size());
  for (std::size_t i = 0; i < grasp.contacts.size(); ++i) {
    const Contact& contact = grasp.contacts[i];
    const auto own = wrenches.middleCols(static_cast<Eigen::Index>(i) * each, each);
    result.push_back({{"link", contact.link},
                      {"p", array(contact.p_OC)},
                      {"n", array(contact.n_O)},
                      {"mu", number(contact.mu)},
                      {"wrenches", rows(own.transpose())}});
  }
  return result;
}

/// The stored fields of that prefix, without it.
Json fields_below(const Json& fields, const std::string& prefix) {
  Json result = Json::object();
  for (const auto& [name, value] : fields.items()) {
    if (name.rfind(prefix, 0) == 0) result[name.substr(prefix.size())] = value;
  }
  return result;
}

Json contacts_json(const std::vector<Contact>& contacts) {
  Json result = Json::array();
  for (const Contact& contact : contacts) {
    result.push_back(
        {{"link", contact.link}, {"p", array(contact.p_OC)}, {"n", array(contact.n_O)}, {"mu", number(contact.mu)}});
  }
  return result;
}

Json robust_json(const std::optional<RobustQuality>& robust) {
  if (!robust) return nullptr;
  return {{"force_closure", robust->force_closure},
          {"interval", {robust->force_closure_low, robust->force_closure_high}},
          {"epsilon_mean", robust->epsilon_mean},
          {"epsilon_low", robust->epsilon_low},
          {"noise",
           {{"position", robust->noise.position},
            {"angle", robust->noise.angle},
            {"friction", robust->noise.friction},
            {"samples", robust->noise.samples}}}};
}

}  // namespace

Json grasp_json(const std::string& id, const Grasp& grasp, const std::vector<std::string>& joints) {
  return {{"id", id},
          {"group", grasp.group},
          {"force_closure", grasp.quality.force_closure()},
          {"certified", grasp.certificate.has_value()},
          {"epsilon", number(grasp.quality.epsilon)},
          {"min_weight", number(grasp.quality.min_weight)},
          {"robust", robust_json(grasp.robust)},
          {"origin", grasp.origin == GraspOrigin::imported ? "imported" : "searched"},
          {"slack", grasp.slack.norm()},
          {"synergy_grasp", grasp.synergy_grasp},
          {"X_OH", pose(grasp.X_OH)},
          {"X_OH_pregrasp", pose(grasp.X_OH_pregrasp)},
          {"joints", by_name(joints, grasp.q_grasp)},
          {"pregrasp", by_name(joints, grasp.q_pregrasp)},
          {"arm_solutions", grasp.arm_solutions.size()},
          {"contacts", contacts_json(grasp.contacts)}};
}

const std::vector<std::string>* GraspDocuments::joints_of(const storage::Record& record) {
  if (record.provenance.inputs.empty()) return nullptr;
  const std::string& set = record.provenance.inputs.front();
  const auto known = joints_.find(set);
  if (known != joints_.end()) return known->second.empty() ? nullptr : &known->second;
  std::vector<std::string>& names = joints_[set];
  for (const auto& entry : store_.list(kSynergySet)) {
    if (entry.id == set) names = storage::decode_synergy_set(store_.read(set)).joint_names;
  }
  return names.empty() ? nullptr : &names;
}

std::optional<Json> GraspDocuments::of(const std::string& id, const storage::Record& record) {
  const std::vector<std::string>* joints = joints_of(record);
  if (joints == nullptr) return std::nullopt;
  const Grasp grasp = storage::decode_grasp(record);
  if (static_cast<Eigen::Index>(joints->size()) != grasp.q_grasp.size()) {
    throw InputError("grasp '" + id + "' has " + std::to_string(grasp.q_grasp.size()) +
                     " joints, the synergies that it names as its input " + std::to_string(joints->size()));
  }
  const Json world = parameters_of(record).value("world", Json::object());
  const Json fields = record_json(id, record).at("fields");
  Json result = grasp_json(id, grasp, *joints);
  result.update({{"object", world.value("object", "")},
                 {"robot", world.value("robot", "")},
                 {"scene", world.value("scene", "")},
                 {"synergies", record.provenance.inputs.front()},
                 {"state", fields.at("quality.state")},
                 {"epsilon_gap", number(grasp.quality.epsilon_gap)},
                 {"volume", number(grasp.quality.volume)},
                 {"convention", fields_below(fields, "convention.")},
                 {"contacts", contacts_with_wrenches(grasp)}});
  return result;
}

}  // namespace opponens::cli
