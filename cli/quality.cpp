// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/quality.hpp"

#include <array>
#include <cstdio>

#include "cli/commands.hpp"
#include "cli/contact_cases.hpp"
#include "cli/json.hpp"
#include "grasp/certificate.hpp"
#include "grasp/task_wrench.hpp"

namespace opponens::cli {
namespace {

using grasp::Matrix6Xd;

constexpr int kClosePyramid = 64;  // edges: within 0.12 % of the round cone

const char* norm_name(WrenchNorm norm) { return norm == WrenchNorm::l1 ? "L1" : "Linf"; }

const char* state_name(ClosureState state) {
  constexpr std::array names = {"force_closure", "not_force_closure", "rank_deficient", "below_incumbent"};
  return names[static_cast<std::size_t>(state)];
}

Json convention_json(const QualityConvention& convention) {
  constexpr std::array models = {"frictionless", "point_with_friction", "soft_finger"};
  const bool pyramid = convention.cone == FrictionCone::pyramid;
  return {{"model", models[static_cast<std::size_t>(convention.model)]},
          {"cone", pyramid ? "pyramid" : "quadratic"},
          {"edges", grasp::edges_per_contact(convention)},
          {"unit", convention.unit == ForceUnit::normal ? "normal" : "force"},
          {"mu", convention.mu},
          {"rho_mm", 1e3 * convention.rho},
          {"torsion_radius_mm", 1e3 * convention.torsion_radius},
          {"cog_mm", array(1e3 * convention.origin)}};
}

Json certificate_json(const Certificate& certificate) {
  Json edges = Json::array();
  for (const CertificateEdge& edge : certificate.edges) {
    edges.push_back({{"contact", edge.contact},
                     {"force", array(edge.force)},
                     {"torsion", edge.torsion},
                     {"coefficient", edge.coefficient}});
  }
  return edges;
}

/// A certificate lies inside the round cones whatever edges it uses: where those of l* do not reach, closer ones may.
std::optional<Certificate> certificate_of(const ContactCase& one, bool closed) {
  if (one.contacts.empty()) return std::nullopt;
  auto certificate = grasp::certify(one.contacts, one.convention);
  const bool round = one.convention.cone == FrictionCone::quadratic && one.convention.edges < kClosePyramid;
  if (certificate || !closed || !round) return certificate;
  QualityConvention closer = one.convention;
  closer.edges = kClosePyramid;
  return grasp::certify(one.contacts, closer);
}

/// Factor of the loads, which of them it belongs to, and the contact force (total: L1; each: Linf) that it takes.
Json task_json(const grasp::WrenchSpace& space, const Matrix6Xd& loads, double gap) {
  const grasp::TaskQuality task = grasp::task_quality(space, loads, space.curved() ? gap : 0.0);
  const double factor = task.least.factor;
  return {{"factor", factor},
          {"upper", number(task.least.upper)},
          {"limiting", task.limiting},
          {"force_n", factor > 0.0 ? Json(1.0 / factor) : Json(nullptr)},
          {"converged", task.least.converged}};
}

void add_tasks(Json& result, const ContactCase& one, const QualityConvention& convention, double gap) {
  const TaskInput& task = one.task;
  if (one.contacts.empty() || (task.down.empty() && task.disturbances.empty())) return;
  const grasp::WrenchSpace space(one.contacts, convention);
  Matrix6Xd loads(6, static_cast<Eigen::Index>(task.down.size()));
  for (std::size_t i = 0; i < task.down.size(); ++i) {
    loads.col(static_cast<Eigen::Index>(i)) =
        grasp::load_against_gravity(task.mass, task.p_OM, task.down[i], convention);
  }
  if (loads.cols() > 0) result["gravity"] = task_json(space, loads, gap);
  loads.resize(6, static_cast<Eigen::Index>(task.disturbances.size()));
  for (std::size_t i = 0; i < task.disturbances.size(); ++i) {
    const auto& [force, torque] = task.disturbances[i];
    loads.col(static_cast<Eigen::Index>(i)) = grasp::load_against(force, torque, convention);
  }
  if (loads.cols() > 0) result["disturbances"] = task_json(space, loads, gap);
}

std::string decimal(const Json& value) {
  if (!value.is_number()) return "none";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value.get<double>());
  return text.data();
}

void say(const Json& result, const Console& console) {
  std::string state = result["state"];
  for (char& c : state) c = c == '_' ? ' ' : c;
  std::array<char, 64> head{};
  std::snprintf(head.data(), head.size(), "  %-4s  %-17s", result["norm"].get<std::string>().c_str(), state.c_str());
  std::string line = head.data();
  line += "  epsilon " + decimal(result["epsilon"]) + "  l* " + decimal(result["min_weight"]);
  if (result["volume"].is_number()) line += "  volume " + decimal(result["volume"]);
  if (result["certified"].is_boolean()) line += result["certified"].get<bool>() ? "  certified" : "  no certificate";
  for (const char* const task : {"gravity", "disturbances"}) {
    if (!result.contains(task)) continue;
    const Json& force = result[task]["force_n"];
    line += std::string("  ") + task + (force.is_number() ? " held by " + decimal(force) + " N" : " not held");
  }
  console.say(line);
}

Json score(const ContactCase& one, const QualityOptions& options, const Console& console) {
  Json results = Json::array();
  std::optional<Certificate> certificate;
  bool asked = false;
  for (const WrenchNorm norm : one.norms) {
    QualityConvention convention = one.convention;
    convention.norm = norm;
    const GraspQuality quality =
        grasp::evaluate(one.contacts, convention, {options.volume, options.at_least, options.quadratic_gap});
    // Closure does not depend on the norm; a quality that was given up does not tell it.
    if (!asked && quality.state != ClosureState::below_incumbent) {
      certificate = certificate_of(one, quality.force_closure());
      asked = true;
    }
    Json result = {{"norm", norm_name(norm)},
                   {"epsilon", number(quality.epsilon)},
                   {"epsilon_gap", quality.epsilon ? Json(quality.epsilon_gap) : Json(nullptr)},
                   {"volume", number(quality.volume)},
                   {"min_weight", number(quality.min_weight)},
                   {"force_closure", quality.force_closure()},
                   {"certified", certificate.has_value()},
                   {"state", state_name(quality.state)},
                   {"direction", quality.direction.isZero(0.0) ? Json(nullptr) : array(quality.direction)}};
    if (options.certificate) result["certificate"] = certificate ? certificate_json(*certificate) : Json(nullptr);
    add_tasks(result, one, convention, options.quadratic_gap);
    say(result, console);
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace

int quality(const QualityOptions& options, const Console& console) {
  const std::vector<ContactCase> cases = read_contact_cases(options.file, options);
  Json list = Json::array();
  Progress progress(console, "quality");
  for (const ContactCase& one : cases) {
    console.say(one.name + ", " + std::to_string(one.contacts.size()) + " contacts");
    list.push_back({{"name", one.name},
                    {"contacts", one.contacts.size()},
                    {"convention", convention_json(one.convention)},
                    {"results", score(one, options, console)}});
    progress.update(static_cast<std::int64_t>(list.size()), static_cast<std::int64_t>(cases.size()));
  }
  Json result = document("quality");
  result["file"] = options.file.string();
  result["cases"] = std::move(list);
  console.document(result.dump());
  return kDone;
}

}  // namespace opponens::cli
