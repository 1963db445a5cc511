// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Grasp quality of 18 contacts with 8 cone edges each (and of an Allegro hand's grasps of ten objects: 4 to 18
// contacts), from the primitive wrenches. One iteration is one value. Ours: epsilon by the growing polytope, l* with
// its gradient, both with the wrenches made (evaluate). Peers: the whole hull by qhull ("Qt Q12"), and by CGAL's dD
// triangulation. Counter error: the largest difference from qhull over the sets.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <benchmark/benchmark.h>

#include "cgal_hull_peer.hpp"
#include "contact_sets.hpp"
#include "grasp/min_weight.hpp"
#include "grasp/origin_ball.hpp"
#include "grasp/quality.hpp"
#include "grasp/wrench_gradient.hpp"
#include "grasp/wrench_hull.hpp"

namespace {

using namespace opponens;
using grasp::Matrix6Xd;

struct Group {
  std::string name;
  std::vector<ContactSet> sets;
  std::vector<Matrix6Xd> wrenches;
};
using SharedGroup = std::shared_ptr<const Group>;

SharedGroup group(const std::string& name, std::vector<ContactSet> sets) {
  Group made{name, std::move(sets), {}};
  for (const ContactSet& set : made.sets)
    made.wrenches.push_back(grasp::contact_wrenches(set.contacts, set.convention));
  return std::make_shared<const Group>(std::move(made));
}

/// Runs work(i) over the sets in turn.
template <typename Work>
void over_sets(benchmark::State& state, const Group& group, const Work& work) {
  std::size_t next = 0;
  for (auto _ : state) {
    work(next);
    next = (next + 1) % group.sets.size();
  }
  state.SetItemsProcessed(state.iterations());
}

void ours_epsilon(benchmark::State& state, const SharedGroup& group, WrenchNorm norm) {
  double error = 0.0;
  double facets = 0.0;
  const auto ball_of = [&](std::size_t i) {
    return grasp::largest_origin_ball(grasp::WrenchSpace(group->wrenches[i], group->sets[i].convention.edges, norm));
  };
  for (std::size_t i = 0; i < group->sets.size(); ++i) {
    const grasp::OriginBall ball = ball_of(i);
    facets += static_cast<double>(ball.facets) / static_cast<double>(group->sets.size());
    if (norm != WrenchNorm::l1 || !ball.inside) continue;
    const auto hull = grasp::wrench_hull(group->wrenches[i]);
    if (hull) error = std::max(error, std::abs(hull->least_offset - ball.radius));
  }
  over_sets(state, *group, [&](std::size_t i) { benchmark::DoNotOptimize(ball_of(i)); });
  if (norm == WrenchNorm::l1) state.counters["error"] = error;
  state.counters["facets"] = facets;
}

void ours_evaluate(benchmark::State& state, const SharedGroup& group) {
  over_sets(state, *group, [&](std::size_t i) {
    benchmark::DoNotOptimize(grasp::evaluate(group->sets[i].contacts, group->sets[i].convention));
  });
}

void ours_min_weight_with_gradient(benchmark::State& state, const SharedGroup& group) {
  over_sets(state, *group, [&](std::size_t i) {
    const grasp::MinWeight solution = grasp::min_weight(group->wrenches[i]);
    benchmark::DoNotOptimize(grasp::min_weight_gradient(solution));
  });
}

/// The same from the contacts, with the gradient by their positions and normals.
void ours_min_weight_with_contact_gradient(benchmark::State& state, const SharedGroup& group) {
  over_sets(state, *group, [&](std::size_t i) {
    const ContactSet& set = group->sets[i];
    const grasp::MinWeight solution = grasp::min_weight(grasp::contact_wrenches(set.contacts, set.convention));
    benchmark::DoNotOptimize(
        grasp::contact_gradient(set.contacts, set.convention, grasp::min_weight_gradient(solution)));
  });
}

void qhull_epsilon(benchmark::State& state, const SharedGroup& group) {
  over_sets(state, *group, [&](std::size_t i) { benchmark::DoNotOptimize(grasp::wrench_hull(group->wrenches[i])); });
}

void cgal_epsilon(benchmark::State& state, const SharedGroup& group) {
  const auto peer = grasp::wrench_hull(group->wrenches.front());
  state.counters["error"] = std::abs(cgal_hull(group->wrenches.front()).least_offset - peer->least_offset);
  over_sets(state, *group, [&](std::size_t i) { benchmark::DoNotOptimize(cgal_hull(group->wrenches[i])); });
}

void register_group(const SharedGroup& group) {
  const auto add = [&](const std::string& what, auto function, auto... arguments) {
    return benchmark::RegisterBenchmark((what + "/" + group->name).c_str(), function, group, arguments...);
  };
  add("ours_epsilon", ours_epsilon, WrenchNorm::l1)->Unit(benchmark::kMicrosecond);
  add("ours_epsilon_linf", ours_epsilon, WrenchNorm::linf)->Unit(benchmark::kMicrosecond);
  add("ours_min_weight_with_gradient", ours_min_weight_with_gradient)->Unit(benchmark::kMicrosecond);
  add("ours_min_weight_with_contact_gradient", ours_min_weight_with_contact_gradient)->Unit(benchmark::kMicrosecond);
  add("ours_evaluate", ours_evaluate)->Unit(benchmark::kMicrosecond);
  add("qhull_epsilon", qhull_epsilon)->Unit(benchmark::kMicrosecond);
  add("cgal_epsilon", cgal_epsilon)->Unit(benchmark::kMicrosecond);
}

}  // namespace

int main(int argc, char** argv) {
  register_group(group("cylinder18", {cylinder_of_eighteen()}));
  for (const ContactSet& set : reference_sets_of_eighteen()) register_group(group(set.name, {set}));
  if (std::vector<ContactSet> sets = allegro_sets(); !sets.empty()) register_group(group("allegro50", std::move(sets)));
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
