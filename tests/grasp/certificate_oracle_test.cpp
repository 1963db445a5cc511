// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Certificates against CGAL's exact linear programme, on random, on nearly singular and on real contact sets.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "exact_oracle.hpp"
#include "grasp/certificate.hpp"
#include "grasp/quality.hpp"
#include "random_contacts.hpp"
#include "tests/support/sample_count.hpp"
#include "verify/certificate.hpp"

namespace opponens::grasp {
namespace {

using Eigen::Vector3d;

QualityConvention random_convention(Rng& rng) {
  QualityConvention convention;
  convention.model = static_cast<ContactModel>(rng.index(3));
  convention.edges = 3 + static_cast<int>(rng.index(8));
  if (convention.model == ContactModel::soft_finger) convention.torsion_radius = std::pow(10.0, rng.uniform(-3, 0));
  convention.unit = static_cast<ForceUnit>(rng.index(2));
  convention.norm = static_cast<WrenchNorm>(rng.index(2));
  return convention;
}

TEST(CertificateOracle, RandomMixedSets) {
  Rng rng = stream(61, "mixed");
  int closed = 0;
  const int count = sample_count(2000);
  for (int i = 0; i < count; ++i) {
    const QualityConvention convention = random_convention(rng);
    const bool frictionless = convention.model == ContactModel::frictionless;
    const int contacts_count = frictionless ? 7 + static_cast<int>(rng.index(6)) : 2 + static_cast<int>(rng.index(5));
    const auto contacts = test::random_contacts(contacts_count, rng.uniform(0.1, frictionless ? 3.0 : 1.0), rng);
    const auto certificate = certify(contacts, convention);
    EXPECT_EQ(certificate.has_value(), test::positively_span(test::oracle_wrenches(contacts, convention)))
        << "set " << i;
    EXPECT_EQ(certificate.has_value(), evaluate(contacts, convention).force_closure()) << "set " << i;
    closed += certificate.has_value();
    if (certificate) {
      EXPECT_EQ(verify::certificate_fault(*certificate, contacts, convention), "") << "set " << i;
    }
  }
  RecordProperty("closed", closed);
  EXPECT_GT(closed, count / 5);
  EXPECT_LT(closed, 4 * count / 5);
}

/// Three point contacts almost on a line (rank 6 by `off`), or normals that barely (do not) balance by `off`.
std::vector<Contact> nearly_singular(double off, bool line, Rng& rng) {
  std::vector<Contact> contacts = {{"a", Vector3d::UnitX(), -Vector3d::UnitX(), 0.5},
                                   {"b", -Vector3d::UnitX(), Vector3d::UnitX(), 0.5}};
  if (line) {
    contacts.push_back({"c", Vector3d(0.3, off, 0.0), Vector3d(-1.0, 0.0, 0.0), 0.5});
    return contacts;
  }
  // The angle between the normals and the line of the points is that of the cone, but for `off`.
  const double angle = std::atan(0.5) - off;
  for (int i = 0; i < 2; ++i) {
    contacts.push_back(contacts[static_cast<std::size_t>(i)]);
    contacts.back().p_OC += 0.1 * test::random_unit(rng);
  }
  for (Contact& contact : contacts) {
    contact.n_O = std::cos(angle) * contact.n_O + std::sin(angle) * Vector3d::UnitZ();
  }
  return contacts;
}

TEST(CertificateOracle, NearlySingularSets) {
  Rng rng = stream(62, "singular");
  int closed = 0;
  int open = 0;
  for (const bool line : {true, false}) {
    for (const double off : {0.0, 1e-3, -1e-3, 1e-6, -1e-6, 1e-9, -1e-9, 1e-11, -1e-11}) {
      const std::vector<Contact> contacts = nearly_singular(off, line, rng);
      const QualityConvention convention;
      const bool expected = test::positively_span(test::oracle_wrenches(contacts, convention));
      const auto certificate = certify(contacts, convention);
      EXPECT_EQ(certificate.has_value(), expected) << line << " " << off;
      if (certificate) {
        EXPECT_EQ(verify::certificate_fault(*certificate, contacts, convention), "");
      }
      closed += expected;
      open += !expected;
    }
  }
  EXPECT_GT(closed, 5);
  EXPECT_GT(open, 5);
}

TEST(CertificateOracle, GraspItsBestGraspsAreCertified) {
  const std::filesystem::path folder = std::filesystem::path(OPPONENS_SHARED_DATA) / "reference/graspit_ycb_top5";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no reference data at " << folder;
  const auto vector = [](const nlohmann::json& j) { return Vector3d(j[0], j[1], j[2]); };
  int grasps = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    const auto document = nlohmann::json::parse(std::ifstream(file.path()));
    QualityConvention convention;
    convention.edges = document["edges"];
    convention.rho = document["rho_mm"].get<double>() * 1e-3;
    convention.origin = vector(document["cog_mm"]) * 1e-3;
    for (const auto& grasp : document["grasps"]) {
      SCOPED_TRACE(file.path().filename().string() + " " + grasp["rank"].dump());
      std::vector<Contact> contacts;
      for (const auto& k : grasp["contacts"]) {
        contacts.push_back({"", vector(k["p"]) * 1e-3, vector(k["n"]).normalized(), k["mu"]});
      }
      const GraspQuality quality = evaluate(contacts, convention);
      ASSERT_TRUE(quality.force_closure());
      const auto certificate = certify(contacts, quality);
      ASSERT_TRUE(certificate.has_value());
      EXPECT_EQ(certificate_fault(*certificate, contacts, convention), "");
      EXPECT_EQ(verify::certificate_fault(*certificate, contacts, convention), "");
      EXPECT_EQ(certificate->edges.size(), 7U);
      EXPECT_EQ(verify::epsilon_bound_fault(certificate->epsilon_bound.value(), contacts, quality), "");
      for (const CertificateEdge& edge : certificate->edges) EXPECT_LE(edge.coefficient.size(), 120U);
      ++grasps;
    }
  }
  EXPECT_EQ(grasps, 50);
}

}  // namespace
}  // namespace opponens::grasp
