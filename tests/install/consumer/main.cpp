// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Uses one function each of analysis, grasp, motion and storage from the installed package.
#include <cmath>
#include <cstdio>

#include "analysis/synergy_box.hpp"
#include "grasp/quality.hpp"
#include "motion/syn_planner.hpp"
#include "storage/record.hpp"

namespace {

using namespace opponens;

SynergyBox unit_box() {
  SynergyBox box;
  box.center = Eigen::VectorXd::Zero(2);
  box.axes = Eigen::MatrixXd::Identity(2, 1);
  box.half_width = Eigen::VectorXd::Ones(1);
  box.scale = Eigen::VectorXd::Ones(2);
  return box;
}

bool projects() { return analysis::project(unit_box(), Eigen::Vector2d(3.0, 4.0)).isApprox(Eigen::Vector2d(1.0, 0.0)); }

bool scores_a_tripod() {
  std::vector<Contact> contacts;
  for (int i = 0; i < 3; ++i) {
    const double angle = 2.0 * M_PI * i / 3.0;
    const Eigen::Vector3d p(std::cos(angle), std::sin(angle), 0.0);
    contacts.push_back({"tip", 0.05 * p, -p, 0.5});
  }
  QualityConvention convention;
  convention.rho = 0.05;
  const auto quality = grasp::evaluate(contacts, convention);
  return quality.force_closure() && std::abs(*quality.epsilon - 0.2759251556) < 1e-6;  // qhull's value
}

bool plans_in_free_space() {
  motion::World world;
  world.first_invalid = [](const Eigen::VectorXd&, const Eigen::VectorXd&, std::int64_t& checks) {
    ++checks;
    return std::optional<double>();
  };
  world.free = [](const Eigen::MatrixXd& batch, std::int64_t& checks) {
    checks += batch.rows();
    return std::vector<bool>(static_cast<std::size_t>(batch.rows()), true);
  };
  PlanningGroup hand{"hand", {"a", "b"}, 0, 2};
  const Eigen::Vector2d goal(0.8, 0.0);
  const auto result = motion::plan(Eigen::Vector2d::Zero(), unit_box(), {{goal, unit_box(), 7}}, {"a", "b"}, hand,
                                   Eigen::Vector2d::Constant(-1.0), Eigen::Vector2d::Constant(1.0),
                                   Eigen::Vector2d::Ones(), world, {}, 1);
  return result.status == PlanStatus::solved && result.goal == 7 &&
         result.path.waypoints.bottomRows(1).transpose().isApprox(goal);
}

}  // namespace

int main() {
  if (!projects()) return std::puts("consumer: projection is wrong"), 1;
  if (!scores_a_tripod()) return std::puts("consumer: quality is wrong"), 1;
  if (!plans_in_free_space()) return std::puts("consumer: planner is wrong"), 1;
  if (storage::content_hash({}).size() != 64) return std::puts("consumer: no content hash"), 1;
  return std::puts("consumer: the installed package works"), 0;
}
