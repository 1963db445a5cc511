// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Many contact sets against other methods: qhull's whole hull, and exact certificates. Release only.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <nlohmann/json.hpp>

#include "core/rng.hpp"
#include "grasp/certificate.hpp"
#include "grasp/quality.hpp"
#include "grasp/wrench_hull.hpp"
#include "random_contacts.hpp"

namespace opponens::grasp {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// OPPONENS_QUALITY_SETS sets of each kind (10,000 take a quarter of an hour); without it 500.
const int kSets = std::getenv("OPPONENS_QUALITY_SETS") == nullptr
                      ? 500
                      : std::max(50, std::atoi(std::getenv("OPPONENS_QUALITY_SETS")));

/// 4 to 20 contacts, 3 to 8 edges, either unit; torque about a point and by a scale of its own.
QualityConvention random_convention(Rng& rng) {
  QualityConvention convention;
  convention.edges = 3 + static_cast<int>(rng.index(6));
  convention.unit = static_cast<ForceUnit>(rng.index(2));
  convention.rho = rng.uniform(0.5, 2.0);
  convention.origin = 0.1 * test::random_unit(rng);
  return convention;
}

TEST(QualitySets, EpsilonOfForceClosureSetsIsQhulls) {
  Rng rng = stream(71, "closures");
  double largest_error = 0.0;
  double largest = 0.0;
  std::map<std::size_t, int> sizes;
  for (int closures = 0; closures < kSets;) {
    const QualityConvention convention = random_convention(rng);
    const auto contacts = test::random_contacts(4 + static_cast<int>(rng.index(17)), rng.uniform(0.1, 0.8), rng);
    const GraspQuality quality = evaluate(contacts, convention);
    if (!quality.force_closure()) continue;
    ++closures;
    ++sizes[contacts.size()];
    const auto hull = wrench_hull(contact_wrenches(contacts, convention));
    ASSERT_TRUE(hull.has_value());
    const double error = std::abs(*quality.epsilon - hull->least_offset);
    ASSERT_LE(error, 1e-9) << "set " << closures << ": " << *quality.epsilon << ", qhull " << hull->least_offset;
    largest_error = std::max(largest_error, error);
    largest = std::max(largest, *quality.epsilon);
  }
  EXPECT_EQ(sizes.size(), 17U);
  EXPECT_GT(largest, 0.2);
  std::printf("largest difference %.3g over %d sets of 4 to 20 contacts\n", largest_error, kSets);
}

TEST(QualitySets, SignsAndProofsNeverDisagreeOnMixedSets) {
  Rng rng = stream(72, "verdicts");
  int closures = 0;
  for (int i = 0; i < kSets; ++i) {
    const QualityConvention convention = random_convention(rng);
    const auto contacts = test::random_contacts(3 + static_cast<int>(rng.index(6)), rng.uniform(0.1, 1.5), rng);
    const GraspQuality quality = evaluate(contacts, convention);
    const bool closed = quality.force_closure();
    ASSERT_NE(quality.state, ClosureState::rank_deficient) << "set " << i;
    ASSERT_EQ(closed, *quality.epsilon > 0.0) << "set " << i << ", epsilon " << *quality.epsilon;
    ASSERT_EQ(closed, *quality.min_weight > 0.0) << "set " << i << ", l* " << *quality.min_weight;
    ASSERT_EQ(closed, certify(contacts, convention).has_value()) << "set " << i << ", epsilon " << *quality.epsilon;
    closures += closed;
  }
  EXPECT_GT(closures, kSets / 5);
  EXPECT_LT(closures, 4 * kSets / 5);
  std::printf("%d of %d are force closure\n", closures, kSets);
}

Eigen::Vector3d vector(const json& j) { return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()}; }

/// eps_top5_qt of the rows of an object: what qhull "Qt Q12" gave for the best five of the stored run.
std::vector<double> published_qt(const fs::path& csv, const std::string& object, const std::string& method, int seed) {
  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);
  std::vector<std::string> header;
  for (std::stringstream cells(line); std::getline(cells, line, ',');) header.push_back(line);
  const auto column = std::find(header.begin(), header.end(), "eps_top5_qt") - header.begin();
  while (std::getline(file, line)) {
    std::vector<std::string> row;
    std::string cell;
    for (std::stringstream cells(line); std::getline(cells, cell, ',');) row.push_back(cell);
    if (row[0] != object || row[2] != method || row[3] != std::to_string(seed)) continue;
    std::vector<double> values;
    std::stringstream numbers(row[static_cast<std::size_t>(column)]);
    for (double value = 0.0; numbers >> value;) values.push_back(value);
    return values;
  }
  return {};
}

TEST(QualitySets, AllegroGraspsOfTenObjectsAsQhullScoresThem) {
  const fs::path reference = fs::path(OPPONENS_SHARED_DATA) / "reference";
  if (!fs::exists(reference / "graspit_ycb_top5")) GTEST_SKIP() << "no reference data at " << reference;
  int sets = 0;
  double from_qhull = 0.0;
  double from_published = 0.0;
  double from_graspit = 0.0;
  for (const auto& entry : fs::directory_iterator(reference / "graspit_ycb_top5")) {
    const json document = json::parse(std::ifstream(entry.path()));
    SCOPED_TRACE(document["object"].get<std::string>());
    const auto published =
        published_qt(reference / "graspit_ycb.csv", document["object"], document["method"], document["seed"]);
    QualityConvention convention;
    convention.rho = 1e-3 * document["rho_mm"].get<double>();
    convention.origin = 1e-3 * vector(document["cog_mm"]);
    convention.edges = document["edges"];
    ASSERT_EQ(published.size(), document["grasps"].size());
    for (std::size_t i = 0; i < document["grasps"].size(); ++i) {
      const json& grasp = document["grasps"][i];
      std::vector<Contact> contacts;
      for (const json& c : grasp["contacts"]) {
        contacts.push_back({"", 1e-3 * vector(c["p"]), vector(c["n"]).normalized(), c["mu"]});
      }
      const GraspQuality quality = evaluate(contacts, convention);
      ASSERT_TRUE(quality.force_closure());
      EXPECT_TRUE(certify(contacts, convention).has_value());
      const auto hull = wrench_hull(contact_wrenches(contacts, convention));
      EXPECT_NEAR(*quality.epsilon, hull->least_offset, 1e-9);
      from_qhull = std::max(from_qhull, std::abs(*quality.epsilon - hull->least_offset));
      from_published = std::max(from_published, std::abs(*quality.epsilon - published[i]));
      from_graspit = std::max(from_graspit, std::abs(*quality.epsilon - grasp["epsilon_graspit"].get<double>()));
      ++sets;
    }
  }
  EXPECT_EQ(sets, 50);
  EXPECT_LE(from_published, 2e-6);  // six digits of the position in mm, nine of epsilon
  std::printf("largest difference from qhull %.3g, from eps_top5_qt %.3g, from GraspIt! %.3g\n", from_qhull,
              from_published, from_graspit);
}

}  // namespace
}  // namespace opponens::grasp
