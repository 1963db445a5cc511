// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/friction_cone.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "core/rng.hpp"
#include "grasp/contact_frame.hpp"
#include "grasp/origin_ball.hpp"
#include "grasp/quality.hpp"
#include "random_contacts.hpp"

namespace opponens::grasp {
namespace {

using Eigen::Vector3d;

QualityConvention quadratic(ContactModel model, ForceUnit unit) {
  QualityConvention convention;
  convention.model = model;
  convention.unit = unit;
  convention.cone = FrictionCone::quadratic;
  convention.torsion_radius = 0.3;
  return convention;
}

/// The wrench of one edge of the cone, written down from the definition.
Vector6d wrench_of(const Contact& contact, const QualityConvention& convention, const Vector3d& e) {
  const ContactFrame frame = contact_frame(contact.n_O);
  const Vector3d force = frame.n + contact.mu * (e.x() * frame.t_x + e.y() * frame.t_y);
  Vector6d w;
  w << force, (contact.p_OC - convention.origin).cross(force) + contact.mu * e.z() * frame.n;
  w.tail<3>() /= convention.rho;
  if (convention.unit == ForceUnit::force) w /= force.norm();
  return w;
}

TEST(FrictionCone, CircleByHand) {
  // n = -z at (0, 0, 2): forces (mu cos, mu sin, -1); along +x the extreme one is (mu, 0, -1), torque p x f = (0, 2 mu,
  // 0).
  const Contact contact{"tip", Vector3d(0, 0, 2), -Vector3d::UnitZ(), 0.5};
  const QuadraticContact cone(contact, quadratic(ContactModel::point_with_friction, ForceUnit::normal));
  const Vector6d expected = (Vector6d() << 0.5, 0, -1, 0, 1, 0).finished();
  EXPECT_NEAR((cone.support(Vector6d::Unit(0)) - expected).norm(), 0.0, 1e-15);
  const QuadraticContact unit(contact, quadratic(ContactModel::point_with_friction, ForceUnit::force));
  EXPECT_NEAR((unit.support(Vector6d::Unit(0)) - expected / std::sqrt(1.25)).norm(), 0.0, 1e-15);
}

// The support point belongs to the cone's wrenches and none of a fine grid of edges lies further out.
TEST(FrictionCone, SupportEqualsTheBestOfAFineGridOfEdges) {
  Rng rng = stream(51, "support");
  for (const ContactModel model : {ContactModel::point_with_friction, ContactModel::soft_finger}) {
    for (const ForceUnit unit : {ForceUnit::normal, ForceUnit::force}) {
      const QualityConvention convention = quadratic(model, unit);
      for (int i = 0; i < 60; ++i) {
        Contact contact = test::random_contacts(1, 0.5, rng).front();
        contact.mu = rng.uniform(0.1, 1.5);
        Vector6d u;
        for (double& value : u) value = rng.normal();
        if (i % 4 == 1) u -= 2.0 * u.dot(wrench_of(contact, convention, Vector3d::Zero())) * u;  // against the normal
        if (i % 4 == 2) u << -contact.n_O, Vector3d::Zero();                                     // tells no edges apart
        if (i % 4 == 3) u << Vector3d::Zero(), contact.n_O;                                      // torsion alone
        double best = -1e9;
        const int rings = model == ContactModel::soft_finger ? 200 : 0;
        for (int ring = -rings; ring <= rings; ++ring) {
          const double latitude = rings == 0 ? 0.0 : 0.5 * std::numbers::pi * ring / rings;
          for (int k = 0; k < 200; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / 200;
            const Vector3d e(std::cos(latitude) * std::cos(angle), std::cos(latitude) * std::sin(angle),
                             convention.torsion_radius * std::sin(latitude));
            best = std::max(best, u.dot(wrench_of(contact, convention, e)));
          }
        }
        const double value = u.dot(QuadraticContact(contact, convention).support(u));
        EXPECT_GE(value, best - 1e-12) << "set " << i;
        EXPECT_LE(value, best + 2e-3 * u.norm()) << "set " << i;  // the grid's loss, 1 - cos(pi / 200) of each
      }
    }
  }
}

double epsilon_of(const std::vector<Contact>& contacts, QualityConvention convention, FrictionCone cone, int edges,
                  double gap = 1e-3) {
  convention.cone = cone;
  convention.edges = edges;
  return evaluate(contacts, convention, {.quadratic_gap = gap}).epsilon.value();
}

TEST(FrictionCone, PyramidsOfMoreEdgesTendToIt) {
  Rng rng = stream(52, "limit");
  double gained = 0.0;
  int compared = 0;
  for (int i = 0; i < 12; ++i) {
    QualityConvention convention;
    convention.unit = static_cast<ForceUnit>(i % 2);
    convention.norm = i % 4 < 3 ? WrenchNorm::l1 : WrenchNorm::linf;
    const std::vector<Contact> contacts = test::random_contacts(4, 0.2, rng);
    const double coarse = epsilon_of(contacts, convention, FrictionCone::pyramid, 8);
    if (coarse <= 0.0) continue;
    constexpr double gap = 5e-3;
    const double round = epsilon_of(contacts, convention, FrictionCone::quadratic, 8, gap);
    const double fine = epsilon_of(contacts, convention, FrictionCone::pyramid, 64);
    EXPECT_GE(round * (1.0 + gap), fine - 1e-12) << "set " << i;  // the truth is at least any pyramid's
    // 64 edges lose at most 1 - cos(pi / 64) = 0.12 % of the tangential force; epsilon loses some few times that.
    EXPECT_LE(round, 1.02 * fine) << "set " << i;
    gained = std::max(gained, round / coarse);
    ++compared;
  }
  EXPECT_GE(compared, 8);
  EXPECT_GT(gained, 1.01);  // eight edges are not the round cone
}

TEST(FrictionCone, TangentsDoNotMatter) {
  Rng rng = stream(53, "rotation");
  QualityConvention convention;
  convention.cone = FrictionCone::quadratic;
  for (int i = 0; i < 6; ++i) {
    const std::vector<Contact> contacts = test::random_contacts(5, 0.2, rng);
    std::vector<Contact> turned = contacts;
    const Eigen::Matrix3d R = Eigen::AngleAxisd(rng.uniform(0.5, 3), test::random_unit(rng)).toRotationMatrix();
    for (Contact& contact : turned) {
      contact.p_OC = R * contact.p_OC;
      contact.n_O = R * contact.n_O;
    }
    const GraspQuality first = evaluate(contacts, convention, {.quadratic_gap = 5e-3});
    const GraspQuality second = evaluate(turned, convention, {.quadratic_gap = 5e-3});
    EXPECT_NEAR(first.epsilon.value(), second.epsilon.value(), 5e-3 * std::abs(*first.epsilon) + 1e-9) << "set " << i;
    EXPECT_LE(first.epsilon_gap, 5.1e-3);
  }
}

TEST(FrictionCone, OutsideIsSeparatedWithAStatedGap) {
  std::vector<Contact> one_side;
  for (int i = 0; i < 3; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 3.0;
    const Vector3d p = Vector3d(std::cos(angle), std::sin(angle), 1.0);
    one_side.push_back({"tip", p, -p.normalized(), 0.3});
  }
  QualityConvention convention;
  convention.cone = FrictionCone::quadratic;
  const GraspQuality quality = evaluate(one_side, convention);
  EXPECT_EQ(quality.state, ClosureState::not_force_closure);
  const double distance = -quality.epsilon.value();
  EXPECT_GT(distance, 0.1);
  EXPECT_GT(quality.epsilon_gap, 0.0);  // a curved set: only nearly known
  EXPECT_LE(quality.epsilon_gap, kQuadraticGap);
  // Its direction separates: no wrench passes the origin along it.
  const WrenchSpace space(one_side, convention);
  EXPECT_NEAR(quality.direction.dot(space.support(quality.direction)), -distance * (1.0 - quality.epsilon_gap), 1e-12);
  // A pyramid is smaller, so further away.
  EXPECT_LE(epsilon_of(one_side, convention, FrictionCone::pyramid, 8), *quality.epsilon * (1.0 - kQuadraticGap));
}

}  // namespace
}  // namespace opponens::grasp
