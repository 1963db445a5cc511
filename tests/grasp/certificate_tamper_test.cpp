// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "certificate_cases.hpp"
#include "grasp/certificate.hpp"
#include "verify/certificate.hpp"

namespace opponens::grasp {
namespace {

using Eigen::Vector3d;
using test::of_model;
using test::pinch;
using test::ring;

/// Both checkers on certificates that were tampered with.
class TamperedCertificate : public ::testing::Test {
 protected:
  void SetUp() override {
    contacts = ring(3, 0.5);
    for (const Contact& contact : ring(3, 0.5, 0.5)) contacts.push_back(contact);
    convention = of_model(ContactModel::soft_finger);
    certificate = certify(contacts, convention).value();
  }
  bool both_say(const std::string& part) const {
    const std::string one = certificate_fault(certificate, contacts, convention);
    const std::string other = verify::certificate_fault(certificate, contacts, convention);
    const bool said = one.find(part) != std::string::npos && other.find(part) != std::string::npos;
    if (!said || one.empty() || other.empty()) ADD_FAILURE() << "got: " << one << "; " << other;
    return said;
  }
  std::vector<Contact> contacts{};
  QualityConvention convention{};
  Certificate certificate{};
};

TEST_F(TamperedCertificate, ARightOneHolds) {
  EXPECT_EQ(certificate_fault(certificate, contacts, convention), "");
  EXPECT_EQ(verify::certificate_fault(certificate, contacts, convention), "");
}

TEST_F(TamperedCertificate, ContactMovedByTheLeastBit) {
  Contact& contact = contacts[static_cast<std::size_t>(certificate.edges[0].contact)];
  contact.p_OC.x() = std::nextafter(contact.p_OC.x(), 2.0);
  EXPECT_TRUE(both_say("do not add up to zero"));
  contact.p_OC.x() = NAN;
  EXPECT_TRUE(both_say("not finite"));
}

TEST_F(TamperedCertificate, ForceChangedByTheLeastBit) {
  double& component = certificate.edges[3].force.z();
  component = std::nextafter(component, 0.0);
  EXPECT_NE(certificate_fault(certificate, contacts, convention), "");
  EXPECT_NE(verify::certificate_fault(certificate, contacts, convention), "");
}

TEST_F(TamperedCertificate, Coefficients) {
  const std::string right = certificate.edges[2].coefficient;
  for (const char* wrong : {"0", "-3", "", "1.5", "1/2", "+3", " 3", "3 ", "03", "1e3", "0x3", "three"}) {
    certificate.edges[2].coefficient = wrong;
    EXPECT_TRUE(both_say("edge 2")) << wrong;
    EXPECT_TRUE(both_say("no positive integer")) << wrong;
  }
  certificate.edges[2].coefficient = right;
  certificate.edges[2].coefficient.back() = right.back() == '1' ? '2' : '1';
  EXPECT_TRUE(both_say("do not add up to zero"));
  // All of them times 10 is the same proof.
  certificate.edges[2].coefficient = right;
  for (CertificateEdge& edge : certificate.edges) edge.coefficient += "0";
  EXPECT_EQ(certificate_fault(certificate, contacts, convention), "");
  EXPECT_EQ(verify::certificate_fault(certificate, contacts, convention), "");
}

TEST_F(TamperedCertificate, ContactsThatAreNotThere) {
  for (const int wrong : {-1, 6, 1 << 30}) {
    certificate.edges[1].contact = wrong;
    EXPECT_TRUE(both_say("edge 1"));
  }
}

TEST_F(TamperedCertificate, LessFrictionThanTheForcesNeed) {
  for (Contact& contact : contacts) contact.mu *= 0.99;
  EXPECT_TRUE(both_say("outside the friction cone"));
  for (Contact& contact : contacts) contact.mu = 0.0;
  EXPECT_TRUE(both_say("outside the friction cone"));
  for (Contact& contact : contacts) contact.mu = -0.5;
  EXPECT_TRUE(both_say("not finite"));
}

TEST_F(TamperedCertificate, TorsionTheModelDoesNotHave) {
  const bool twisted = std::any_of(certificate.edges.begin(), certificate.edges.end(),
                                   [](const CertificateEdge& edge) { return edge.torsion != 0.0; });
  ASSERT_TRUE(twisted);
  convention.torsion_radius *= 0.5;
  EXPECT_TRUE(both_say("outside the friction cone"));
  convention.model = ContactModel::point_with_friction;
  EXPECT_TRUE(both_say("outside the friction cone"));
  convention.model = ContactModel::frictionless;
  EXPECT_TRUE(both_say("outside the friction cone"));
}

TEST_F(TamperedCertificate, AnEdgeOnTheConeAndOneBeyondIt) {
  // 3-4-5: mu = 3/4 with the normal (0, 0, 1): (3, 0, 4) is on the cone, exactly.
  contacts = {{"a", Vector3d::UnitX(), Vector3d::UnitZ(), 0.75}};
  convention = of_model(ContactModel::point_with_friction);
  certificate.edges = {{0, Vector3d(3.0, 0.0, 4.0), 0.0, "1"}};
  EXPECT_TRUE(both_say("do not add up to zero"));
  certificate.edges[0].force.x() = std::nextafter(3.0, 4.0);
  EXPECT_TRUE(both_say("edge 0 is outside the friction cone"));
  certificate.edges[0].force = Vector3d(-3.0, 0.0, -4.0);  // the other half of the cone
  EXPECT_TRUE(both_say("edge 0 is outside the friction cone"));
  certificate.edges[0].force.setZero();
  EXPECT_TRUE(both_say("edge 0 is outside the friction cone"));
}

TEST_F(TamperedCertificate, AnEdgeOnTheSoftFingersEllipsoidAndOneBeyondIt) {
  // |f_t| = 3 and torsion 4 r on a normal force of 5 / mu with mu = 1: 9 + 16 = 25.
  contacts = {{"a", Vector3d::UnitX(), Vector3d::UnitZ(), 1.0}};
  convention.torsion_radius = 0.25;
  certificate.edges = {{0, Vector3d(3.0, 0.0, 5.0), 1.0, "1"}};
  EXPECT_TRUE(both_say("do not add up to zero"));
  certificate.edges[0].torsion = std::nextafter(1.0, 2.0);
  EXPECT_TRUE(both_say("edge 0 is outside the friction cone"));
  certificate.edges[0].torsion = -1.0;
  EXPECT_TRUE(both_say("do not add up to zero"));
}

TEST_F(TamperedCertificate, TooFewDirections) {
  // Two forces along one line balance, but resist nothing else.
  contacts = pinch(0.5);
  certificate.edges = {{0, -Vector3d::UnitX(), 0.0, "1"}, {1, Vector3d::UnitX(), 0.0, "1"}};
  EXPECT_TRUE(both_say("have rank 1, not 6"));
  certificate.edges.clear();
  EXPECT_TRUE(both_say("have rank 0, not 6"));
  // Two point contacts, four edges each in their own planes: everything but the torque about x.
  for (int contact = 0; contact < 2; ++contact) {
    for (const Vector3d& across :
         {Vector3d(0, 0.25, 0), Vector3d(0, -0.25, 0), Vector3d(0, 0, 0.25), Vector3d(0, 0, -0.25)}) {
      certificate.edges.push_back({contact, (contact == 0 ? -1.0 : 1.0) * Vector3d::UnitX() + across, 0.0, "2"});
    }
  }
  EXPECT_TRUE(both_say("have rank 5, not 6"));
}

}  // namespace
}  // namespace opponens::grasp
