// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/self_collision.hpp"

#include <cmath>
#include <map>
#include <string>

#include "core/require.hpp"
#include "robot/collision.hpp"
#include "robot/link_pairs.hpp"

namespace opponens::robot {

namespace {

RobotDescription nothing_allowed(RobotDescription description) {
  description.allowed_collisions.clear();
  return description;
}

/// The pairs of links with geometry, and where each is found by its links' indices.
struct PairTable {
  std::vector<LinkPairHits> pairs;
  std::map<std::pair<int, int>, std::size_t> place;
};

PairTable pair_table(const RobotDescription& description) {
  RobotDescription plain = nothing_allowed(description);
  allow_adjacent(plain);
  PairTable table;
  const int links = static_cast<int>(description.links.size());
  for (int a = 0; a < links; ++a) {
    for (int b = a + 1; b < links; ++b) {
      if (description.links[static_cast<std::size_t>(a)].collision.empty()) continue;
      if (description.links[static_cast<std::size_t>(b)].collision.empty()) continue;
      table.place[{a, b}] = table.pairs.size();
      table.pairs.push_back(
          {a, b, plain.allowed_collisions.contains({a, b}), description.allowed_collisions.contains({a, b}), false, 0});
    }
  }
  return table;
}

}  // namespace

SelfCollisionSamples sample_self_collisions(const RobotModel& robot, int samples,
                                            const std::function<void(std::size_t, std::size_t)>& progress, Rng& rng) {
  require(samples > 0, "sample_self_collisions: needs at least one sample");
  const CollisionChecker checker(RobotModel(nothing_allowed(robot.description())), Scene{});
  PairTable table = pair_table(robot.description());
  std::map<std::string, int> index;
  for (std::size_t i = 0; i < robot.links().size(); ++i) index[robot.links()[i].name] = static_cast<int>(i);
  const auto pairs_at = [&](const Eigen::VectorXd& q) {
    std::vector<LinkPairHits*> met;
    for (const BodyPair& pair : checker.colliding_pairs(q)) {
      met.push_back(&table.pairs[table.place.at(std::minmax(index.at(pair.first), index.at(pair.second)))]);
    }
    return met;
  };
  for (LinkPairHits* pair : pairs_at(robot.clip(Eigen::VectorXd::Zero(robot.dof())))) pair->at_rest = true;
  SelfCollisionSamples result{samples, 0, {}};
  Eigen::VectorXd q(robot.dof());
  for (int sample = 0; sample < samples; ++sample) {
    for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = rng.uniform(robot.lower()[i], robot.upper()[i]);
    bool forbidden = false;
    for (LinkPairHits* pair : pairs_at(q)) {
      ++pair->hits;
      forbidden = forbidden || !pair->allowed;
    }
    result.colliding += forbidden ? 1 : 0;
    if (progress) progress(static_cast<std::size_t>(sample) + 1, static_cast<std::size_t>(samples));
  }
  result.pairs = std::move(table.pairs);
  return result;
}

AllowedSuggestion suggest_allowed(const SelfCollisionSamples& samples) {
  AllowedSuggestion suggestion;
  for (const LinkPairHits& pair : samples.pairs) {
    if (pair.adjacent || pair.allowed) continue;
    if (pair.hits == samples.samples) {
      suggestion.always.push_back(pair);
    } else if (pair.at_rest) {
      suggestion.at_rest.push_back(pair);
    } else if (2 * pair.hits >= samples.samples) {
      suggestion.often.push_back(pair);
    } else if (pair.hits == 0) {
      suggestion.never.push_back(pair);
    }
  }
  return suggestion;
}

double never_bound(int samples, double confidence) {
  require(samples > 0 && confidence > 0.0 && confidence < 1.0, "never_bound: needs samples and a confidence in (0, 1)");
  return -std::expm1(std::log1p(-confidence) / samples);
}

}  // namespace opponens::robot
