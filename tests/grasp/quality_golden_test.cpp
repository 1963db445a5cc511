// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Golden values: contact sets with what GraspIt! and qhull compute for them, read from the shared reference data.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "grasp/quality.hpp"

namespace opponens::grasp {
namespace {

using nlohmann::json;

Eigen::Vector3d vector(const json& j) { return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()}; }

QualityConvention convention_of(const json& c, const std::string& norm) {
  QualityConvention convention;
  convention.model = c["model"] == "soft" ? ContactModel::soft_finger : ContactModel::point_with_friction;
  convention.mu = c["mu"];
  convention.edges = c["edges"];
  convention.rho = c["rho_mm"].get<double>() * 1e-3;
  convention.torsion_radius = c["torsion_radius_mm"].get<double>() * 1e-3;
  convention.origin = vector(c["cog_mm"]) * 1e-3;
  convention.norm = norm == "L1" ? WrenchNorm::l1 : WrenchNorm::linf;
  return convention;
}

void compare_l1(const GraspQuality& quality, const json& clean) {
  if (!clean["ok"].get<bool>()) {
    EXPECT_EQ(quality.state, ClosureState::rank_deficient);
    return;
  }
  const double offset = clean["min_offset"];
  if (offset > 0.0) {
    EXPECT_EQ(quality.state, ClosureState::force_closure);
    EXPECT_NEAR(quality.epsilon.value(), offset, 1e-6 * offset);
  } else {
    // The least offset is the distance to one facet's plane; the distance to the hull is at least that.
    EXPECT_EQ(quality.state, ClosureState::not_force_closure);
    EXPECT_LE(quality.epsilon.value(), offset + 1e-9);
    EXPECT_LT(quality.min_weight.value(), 0.0);
  }
  EXPECT_NEAR(quality.volume.value() / clean["volume"].get<double>(), 1.0, 1e-4);
}

TEST(QualityGolden, GraspItCases) {
  const std::filesystem::path file =
      std::filesystem::path(OPPONENS_SHARED_DATA) / "reference/graspit_quality_cases.json";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no reference data at " << file;
  const json document = json::parse(std::ifstream(file));
  int closures = 0;
  for (const json& c : document["cases"]) {
    SCOPED_TRACE(c["name"].get<std::string>());
    std::vector<Contact> contacts;
    for (const json& k : c["contacts"]) {
      contacts.push_back({"", vector(k["p"]) * 1e-3, vector(k["n_into_object"]).normalized(), c["mu"]});
    }
    for (const json& result : c["results"]) {
      const GraspQuality quality = evaluate(contacts, convention_of(c, result["norm"]), {true});
      closures += quality.force_closure();
      if (result["norm"] == "L1") {
        compare_l1(quality, result["qhull_Qt"]);
      } else if (result["graspit"]["epsilon"].get<double>() > 0.0) {
        const double epsilon = result["graspit"]["epsilon"];
        EXPECT_NEAR(quality.epsilon.value(), epsilon, 1e-6 * epsilon);
        EXPECT_NEAR(quality.volume.value() / result["graspit"]["volume"].get<double>(), 1.0, 1e-4);
      } else {
        EXPECT_NE(quality.state, ClosureState::force_closure);
      }
    }
  }
  EXPECT_GT(closures, 20);
}

}  // namespace
}  // namespace opponens::grasp
