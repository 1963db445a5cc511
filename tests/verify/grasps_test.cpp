// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/grasps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "grasp/certificate.hpp"
#include "tests/verify/gantry.hpp"

namespace opponens::verify {
namespace {

class CheckGrasp : public ::testing::Test {
 protected:
  /// All reasons in one text.
  std::string fault() const {
    const Verdict verdict = check_grasp(grasp, {&box, &hand, &object});
    EXPECT_EQ(verdict.ok, verdict.reasons.empty());
    std::string text;
    for (const std::string& reason : verdict.reasons) text += reason + "; ";
    return text;
  }
  bool fault_is(const std::string& part) const {
    const std::string text = fault();
    const bool found = text.find(part) != std::string::npos;
    if (!found) ADD_FAILURE() << "got: " << text;
    return found;
  }
  Grasp grasp = cube_grasp();
  SynergyBox box = cube_box();
  robot::RobotModel hand = cube_hand();
  robot::SceneBody object = body("cube", robot::Box{Eigen::Vector3d(0.04, 0.04, 0.04)}, {1, 2, 3});
};

TEST_F(CheckGrasp, ARightOnePasses) { EXPECT_EQ(fault(), ""); }

TEST_F(CheckGrasp, WrongHandJoint) {
  grasp.q_grasp[2] += 0.001;
  EXPECT_TRUE(fault_is("q_grasp differs from synergies plus slack by 0.001 rad"));
}

TEST_F(CheckGrasp, HandJointMovedWithItsSlackLeavesTheSurface) {
  grasp.q_grasp[2] -= 0.01;
  grasp.slack[2] -= 0.01;
  // 10 mm, less what the polyhedron around the tip's ball is larger (0.02 mm at most).
  EXPECT_TRUE(fault_is("contact 2 (tip2) is 9.99"));
  EXPECT_TRUE(fault_is("mm off its link's surface"));
}

TEST_F(CheckGrasp, JointLimits) {
  grasp.q_pregrasp[1] = -1.2;
  EXPECT_TRUE(fault_is("q_pregrasp: joint f1 = -1.2 rad is outside [-1, 1]"));
  grasp.q_pregrasp = Eigen::Vector3d::Zero();
  EXPECT_TRUE(fault_is("q_pregrasp has 3 entries"));
}

TEST_F(CheckGrasp, TamperedNormal) {
  grasp.contacts[0].n_O *= 1.01;
  EXPECT_TRUE(fault_is("contact 0 (tip0): position, normal"));
  grasp = cube_grasp();
  grasp.contacts[0].n_O = Eigen::Vector3d(std::cos(0.5), std::sin(0.5), 0);  // still unit, still force closure
  EXPECT_TRUE(fault_is("normal is 0.5 rad off the object's surface normal"));
  grasp.contacts[0].n_O = Eigen::Vector3d(NAN, 0, 0);
  EXPECT_TRUE(fault_is("contact 0"));
}

TEST_F(CheckGrasp, MovedContact) {
  grasp.contacts[3].p_OC.y() += 0.004;
  EXPECT_TRUE(fault_is("contact 3 (tip3) is 4 mm off the object's surface"));
  grasp = cube_grasp();
  grasp.contacts[3].link = "thumb";
  EXPECT_TRUE(fault_is("the hand has no such link"));
}

TEST_F(CheckGrasp, PoseThatIsNotRigid) {
  grasp.X_OH.linear()(0, 0) = 1.001;
  EXPECT_TRUE(fault_is("X_OH is no rigid pose"));
  grasp = cube_grasp();
  grasp.X_OH_pregrasp.linear()(2, 2) = -1.0;  // a reflection is orthonormal
  EXPECT_TRUE(fault_is("X_OH_pregrasp is no rigid pose"));
}

TEST_F(CheckGrasp, SlackAndCoefficientsHaveBounds) {
  grasp.slack[0] = 0.4;
  grasp.q_grasp[0] += 0.4;
  EXPECT_TRUE(fault_is("called a synergy grasp with a slack of 0.4 rad"));
  grasp = cube_grasp();
  box.half_width[0] = 0.02;
  EXPECT_TRUE(fault_is("a synergy coefficient is 0.01 outside its box"));
}

TEST_F(CheckGrasp, NotPositivelySpanning) {
  grasp.contacts.pop_back();
  grasp.contacts.pop_back();  // two points: the object turns about the line through them
  EXPECT_TRUE(fault_is("stored as force closure, but its wrenches do not positively span"));
  grasp.quality.state = ClosureState::not_force_closure;
  EXPECT_TRUE(fault_is("not a force-closure grasp"));
  grasp = cube_grasp();
  grasp.quality.state = ClosureState::not_force_closure;
  EXPECT_TRUE(fault_is("not stored as force closure, but its wrenches positively span"));
}

TEST_F(CheckGrasp, StoredQualityMustBeTheContacts) {
  const GraspQuality right = grasp.quality;
  for (const double factor : {0.9, 1.01, 1.5}) {
    grasp.quality.epsilon = factor * *right.epsilon;
    EXPECT_TRUE(fault_is("the stored epsilon"));
  }
  grasp.quality.epsilon.reset();
  EXPECT_TRUE(fault_is("with epsilon = 0"));
  grasp.quality = right;
  grasp.quality.direction.setZero();  // found without the stored direction too
  EXPECT_EQ(fault(), "");
  grasp.quality = right;
  grasp.quality.min_weight = 1.01 * *right.min_weight;
  EXPECT_TRUE(fault_is("the stored l*"));
  grasp.quality.min_weight = 0.9 * *right.min_weight;
  EXPECT_TRUE(fault_is("is too small"));
  grasp.quality.min_weight = 0.0;
  EXPECT_TRUE(fault_is("l* = 0"));
  grasp.quality = right;
  grasp.quality.convention.edges = 2;
  EXPECT_TRUE(fault_is("2 cone edges are fewer than 3"));
}

TEST_F(CheckGrasp, QualityByForceUnitAndMaximumNorm) {
  for (const ForceUnit unit : {ForceUnit::normal, ForceUnit::force}) {
    for (const WrenchNorm norm : {WrenchNorm::l1, WrenchNorm::linf}) {
      QualityConvention convention = grasp.quality.convention;
      convention.unit = unit;
      convention.norm = norm;
      grasp.quality = grasp::evaluate(grasp.contacts, convention);
      EXPECT_EQ(fault(), "") << static_cast<int>(unit) << static_cast<int>(norm);
      grasp.quality.epsilon = 1.02 * *grasp.quality.epsilon;
      EXPECT_TRUE(fault_is("the stored epsilon"));
    }
  }
}

TEST_F(CheckGrasp, CertificateIsReCheckedAndOneThatIsMissingIsNoFailure) {
  const auto certified = [&] { return check_grasp(grasp, {&box, &hand, &object}).certified; };
  EXPECT_EQ(fault(), "");
  EXPECT_FALSE(certified());
  grasp.certificate = grasp::certify(grasp.contacts, grasp.quality);
  ASSERT_TRUE(grasp.certificate && grasp.certificate->epsilon_bound);
  EXPECT_EQ(fault(), "");
  EXPECT_TRUE(certified());
  const Certificate right = *grasp.certificate;
  grasp.certificate->edges[0].coefficient = "0";
  EXPECT_TRUE(fault_is("the certificate of force closure does not hold: edge 0 has the coefficient '0'"));
  EXPECT_FALSE(certified());
  grasp.certificate = right;
  grasp.certificate->edges.pop_back();
  EXPECT_TRUE(fault_is("the certificate of force closure does not hold: its weighted wrenches do not add up to zero"));
  grasp.certificate = Certificate{};
  EXPECT_TRUE(fault_is("its wrenches have rank 0, not 6"));
  grasp.certificate = right;
  Contact& moved = grasp.contacts[static_cast<std::size_t>(right.edges[0].contact)];
  moved.p_OC.z() += 1e-12;  // far below what the checks in floating point ask for
  EXPECT_TRUE(fault_is("do not add up to zero"));
  moved.p_OC.z() -= 1e-12;
  moved.mu = 0.1;
  EXPECT_TRUE(fault_is("is outside the friction cone"));
}

TEST_F(CheckGrasp, CertificatesBoundOfEpsilon) {
  grasp.certificate = grasp::certify(grasp.contacts, grasp.quality);
  double& bound = *grasp.certificate->epsilon_bound;
  bound += 1e-6;  // a weaker bound is one too
  EXPECT_EQ(fault(), "");
  bound -= 1e-6 + 1e-12;
  EXPECT_TRUE(fault_is("the certificate's bound of epsilon does not hold"));
  bound = NAN;
  EXPECT_TRUE(fault_is("is not finite"));
  bound = -1.0;
  EXPECT_TRUE(fault_is("is above it"));
}

TEST_F(CheckGrasp, SoftFingersInFull) {
  QualityConvention convention = grasp.quality.convention;
  convention.model = ContactModel::soft_finger;
  convention.torsion_radius = 0.004;
  grasp.quality = grasp::evaluate(grasp.contacts, convention);
  grasp.certificate = grasp::certify(grasp.contacts, grasp.quality);
  EXPECT_EQ(fault(), "");
  grasp.quality.epsilon = 1.02 * *grasp.quality.epsilon;
  EXPECT_TRUE(fault_is("the stored epsilon"));
  grasp.quality.convention.torsion_radius = 0.0;
  EXPECT_TRUE(fault_is("torsion radius is not positive"));
}

TEST(ContactEdges, AreThoseOfTheConvention) {
  const std::vector<Contact> contacts = cube_grasp().contacts;
  for (const auto model : {ContactModel::frictionless, ContactModel::point_with_friction, ContactModel::soft_finger}) {
    for (const auto unit : {ForceUnit::normal, ForceUnit::force}) {
      QualityConvention convention{model, 0.5, 7, unit, WrenchNorm::l1, 0.035, 0.003, {0.01, 0.02, 0.03}};
      const auto here = contact_wrenches(contacts, convention);
      const auto there = grasp::contact_wrenches(contacts, convention);  // another code
      ASSERT_EQ(here.cols(), there.cols());
      EXPECT_LT((here - there).cwiseAbs().maxCoeff(), 1e-14);
    }
  }
}

TEST(PositiveSpan, TorsionCloses) {
  const std::vector<Contact> pinch = {{"a", Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitX(), 0.5},
                                      {"b", -Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitX(), 0.5}};
  QualityConvention convention;
  EXPECT_FALSE(positive_span(pinch, convention).spans);
  convention.model = ContactModel::soft_finger;
  convention.torsion_radius = 0.01;
  EXPECT_TRUE(positive_span(pinch, convention).spans);
}

TEST(CheckArmSolutions, MustPutThePalmAtTheGrasp) {
  const robot::RobotModel robot = gantry();
  const Eigen::Isometry3d X_RO(Eigen::Translation3d(0.3, 0.1, 0.0));
  Grasp grasp;
  grasp.q_grasp = grasp.q_pregrasp = Eigen::VectorXd::Zero(1);
  grasp.X_OH = Eigen::Translation3d(0.1, 0.0, 0.0);
  grasp.X_OH_pregrasp = Eigen::Translation3d(-0.1, 0.0, 0.0);
  grasp.arm_solutions = {{Eigen::Vector2d(0.2, 0.1), Eigen::Vector2d(0.4, 0.1)}};
  const auto fault = [&] {
    Verdict verdict;
    check_arm_solutions(grasp, robot, X_RO, 1e-6, verdict);
    return verdict.ok ? "" : verdict.reasons.front();
  };
  EXPECT_EQ(fault(), "");
  grasp.arm_solutions[0].q_grasp[0] += 2e-6;
  EXPECT_NE(fault().find("arm solution 0, grasp, puts the palm 0.002 mm and 0 rad off"), std::string::npos) << fault();
  grasp.arm_solutions[0].q_grasp[0] -= 2e-6;
  grasp.X_OH_pregrasp.linear() = Eigen::AngleAxisd(2e-6, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_NE(fault().find("pre-grasp, puts the palm"), std::string::npos) << fault();
  grasp.X_OH_pregrasp.linear().setIdentity();
  grasp.arm_solutions.push_back({Eigen::Vector3d(0.2, 0.1, 0.0), Eigen::Vector2d(0.4, 0.1)});
  EXPECT_NE(fault().find("arm solution 1, pre-grasp, has another number"), std::string::npos) << fault();
}

TEST(PositiveSpan, KnownCases) {
  const QualityConvention convention = cube_grasp().quality.convention;
  const std::vector<Contact> four = cube_grasp().contacts;
  const PositiveSpan all = positive_span(four, convention);
  EXPECT_TRUE(all.spans);
  EXPECT_EQ(all.wrenches, 32);
  EXPECT_LT(all.residual, 1e-12);

  std::vector<Contact> frictionless = four;
  for (Contact& contact : frictionless) contact.mu = 0.0;
  EXPECT_FALSE(positive_span(frictionless, convention).spans);
  const std::vector<Contact> opposed(four.begin(), four.begin() + 2);
  const PositiveSpan line = positive_span(opposed, convention);
  EXPECT_FALSE(line.spans);
  EXPECT_LT(line.rank_ratio, 1e-12);  // no torque about the line
  EXPECT_LT(line.residual, 1e-12);    // though W a = 0 has a solution
  std::vector<Contact> one_side = four;
  for (Contact& contact : one_side) contact.n_O = Eigen::Vector3d::UnitZ();
  const PositiveSpan pushing = positive_span(one_side, convention);
  EXPECT_FALSE(pushing.spans);
  EXPECT_GT(pushing.residual, 0.1);
  EXPECT_FALSE(positive_span({}, convention).spans);
}

TEST(PositiveSpan, FrictionDecidesAtTheAngleOfTheCone) {
  // Two opposed rows of contacts on a wedge of half angle 0.2: held exactly when mu exceeds tan 0.2.
  const auto held = [](double mu) {
    std::vector<Contact> contacts;
    for (const double side : {-1.0, 1.0}) {
      for (const Eigen::Vector2d& at :
           {Eigen::Vector2d(0.01, 0), Eigen::Vector2d(-0.01, 0.01), Eigen::Vector2d(0, -0.01)}) {
        contacts.push_back(
            {"l", {side * 0.02, at.x(), at.y()}, Eigen::Vector3d(-side * std::cos(0.2), 0, std::sin(0.2)), mu});
      }
    }
    QualityConvention convention;
    convention.rho = 0.02;
    convention.edges = 16;
    return positive_span(contacts, convention).spans;
  };
  EXPECT_FALSE(held(0.98 * std::tan(0.2)));
  EXPECT_TRUE(held(1.05 * std::tan(0.2)));
}

}  // namespace
}  // namespace opponens::verify
