// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "contact_sets.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <nlohmann/json.hpp>

#include "core/rng.hpp"

namespace opponens {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const fs::path kReference = fs::path(OPPONENS_SHARED_DATA) / "reference";

Eigen::Vector3d vector(const json& j) { return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()}; }

std::vector<Contact> contacts_of(const json& list, const char* normal, double mu) {
  std::vector<Contact> contacts;
  for (const json& c : list) contacts.push_back({"", vector(c["p"]) * 1e-3, vector(c[normal]).normalized(), mu});
  return contacts;
}

QualityConvention convention_of(const json& j) {
  QualityConvention convention;
  convention.mu = j["mu"];
  convention.edges = j["edges"];
  convention.rho = j["rho_mm"].get<double>() * 1e-3;
  convention.origin = vector(j["cog_mm"]) * 1e-3;
  return convention;
}

}  // namespace

ContactSet cylinder_of_eighteen() {
  Rng rng(1);
  ContactSet set{"cylinder18", {}, {}};
  set.convention.rho = 0.06;
  for (int i = 0; i < 18; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i % 6) / 6.0 + 0.1 * rng.normal();
    const Eigen::Vector3d inward(-std::cos(angle), -std::sin(angle), 0.0);
    const Eigen::Vector3d off(rng.normal(), rng.normal(), rng.normal());
    const Eigen::Vector3d p = -0.04 * inward + Eigen::Vector3d(0.0, 0.0, 0.03 * (i / 6 - 1));
    set.contacts.push_back({"", p, (inward + 0.17 * off).normalized(), 0.5});
  }
  return set;
}

std::vector<ContactSet> reference_sets_of_eighteen() {
  std::vector<ContactSet> sets;
  std::ifstream file(kReference / "graspit_quality_cases.json");
  if (!file) return sets;
  const json document = json::parse(file);
  for (const json& c : document["cases"]) {
    if (c["contacts"].size() != 18 || c["edges"] != 8 || c["model"] != "pcwf") continue;
    sets.push_back({c["name"], contacts_of(c["contacts"], "n_into_object", c["mu"]), convention_of(c)});
  }
  return sets;
}

std::vector<ContactSet> allegro_sets() {
  std::vector<ContactSet> sets;
  const fs::path folder = kReference / "graspit_ycb_top5";
  if (!fs::exists(folder)) return sets;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    const json document = json::parse(std::ifstream(file));
    for (const json& grasp : document["grasps"]) {
      sets.push_back(
          {file.stem().string(), contacts_of(grasp["contacts"], "n", document["mu"]), convention_of(document)});
    }
  }
  return sets;
}

}  // namespace opponens
