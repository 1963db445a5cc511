// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/certificate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "certificate_cases.hpp"
#include "core/rng.hpp"
#include "grasp/exact_balance.hpp"
#include "grasp/exact_edges.hpp"
#include "grasp/exact_programme.hpp"
#include "grasp/quality.hpp"
#include "random_contacts.hpp"
#include "tests/support/sample_count.hpp"
#include "verify/certificate.hpp"

namespace opponens::grasp {
namespace {

using Eigen::Vector3d;
using test::of_model;
using test::pinch;
using test::ring;

/// One contact on each face of a cube of size 2, off its middle, without friction.
std::vector<Contact> cube_faces(double off, Rng& rng) {
  std::vector<Contact> contacts;
  for (int face = 0; face < 7; ++face) {
    const int axis = face % 3;
    const double side = face < 3 || face == 6 ? 1.0 : -1.0;
    Vector3d p(rng.uniform(-off, off), rng.uniform(-off, off), rng.uniform(-off, off));
    p[axis] = side;
    contacts.push_back({"", p, -side * Vector3d::Unit(axis), 0.0});
  }
  return contacts;
}

/// Both checkers, which share no code, on a certificate that has to hold.
void expect_certified(const std::vector<Contact>& contacts, const QualityConvention& convention) {
  const auto certificate = certify(contacts, convention);
  ASSERT_TRUE(certificate.has_value());
  EXPECT_EQ(certificate_fault(*certificate, contacts, convention), "");
  EXPECT_EQ(verify::certificate_fault(*certificate, contacts, convention), "");
  EXPECT_GE(certificate->edges.size(), 7U);
  EXPECT_LE(certificate->edges.size(), 12U);
}

TEST(Certificate, KnownClosures) {
  const QualityConvention point = of_model(ContactModel::point_with_friction);
  const QualityConvention soft = of_model(ContactModel::soft_finger);
  for (const double mu : {0.05, 0.5, 1.5}) {
    SCOPED_TRACE(mu);
    expect_certified(pinch(mu), soft);
    expect_certified(ring(3, mu), point);
    expect_certified(ring(4, mu), point);
    expect_certified(ring(3, mu), soft);
  }
  std::vector<Contact> cube;
  for (int face = 0; face < 6; ++face) {
    const double side = face < 3 ? 1.0 : -1.0;
    cube.push_back({"", side * Vector3d::Unit(face % 3), -side * Vector3d::Unit(face % 3), 0.3});
  }
  expect_certified(cube, point);
  for (const WrenchNorm norm : {WrenchNorm::l1, WrenchNorm::linf}) {
    for (const ForceUnit unit : {ForceUnit::normal, ForceUnit::force}) {
      QualityConvention convention = point;
      convention.norm = norm;
      convention.unit = unit;
      convention.edges = 3;
      expect_certified(cube, convention);
    }
  }
}

TEST(Certificate, KnownNonClosures) {
  const QualityConvention point = of_model(ContactModel::point_with_friction);
  const QualityConvention soft = of_model(ContactModel::soft_finger);
  const auto open = [](const std::vector<Contact>& contacts, const QualityConvention& convention) {
    return !certify(contacts, convention).has_value();
  };
  EXPECT_TRUE(open({}, point));
  EXPECT_TRUE(open({ring(1, 0.5)}, point));
  EXPECT_TRUE(open(pinch(0.5), point));  // rank 5
  EXPECT_TRUE(open(pinch(0.0), soft));   // no friction: rank 1
  EXPECT_TRUE(open(ring(3, 0.0), point));
  EXPECT_TRUE(open(ring(5, 0.5), of_model(ContactModel::frictionless)));
  std::vector<Contact> hemisphere = ring(5, 0.3, 0.2);
  for (Contact& contact : hemisphere) contact.n_O = (contact.n_O + 0.5 * Vector3d::UnitZ()).normalized();
  EXPECT_TRUE(open(hemisphere, point));
  EXPECT_TRUE(open(hemisphere, soft));
  // On the boundary: two pinch, a third pushes where nothing pushes back, so only the two can balance.
  std::vector<Contact> boundary = pinch(0.5);
  boundary.push_back({"c", Vector3d(0.0, 0.0, -1.0), Vector3d::UnitZ(), 0.0});
  boundary.push_back({"d", Vector3d(0.0, 0.5, -1.0), Vector3d::UnitZ(), 0.0});
  EXPECT_TRUE(open(boundary, point));
  boundary[0].mu = boundary[1].mu = 0.0;
  EXPECT_TRUE(open(boundary, point));
  // All forces meet in one point: no torque about it.
  EXPECT_TRUE(open({{"a", Vector3d::Zero(), Vector3d::UnitX(), 0.9},
                    {"b", Vector3d::Zero(), -Vector3d::UnitX(), 0.9},
                    {"c", Vector3d::Zero(), Vector3d::UnitY(), 0.9}},
                   point));
}

TEST(Certificate, WithoutFriction) {
  Rng rng = stream(51, "seven faces");
  int closed = 0;
  for (int i = 0; i < sample_count(400); ++i) {
    const std::vector<Contact> contacts = cube_faces(0.9, rng);
    const QualityConvention convention =
        of_model(i % 2 == 0 ? ContactModel::frictionless : ContactModel::point_with_friction);
    const bool expected = evaluate(contacts, convention).force_closure();
    const auto certificate = certify(contacts, convention);
    ASSERT_EQ(certificate.has_value(), expected) << "set " << i;
    closed += expected;
    if (!expected) continue;
    EXPECT_EQ(certificate->edges.size(), 7U);
    EXPECT_EQ(verify::certificate_fault(*certificate, contacts, convention), "");
  }
  EXPECT_GT(closed, sample_count(400) / 100);
}

TEST(Certificate, AnyScaleAndPlace) {
  Rng rng = stream(52, "scales");
  for (const double scale : {1e-200, 1e-6, 1e-3, 1e3, 1e6, 1e200}) {
    for (const double away : {0.0, 1.0, 1e4}) {
      SCOPED_TRACE(testing::Message() << scale << " " << away);
      for (const auto model : {ContactModel::point_with_friction, ContactModel::soft_finger}) {
        std::vector<Contact> contacts = ring(4, 0.4);
        const Eigen::Matrix3d turn = Eigen::AngleAxisd(rng.uniform(0, 6), test::random_unit(rng)).toRotationMatrix();
        for (Contact& contact : contacts) {
          contact.p_OC = scale * (turn * contact.p_OC + away * Vector3d(1, 2, 3));
          contact.n_O = turn * contact.n_O;
        }
        QualityConvention convention = of_model(model);
        convention.torsion_radius *= scale;
        expect_certified(contacts, convention);
      }
    }
  }
}

TEST(Certificate, FrictionOfAnySize) {
  for (const double mu : {1e-9, 1e-6, 1e-3, 10.0, 1e4, 1e8, 1e16}) {
    SCOPED_TRACE(mu);
    expect_certified(ring(4, mu), of_model(ContactModel::point_with_friction));
    expect_certified(pinch(mu), of_model(ContactModel::soft_finger));
  }
  // Below 1e-11 doubles cannot tell the cone from its axis, and no friction is claimed.
  EXPECT_FALSE(certify(ring(4, 1e-13), of_model(ContactModel::point_with_friction)).has_value());
}

TEST(Certificate, NormalsThatAreNotQuiteUnit) {
  for (const auto model : {ContactModel::frictionless, ContactModel::point_with_friction, ContactModel::soft_finger}) {
    std::vector<Contact> contacts = ring(3, 0.4);
    for (const Contact& contact : ring(3, 0.4, 0.5)) contacts.push_back(contact);
    if (model == ContactModel::frictionless) {
      Rng rng = stream(53, "unit");
      do {
        contacts = cube_faces(0.9, rng);
      } while (!evaluate(contacts, of_model(model)).force_closure());
    }
    for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i].n_O *= i % 2 == 0 ? 1.0 + 9e-7 : 1.0 - 9e-7;
    expect_certified(contacts, of_model(model));
  }
}

TEST(Certificate, RepeatedContactsAndManyEdges) {
  std::vector<Contact> contacts = ring(3, 0.5);
  for (int i = 0; i < 15; ++i) contacts.push_back(contacts[static_cast<std::size_t>(i % 3)]);
  QualityConvention convention;
  for (const int edges : {3, 4, 8, 64}) {
    convention.edges = edges;
    expect_certified(contacts, convention);
  }
}

TEST(Certificate, SameAnswersFromManyThreads) {
  Rng rng = stream(54, "threads");
  std::vector<std::vector<Contact>> sets;
  for (int i = 0; i < sample_count(40); ++i) sets.push_back(test::random_contacts(6, 0.2, rng));
  const auto all = [&] {
    std::vector<std::string> coefficients;
    for (const auto& set : sets) {
      const auto certificate = certify(set, QualityConvention{});
      if (!certificate) continue;
      for (const CertificateEdge& edge : certificate->edges) coefficients.push_back(edge.coefficient);
    }
    return coefficients;
  };
  std::vector<std::string> first;
  std::vector<std::string> second;
  {
    std::jthread other([&] { first = all(); });
    second = all();
  }
  EXPECT_EQ(first, second);
  EXPECT_GT(first.size(), 7U);
}

TEST(Certificate, BoundOfEpsilonIsJustAboveIt) {
  Rng rng = stream(55, "bound");
  int closed = 0;
  for (int i = 0; i < sample_count(200); ++i) {
    const std::vector<Contact> contacts = test::random_contacts(5, 0.3, rng);
    QualityConvention convention = of_model(i % 3 == 0 ? ContactModel::soft_finger : ContactModel::point_with_friction);
    convention.unit = i % 2 == 0 ? ForceUnit::normal : ForceUnit::force;
    convention.norm = i % 5 == 0 ? WrenchNorm::linf : WrenchNorm::l1;
    convention.rho = rng.uniform(0.1, 2.0);
    convention.origin = 0.2 * test::random_unit(rng);
    const GraspQuality quality = evaluate(contacts, convention);
    if (!quality.force_closure()) continue;
    ++closed;
    const auto certificate = certify(contacts, quality);
    ASSERT_TRUE(certificate && certificate->epsilon_bound) << "set " << i;
    const double bound = *certificate->epsilon_bound;
    EXPECT_GE(bound, *quality.epsilon) << "set " << i;
    EXPECT_NEAR(bound, *quality.epsilon, 1e-11) << "set " << i;
    EXPECT_EQ(verify::epsilon_bound_fault(bound, contacts, quality), "") << "set " << i;
    EXPECT_NE(verify::epsilon_bound_fault(bound - 1e-12, contacts, quality), "") << "set " << i;
    // Any direction bounds epsilon, and its length does not matter.
    const Vector6d u = Vector6d(quality.direction + 0.1 * Vector6d::Ones());
    EXPECT_GE(epsilon_bound(contacts, convention, u), bound - 1e-12) << "set " << i;
    EXPECT_NEAR(epsilon_bound(contacts, convention, 1e-200 * u), epsilon_bound(contacts, convention, u), 1e-13);
  }
  EXPECT_GT(closed, sample_count(200) / 4);
  EXPECT_THROW(epsilon_bound(ring(3, 0.5), {}, Vector6d::Zero()), std::invalid_argument);
  EXPECT_THROW(epsilon_bound({}, {}, Vector6d::Ones()), std::invalid_argument);
  // Not force closure: the bound is negative, as epsilon is.
  std::vector<Contact> open = ring(5, 0.3, 0.2);
  for (Contact& contact : open) contact.n_O = (contact.n_O + Vector3d::UnitZ()).normalized();
  const GraspQuality quality = evaluate(open, {});
  ASSERT_LT(*quality.epsilon, -0.01);
  EXPECT_NEAR(epsilon_bound(open, {}, quality.direction), *quality.epsilon, 1e-11);
  EXPECT_GE(epsilon_bound(open, {}, quality.direction), *quality.epsilon);
}

TEST(Certificate, ExactProgrammeAloneCertifiesToo) {
  // What certify falls back to: six independent edges against a basic solution of the exact programme.
  Rng rng = stream(56, "exact");
  int closed = 0;
  for (int i = 0; i < sample_count(40); ++i) {
    const std::vector<Contact> contacts = test::random_contacts(4, 0.4, rng);
    const std::vector<CertificateEdge> edges = inner_edges(contacts, {}, 48);
    const std::vector<int> independent = independent_edges(edges, contacts, {});
    ASSERT_EQ(independent.size(), 6U);
    const GivenEdges given{independent, std::vector<int>(6, 1)};
    const auto positive = exact_conic_basis(edges, contacts, given);
    EXPECT_EQ(positive.has_value(), certify(contacts, QualityConvention{}).has_value()) << "set " << i;
    if (!positive) continue;
    ++closed;
    const auto certificate = exact_balance(edges, contacts, given, independent_edges(edges, contacts, *positive));
    ASSERT_TRUE(certificate.has_value());
    EXPECT_EQ(verify::certificate_fault(*certificate, contacts, {}), "");
  }
  EXPECT_GT(closed, 0);
}

TEST(Certificate, ContractsOfCallers) {
  std::vector<Contact> contacts = ring(3, 0.5);
  contacts[0].n_O *= 1.1;
  EXPECT_THROW(certify(contacts, QualityConvention{}), std::invalid_argument);
  contacts = ring(3, 0.5);
  contacts[1].p_OC.x() = NAN;
  EXPECT_THROW(certify(contacts, QualityConvention{}), std::invalid_argument);
  QualityConvention soft;
  soft.model = ContactModel::soft_finger;
  EXPECT_THROW(certify(ring(3, 0.5), soft), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::grasp
