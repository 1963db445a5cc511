// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/report/synthetic_report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/QR>

#include "core/rng.hpp"
#include "report/body_drawing.hpp"
#include "report/text.hpp"
#include "robot/inverse_kinematics.hpp"
#include "robot/load_robot.hpp"

namespace opponens::report {
namespace {

constexpr int kJoints = 16;

Eigen::VectorXd normals(Rng& rng, Eigen::Index count) {
  Eigen::VectorXd values(count);
  for (auto& value : values) value = rng.normal();
  return values;
}

std::string fake_id(Rng& rng) {
  std::string id;
  for (int i = 0; i < 64; ++i) id += "0123456789abcdef"[rng.index(16)];
  return id;
}

double smooth(double u) { return u <= 0 ? 0 : u >= 1 ? 1 : u * u * u * (10 - 15 * u + 6 * u * u); }

Demonstration recording(const robot::RobotModel& hand, Rng& rng) {
  Demonstration d{"sim_medium_wrap_r03",
                  {{"family", "3"},
                   {"grasp_type", "medium_wrap"},
                   {"object", "cylinder"},
                   {"repetition", "3"},
                   {"subject", "simulated"}},
                  Origin::simulated,
                  1.0,
                  {},
                  hand.joint_names(),
                  {},
                  1.02};
  const int samples = 105;
  d.time = Eigen::VectorXd::LinSpaced(samples, 0.0, 0.02 * (samples - 1));
  d.q_h.resize(samples, kJoints);
  for (int j = 0; j < kJoints; ++j) {
    const double open = -0.15 + 0.1 * rng.normal();
    const double close = j % 4 == 0 ? 0.1 * rng.normal() : 0.9 + 0.2 * rng.normal();
    for (int t = 0; t < samples; ++t) {
      d.q_h(t, j) =
          0.2 + open * smooth(d.time[t] / 1.02) + close * smooth((d.time[t] - 1.02) / 1.06) + 0.004 * rng.normal();
    }
  }
  return d;
}

DemonstrationPart demonstrations(const robot::RobotModel& hand, Rng& rng) {
  DemonstrationPart part;
  part.grouped_by = "family";
  part.simulated = 180;
  part.groups = {{"1", 36, 3712, 2.06, {1.58, 2.71}},
                 {"2", 48, 4903, 2.04, {1.49, 2.88}},
                 {"3", 60, 6321, 2.10, {1.52, 2.79}},
                 {"4", 36, 3650, 2.03, {1.61, 2.60}}};
  part.source = "MADE-UP INPUT for looking at the page: no number below comes from a computation.";
  part.mapping = "paper";
  part.tip_residual = 0.0043;
  part.example = recording(hand, rng);
  return part;
}

TransitionPart transitions(Rng& rng) {
  TransitionPart part;
  part.method = "likeness";
  TransitionCurves curves;
  curves.demonstration = "sim_medium_wrap_r03";
  curves.time = Eigen::VectorXd::LinSpaced(71, 0.34, 1.74);
  curves.log_likeness =
      curves.time.unaryExpr([](double t) { return 12.0 + 9.0 * std::pow(t - 1.15, 2) - 2.0 * std::cos(9.0 * t); });
  curves.changepoint_cost = curves.time.unaryExpr([](double t) { return -8120.0 + 900.0 * std::abs(t - 1.04); });
  curves.likeness_time = 1.24;
  curves.changepoint_time = 1.04;
  curves.known_time = 1.02;
  part.example = curves;
  for (int i = 0; i < 180; ++i) {
    const double known = 0.48 + 0.03 * rng.normal();
    part.all.push_back(
        {concat({"r", std::to_string(i)}), known + 0.09 + 0.05 * rng.normal(), known + 0.01 * rng.normal(), known});
  }
  return part;
}

SynergyItem group(const std::string& name, const std::string& phase, double first, Rng& rng, int samples) {
  SynergyItem item;
  item.samples = samples;
  item.cluster = "recording";
  item.group.name = name;
  item.group.phase = phase;
  Eigen::MatrixXd random(kJoints, kJoints);
  for (auto& value : random.reshaped()) value = rng.normal();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(random);
  auto& basis = item.group.basis;
  basis.axes = qr.householderQ() * Eigen::MatrixXd::Identity(kJoints, kJoints);
  // The first axis flexes all fingers, as the first synergy of real hands does.
  for (int j = 0; j < kJoints; ++j) basis.axes(j, 0) = j % 4 == 0 ? 0.02 : 0.28;
  basis.mean = Eigen::VectorXd::Constant(kJoints, 0.5) + 0.1 * normals(rng, kJoints);
  for (int j = 0; j < 12; j += 4) basis.mean[j] = 0.0;
  basis.mean[12] = 1.1;
  basis.variance.resize(kJoints);
  double rest = 1.0;
  for (int i = 0; i < kJoints; ++i) {
    const double share = i + 1 == kJoints ? 1.0 : std::max(0.3, first - 0.07 * i);
    basis.variance[i] = 1.1 * rest * share;
    rest *= 1.0 - share;
  }
  basis.count = samples;
  double sum = 0.0;
  Eigen::Index k = 0;
  while (sum < 0.95 * basis.variance.sum()) sum += basis.variance[k++];
  auto& box = item.group.box;
  box.center = basis.mean;
  box.axes = basis.axes.leftCols(k);
  box.half_width = 2.95 * basis.variance.head(k).cwiseSqrt() * 0.5;
  box.scale = Eigen::VectorXd::Ones(kJoints);
  item.group.dof_effective = 15;
  item.group.dropped_channels = {"joint_8.0"};
  Eigen::VectorXd cumulative(kJoints);
  double so_far = 0.0;
  for (int i = 0; i < kJoints; ++i) cumulative[i] = (so_far += basis.variance[i]) / basis.variance.sum();
  item.cumulative_low = (cumulative.array() - 0.5 * (1.0 - cumulative.array()) * 0.5).matrix();
  item.cumulative_high = (cumulative.array() + 0.3 * (1.0 - cumulative.array())).matrix();
  item.full_box = Coverage{0.95, 0.942, 0.917, Interval{0.88, 0.95}};
  item.reduced_box = Coverage{0.984, 0.979, 0.955, Interval{0.93, 0.98}};
  return item;
}

SynergyPart synergies(const robot::RobotModel& hand, Rng& rng) {
  SynergyPart part;
  part.joint_names = hand.joint_names();
  part.grouped_by = "family";
  part.box_root = "n";
  part.groups.push_back(group("pre-grasp", "pre-grasp", 0.62, rng, 8920));
  for (const auto& [name, first] : {std::pair{"1", 0.75}, {"2", 0.6}, {"3", 0.65}, {"4", 0.85}}) {
    part.groups.push_back(group(name, "grasp", first, rng, 2300));
  }
  return part;
}

/// Hand beside the bottle, its palm towards it, the fingers along the tangent.
Grasp grasp(const robot::RobotModel& hand, const std::string& group_name, double around, double closing, Rng& rng) {
  Grasp g;
  g.group = group_name;
  g.coefficients = normals(rng, 4);
  g.slack = 0.03 * normals(rng, kJoints);
  g.q_grasp = rest_configuration(hand);
  for (int j = 0; j < kJoints; ++j) {
    if (j % 4 != 0) g.q_grasp[j] = closing;
  }
  g.q_grasp[12] = 1.3;
  g.q_grasp = hand.clip(g.q_grasp);
  g.q_pregrasp = hand.clip(0.5 * g.q_grasp);
  const Eigen::Vector3d toward(std::cos(around), std::sin(around), 0.0);
  Eigen::Matrix3d R;
  R.col(0) = toward;
  R.col(2) = Eigen::Vector3d::UnitZ().cross(toward);
  R.col(1) = R.col(2).cross(R.col(0));
  g.X_OH.linear() = R;
  g.X_OH.translation() = -0.062 * toward - 0.03 * R.col(2) + Eigen::Vector3d(0, 0, 0.085);
  g.X_OH_pregrasp = g.X_OH;
  g.X_OH_pregrasp.translation() -= 0.08 * toward;
  for (int i = 0; i < 7; ++i) {
    const double angle = around + 0.5 + 0.75 * i;
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    g.contacts.push_back({concat({"link_", std::to_string(i), ".0"}),
                          0.032 * out + Eigen::Vector3d(0, 0, 0.04 + 0.02 * (i % 4)), -out, 0.5});
  }
  g.quality.state = ClosureState::force_closure;
  g.quality.epsilon = 0.12 - 0.01 * around;
  g.quality.min_weight = 0.0041;
  g.quality.convention.rho = 0.108;
  g.arm_solutions.resize(3);
  return g;
}

GraspPart grasps(const robot::RobotModel& hand, Rng& rng) {
  GraspPart part;
  part.object = "bottle";
  for (int i = 0; i < 5; ++i) {
    part.items.push_back(
        {fake_id(rng), grasp(hand, std::to_string(1 + i % 4), -0.8 + 0.45 * i, 0.75 + 0.05 * i, rng), true});
  }
  part.grouped_by = "family";
  part.searches.resize(4);
  for (std::size_t i = 0; i < 4; ++i) {
    part.searches[i].group = std::to_string(i + 1);
    part.searches[i].found = i == 0 ? 2 : 1;
    part.searches[i].trials = 320;
    part.searches[i].rejected = {{"arm collision: link_3.0-shelf", 52}, {"hand collision", 111}, {"no IK", 98}};
    part.searches[i].rejected["not force closure"] = 59 - part.searches[i].found;
  }
  part.searches[1].causes = {{"collision with shelf", "move shelf away from bottle", 163},
                             {"out of the arm's reach", "move the object", 156}};
  return part;
}

PathPart path(const robot::RobotModel& robot, const robot::Scene& scene, const GraspPart& grasps, Rng& rng) {
  PathPart part;
  part.id = fake_id(rng);
  part.reached = {{"", grasps.items.front().id}};
  part.path.joint_names = robot.joint_names();
  Eigen::VectorXd start = rest_configuration(robot);
  start.head(6) << 0.0, -1.57, 1.57, -1.57, -1.57, 0.0;
  Eigen::VectorXd end = start;
  const Eigen::Isometry3d X_WH = scene.body("bottle").X_WB * grasps.items.front().grasp.X_OH;
  double nearest = 1e9;
  const auto solutions = robot::make_inverse_kinematics(robot)(scene.X_WR.inverse() * X_WH, {});
  for (const auto& arm : solutions.value()) {
    if ((arm - start.head(6)).norm() > nearest) continue;
    nearest = (arm - start.head(6)).norm();
    end.head(6) = arm;
  }
  end.tail(kJoints) = grasps.items.front().grasp.q_grasp;
  const int rows = 90;
  part.path.waypoints.resize(rows, robot.dof());
  part.times = Eigen::VectorXd::LinSpaced(rows, 0.0, 4.5);
  for (int i = 0; i < rows; ++i) {
    const double s = smooth(i / (rows - 1.0));
    part.path.waypoints.row(i) = robot.clip(start + s * (end - start)).transpose();
  }
  part.pregrasp = 78;
  for (const auto& [planner, seed] : {std::pair{"synergy", 1}, {"rrtconnect", 1}}) {
    PlanRun run;
    run.planner = planner;
    run.seed = static_cast<std::uint64_t>(seed);
    run.human_likeness = {{83.4, "free-finger recordings (SIMULATED)"}, {91.2, "grasp phase of family 1"}};
    run.result.status = PlanStatus::solved;
    run.result.goal = 2;
    run.result.iterations = 143 * (run.planner == "synergy" ? 1 : 5);
    run.result.extends = 400;
    run.result.extends_grown = 311;
    run.result.collision_checks = 10231;
    run.result.length = 3.12;
    run.result.length_l1 = 9.04;
    part.runs.push_back(run);
  }
  return part;
}

std::vector<ProvenanceItem> provenance(const GraspPart& grasps, const PathPart& path, Rng& rng) {
  std::vector<ProvenanceItem> items;
  std::vector<std::string> recordings;
  for (int i = 0; i < 180; ++i) {
    recordings.push_back(fake_id(rng));
    items.push_back({recordings.back(),
                     "demonstration",
                     concat({"sim_", std::to_string(i)}),
                     "simulate",
                     {},
                     {{"grasp_types.yaml", fake_id(rng)}},
                     "{\"repetitions\":12,\"rate\":50}",
                     1,
                     "0.1.0"});
    items.back().files = {{"grasp_types.yaml", std::string(64, 'a')}};
  }
  const std::string set = fake_id(rng);
  items.push_back(
      {set,
       "synergy_set",
       "family",
       "analyze",
       recordings,
       {},
       "{\"alpha\":0.05,\"beta\":0.05,\"box_root\":\"n\",\"group_by\":\"family\",\"transition\":\"likeness\"}",
       1,
       "0.1.0"});
  for (const auto& item : grasps.items)
    items.push_back({item.id,
                     "grasp",
                     item.grasp.group,
                     "grasp",
                     {set},
                     {{"bottle_shelf.yaml", std::string(64, 'b')}},
                     "{\"count\":5,\"max_trials\":2000,\"mu\":0.5}",
                     1,
                     "0.1.0"});
  items.push_back({path.id,
                   "path",
                   "bottle",
                   "plan",
                   {set, grasps.items[0].id},
                   {},
                   "{\"planner\":\"synergy\",\"step\":0.4}",
                   1,
                   "0.1.0"});
  return items;
}

}  // namespace

ReportInput synthetic_report() {
  const std::string root = OPPONENS_SOURCE_DIR;
  Rng rng = stream(1, "tests/report");
  ReportInput input;
  input.title = "Grasping a bottle on a shelf";
  input.program_version = "0.1.0";
  input.hand.emplace(robot::load_hand(root + "/models/ur5_allegro/allegro_right.yaml"));
  input.robot.emplace(robot::load_robot(root + "/models/ur5_allegro/ur5_allegro_right.yaml"));
  input.scene = robot::load_scene(root + "/models/scenes/bottle_shelf.yaml");
  input.demonstrations = demonstrations(*input.hand, rng);
  input.transitions = transitions(rng);
  input.synergies = synergies(*input.hand, rng);
  input.grasps = grasps(*input.hand, rng);
  input.path = path(*input.robot, *input.scene, *input.grasps, rng);
  input.verification = VerifyPart{
      {"Grasps: the origin is strictly inside the wrench hull (positive span).",
       "Paths: re-checked every 0.002 rad, one tenth of the planner's resolution.", "Content hashes and joint limits."},
      {},
      187,
      0.0062,
      "link_3.0_tip and bottle_left"};
  for (const auto& item : input.grasps->items) input.verification->verdicts.push_back({item.id, "grasp", true, ""});
  input.verification->verdicts.push_back({input.path->id, "path", true, ""});
  input.provenance = provenance(*input.grasps, *input.path, rng);
  input.run = RunPart{"2026-01-01T10:00:00Z host example\nsimulate 0.8 s\nanalyze 2.1 s\ngrasp 14.2 s\nplan 3.3 s",
                      {{"synergy", 3.3}},
                      {{"plan", "2026-01-01T10:00:00Z", 3.3, 3.2, 1, "example"}}};
  return input;
}

}  // namespace opponens::report
