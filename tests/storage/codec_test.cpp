// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/codec.hpp"

#include "tests/storage/support.hpp"

namespace opponens::storage::test {
namespace {

const Provenance kProvenance{"test", {"abc"}, {{"in.csv", "00"}}, "{\"alpha\": 0.05}", 7, "0.1.0"};

Demonstration demonstration() {
  Demonstration value;
  value.id = "s1_bottle_r2";
  value.labels = {{"subject", "1"}, {"object", "bottle"}, {"caf\xC3\xA9/x", ""}};
  value.origin = Origin::simulated;
  value.weight = 0.25;
  value.time = Eigen::Vector3d(0.0, 0.02, 0.04);
  value.joint_names = {"I_MCP", "I_PIP"};
  value.q_h = Eigen::MatrixXd::Random(3, 2);
  value.known_transition = 0.03;
  return value;
}

SynergyGroup group(const std::string& name) {
  SynergyGroup value;
  value.name = name;
  value.phase = "grasp";
  value.basis = {Eigen::VectorXd::Random(4), Eigen::MatrixXd::Random(4, 4), Eigen::VectorXd::Random(4), 123.0};
  value.box = {Eigen::VectorXd::Random(4),
               Eigen::MatrixXd::Random(4, 2),
               Eigen::VectorXd::Random(2),
               Eigen::VectorXd::Ones(4),
               0.01,
               0.1};
  value.dof_effective = 3;
  value.dropped_channels = {"I_DIP"};
  return value;
}

Grasp grasp() {
  Grasp value;
  value.group = "power";
  value.coefficients = Eigen::VectorXd::Random(2);
  value.slack = Eigen::VectorXd::Random(4);
  value.q_grasp = Eigen::VectorXd::Random(4);
  value.q_pregrasp = Eigen::VectorXd::Random(4);
  value.X_OH = Eigen::Translation3d(0.1, 0.2, 0.3) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  value.X_OH_pregrasp = Eigen::Translation3d(0.2, 0.2, 0.3) * value.X_OH;
  value.contacts = {{"thumb_tip", {0.1, 0, 0}, {-1, 0, 0}, 0.4}, {"palm", {0, 0.1, 0}, {0, -1, 0}, 0.6}};
  value.quality.state = ClosureState::not_force_closure;
  value.quality.epsilon = -0.125;
  value.quality.direction << 1, 2, 3, 4, 5, 6;
  value.quality.convention = {ContactModel::soft_finger, 0.7,  12,    ForceUnit::force,
                              WrenchNorm::linf,          0.08, 0.003, Eigen::Vector3d(0, 0, 1)};
  value.quality.convention.cone = FrictionCone::quadratic;
  value.quality.epsilon_gap = 0.25;
  value.certificate =
      Certificate{{{1, {0.1, 0.2, 0.3}, 0.25, "123456789012345678901234567890"}, {0, {-1, 0, 0}, 0.0, "7"}}, 0.125};
  value.synergy_grasp = false;
  value.robust = RobustQuality{{0.004, 0.03, 0.1, 250}, 0.9, 0.86, 0.93, 0.05, 0.01};
  value.origin = GraspOrigin::imported;
  value.arm_solutions = {{Eigen::VectorXd::Random(6), Eigen::VectorXd::Random(6)},
                         {Eigen::VectorXd::Random(6), Eigen::VectorXd::Random(6)}};
  return value;
}

/// Encodes, stores, reads and decodes: what comes back must encode to the same bits.
template <typename T, typename Decode>
T through_a_store(const T& value, Decode decode) {
  const TemporaryDirectory directory;
  Store store(directory / "store", true);
  const Record record = encode(value, kProvenance);
  const Record back = store.read(store.commit({record}).front());
  EXPECT_TRUE(same(record, back));
  const T decoded = decode(back);
  EXPECT_TRUE(same(encode(decoded, kProvenance), record));
  return decoded;
}

TEST(Codec, Demonstration) {
  const Demonstration value = demonstration();
  const Demonstration back = through_a_store(value, decode_demonstration);
  EXPECT_EQ(back.id, value.id);
  EXPECT_EQ(back.labels, value.labels);
  EXPECT_EQ(back.origin, value.origin);
  EXPECT_EQ(back.weight, value.weight);
  EXPECT_EQ(back.time, value.time);
  EXPECT_EQ(back.joint_names, value.joint_names);
  EXPECT_EQ(back.q_h, value.q_h);
  EXPECT_EQ(back.known_transition, value.known_transition);
}

TEST(Codec, SynergySet) {
  SynergySet value{{"a", "b", "c", "d"}, group("pre-grasp"), {group("power"), group("precision")}};
  const SynergySet back = through_a_store(value, decode_synergy_set);
  ASSERT_EQ(back.grasp.size(), 2U);
  EXPECT_EQ(back.joint_names, value.joint_names);
  EXPECT_EQ(back.pre_grasp.name, "pre-grasp");
  const SynergyGroup& read = back.grasp[1];
  const SynergyGroup& written = value.grasp[1];
  EXPECT_EQ(read.name, written.name);
  EXPECT_EQ(read.phase, written.phase);
  EXPECT_EQ(read.basis.mean, written.basis.mean);
  EXPECT_EQ(read.basis.axes, written.basis.axes);
  EXPECT_EQ(read.basis.variance, written.basis.variance);
  EXPECT_EQ(read.basis.count, written.basis.count);
  EXPECT_EQ(read.box.center, written.box.center);
  EXPECT_EQ(read.box.axes, written.box.axes);
  EXPECT_EQ(read.box.half_width, written.box.half_width);
  EXPECT_EQ(read.box.scale, written.box.scale);
  EXPECT_EQ(read.box.alpha, written.box.alpha);
  EXPECT_EQ(read.box.beta, written.box.beta);
  EXPECT_EQ(read.dof_effective, written.dof_effective);
  EXPECT_EQ(read.dropped_channels, written.dropped_channels);
}

TEST(Codec, Grasp) {
  const Grasp value = grasp();
  const Grasp back = through_a_store(value, decode_grasp);
  EXPECT_EQ(back.group, value.group);
  EXPECT_EQ(back.coefficients, value.coefficients);
  EXPECT_EQ(back.slack, value.slack);
  EXPECT_EQ(back.q_grasp, value.q_grasp);
  EXPECT_EQ(back.q_pregrasp, value.q_pregrasp);
  EXPECT_EQ(back.X_OH.matrix(), value.X_OH.matrix());
  EXPECT_EQ(back.X_OH_pregrasp.matrix(), value.X_OH_pregrasp.matrix());
  ASSERT_EQ(back.contacts.size(), 2U);
  EXPECT_EQ(back.contacts[1].link, "palm");
  EXPECT_EQ(back.contacts[1].p_OC, value.contacts[1].p_OC);
  EXPECT_EQ(back.contacts[1].n_O, value.contacts[1].n_O);
  EXPECT_EQ(back.contacts[1].mu, 0.6);
  EXPECT_EQ(back.quality.state, value.quality.state);
  EXPECT_EQ(back.quality.epsilon, value.quality.epsilon);
  EXPECT_FALSE(back.quality.min_weight || back.quality.volume);
  EXPECT_EQ(back.quality.direction, value.quality.direction);
  EXPECT_EQ(back.quality.convention.model, ContactModel::soft_finger);
  EXPECT_EQ(back.quality.convention.unit, ForceUnit::force);
  EXPECT_EQ(back.quality.convention.norm, WrenchNorm::linf);
  EXPECT_EQ(back.quality.convention.edges, 12);
  EXPECT_EQ(back.quality.convention.cone, FrictionCone::quadratic);
  EXPECT_EQ(back.quality.epsilon_gap, 0.25);
  EXPECT_EQ(back.quality.convention.rho, 0.08);
  EXPECT_EQ(back.quality.convention.torsion_radius, 0.003);
  EXPECT_EQ(back.quality.convention.mu, 0.7);
  EXPECT_EQ(back.quality.convention.origin, Eigen::Vector3d(0, 0, 1));
  ASSERT_TRUE(back.certificate.has_value());
  ASSERT_EQ(back.certificate->edges.size(), 2U);
  EXPECT_EQ(back.certificate->edges[0].contact, 1);
  EXPECT_EQ(back.certificate->edges[0].force, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(back.certificate->edges[0].torsion, 0.25);
  EXPECT_EQ(back.certificate->edges[0].coefficient, "123456789012345678901234567890");
  EXPECT_EQ(back.certificate->edges[1].coefficient, "7");
  EXPECT_EQ(back.certificate->epsilon_bound, 0.125);
  EXPECT_FALSE(back.synergy_grasp);
  ASSERT_TRUE(back.robust);
  EXPECT_EQ(back.robust->noise.position, 0.004);
  EXPECT_EQ(back.robust->noise.angle, 0.03);
  EXPECT_EQ(back.robust->noise.friction, 0.1);
  EXPECT_EQ(back.robust->noise.samples, 250);
  EXPECT_EQ(back.robust->force_closure, 0.9);
  EXPECT_EQ(back.robust->force_closure_low, 0.86);
  EXPECT_EQ(back.robust->force_closure_high, 0.93);
  EXPECT_EQ(back.robust->epsilon_mean, 0.05);
  EXPECT_EQ(back.robust->epsilon_low, 0.01);
  EXPECT_EQ(back.origin, GraspOrigin::imported);
  ASSERT_EQ(back.arm_solutions.size(), 2U);
  EXPECT_EQ(back.arm_solutions[1].q_grasp, value.arm_solutions[1].q_grasp);
  EXPECT_EQ(back.arm_solutions[1].q_pregrasp, value.arm_solutions[1].q_pregrasp);
}

TEST(Codec, GraspsStoredBeforeTheyHadAnOriginWereSearched) {
  Record record = encode(Grasp{}, kProvenance);
  EXPECT_EQ(record.fields.erase("origin"), 1U);
  const Grasp grasp = decode_grasp(record);
  EXPECT_EQ(grasp.origin, GraspOrigin::searched);
  EXPECT_FALSE(grasp.robust);
}

TEST(Codec, GraspWithoutACertificateAsInStoresOfBefore) {
  Grasp value = grasp();
  value.certificate.reset();
  const Record record = encode(value, kProvenance);
  for (const auto& [name, field] : record.fields) EXPECT_FALSE(name.starts_with("certificate")) << name;
  EXPECT_FALSE(through_a_store(value, decode_grasp).certificate.has_value());
  value.certificate = Certificate{};
  EXPECT_TRUE(through_a_store(value, decode_grasp).certificate->edges.empty());
}

TEST(Codec, DecodeRefusesAMisshapenCertificate) {
  const auto refusal = [](const std::string& field, const Field& wrong) {
    Record record = encode(grasp(), kProvenance);
    record.fields[field] = wrong;
    return message_of<StorageError>([&] { decode_grasp(record); });
  };
  EXPECT_TRUE(contains(refusal("certificate.contact", Eigen::VectorXd(Eigen::Vector2d(0, 0.5))),
                       {"'certificate.contact'", "indices of contacts"}));
  EXPECT_TRUE(contains(refusal("certificate.contact", Eigen::VectorXd(Eigen::Vector2d(-1, 0))), {"indices"}));
  EXPECT_TRUE(contains(refusal("certificate.contact", Eigen::VectorXd(Eigen::Vector2d(1e300, 0))), {"indices"}));
  EXPECT_TRUE(contains(refusal("certificate.contact", Eigen::VectorXd(Eigen::Vector3d(0, 0, 0))), {"one value"}));
  EXPECT_TRUE(contains(refusal("certificate.force", Eigen::MatrixXd(2, 2)), {"'certificate.force'", "x 3]"}));
  EXPECT_TRUE(contains(refusal("certificate.torsion", Eigen::VectorXd(1)), {"'certificate.torsion'"}));
  EXPECT_TRUE(contains(refusal("certificate.coefficient", 1.0), {"'certificate.coefficient'", "list of texts"}));
}

TEST(Codec, EmptyGraspAndUnsolvedPath) {
  EXPECT_TRUE(through_a_store(Grasp{}, decode_grasp).contacts.empty());
  PlanResult value;
  value.status = PlanStatus::check_limit;
  value.detail = "stopped after 10 checks";
  const PlanResult back = through_a_store(value, decode_plan_result);
  EXPECT_EQ(back.status, PlanStatus::check_limit);
  EXPECT_EQ(back.detail, value.detail);
  EXPECT_EQ(back.goal, -1);
}

TEST(Codec, PlanResult) {
  PlanResult value;
  value.status = PlanStatus::solved;
  value.path = {{"a", "b"}, Eigen::MatrixXd::Random(5, 2)};
  value.goal = 3;
  value.iterations = 1LL << 40U;
  value.extends = 20;
  value.extends_grown = 10;
  value.collision_checks = 400;
  value.length = 1.5;
  value.length_l1 = 2.5;
  const PlanResult back = through_a_store(value, decode_plan_result);
  EXPECT_EQ(back.path.joint_names, value.path.joint_names);
  EXPECT_EQ(back.path.waypoints, value.path.waypoints);
  EXPECT_EQ(back.goal, 3);
  EXPECT_EQ(back.iterations, value.iterations);
  EXPECT_EQ(back.extends, 20);
  EXPECT_EQ(back.extends_grown, 10);
  EXPECT_EQ(back.collision_checks, 400);
  EXPECT_EQ(back.length, 1.5);
  EXPECT_EQ(back.length_l1, 2.5);
}

TEST(Codec, DecodeNamesTheFieldThatIsWrong) {
  const auto refusal = [](const std::string& field, const std::optional<Field>& value) {
    Record record = encode(demonstration(), kProvenance);
    record.fields.erase(field);
    if (value) record.fields[field] = *value;
    return message_of<StorageError>([&] { decode_demonstration(record); });
  };
  EXPECT_TRUE(contains(refusal("q_h", std::nullopt), {"s1_bottle_r2", "'q_h'", "missing"}));
  EXPECT_TRUE(contains(refusal("q_h", Eigen::MatrixXd(2, 2)), {"'q_h'", "one row per value of time"}));
  EXPECT_TRUE(contains(refusal("q_h", Eigen::MatrixXd(3, 1)), {"'q_h'", "one column per joint name"}));
  EXPECT_TRUE(contains(refusal("weight", std::int64_t{1}), {"'weight'", "a number", "another type"}));
  EXPECT_TRUE(contains(refusal("origin", std::string("guessed")), {"'origin'", "recorded, simulated", "guessed"}));
  EXPECT_TRUE(contains(message_of<StorageError>([] { decode_grasp(small_record(1)); }), {"document", "grasp"}));
}

TEST(Codec, EncodeRefusesShapesThatDoNotFit) {
  Demonstration value = demonstration();
  value.joint_names.pop_back();
  EXPECT_THROW(encode(value, kProvenance), std::invalid_argument);
  Grasp uneven = grasp();
  uneven.arm_solutions[1].q_grasp.resize(5);
  EXPECT_THROW(encode(uneven, kProvenance), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::storage::test
