// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Certificates of force closure: making one, re-checking it, and CGAL's exact linear programme on the same edges
// (peer). 20 random force-closure sets of as many contacts on a sphere as the argument says, 8 edges each; with the
// argument 0 the 50 grasps of GraspIt! in the shared reference data, where they are there.
#include <filesystem>
#include <fstream>
#include <vector>

#include <benchmark/benchmark.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "core/rng.hpp"
#include "grasp/certificate.hpp"
#include "grasp/quality.hpp"
#include "tests/grasp/exact_oracle.hpp"
#include "tests/grasp/random_contacts.hpp"
#include "verify/certificate.hpp"

namespace {

using namespace opponens;

using Contacts = std::vector<Contact>;

const std::filesystem::path kGraspIt = OPPONENS_SHARED_DATA "/reference/graspit_ycb_top5";

std::vector<Contacts> graspit_sets() {
  std::vector<Contacts> sets;
  const auto vector = [](const nlohmann::json& j) { return Eigen::Vector3d(j[0], j[1], j[2]); };
  for (const auto& file : std::filesystem::directory_iterator(kGraspIt)) {
    const auto document = nlohmann::json::parse(std::ifstream(file.path()));
    for (const auto& grasp : document["grasps"]) {
      sets.emplace_back();
      for (const auto& k : grasp["contacts"]) {
        sets.back().push_back({"", 1e-3 * vector(k["p"]), vector(k["n"]).normalized(), k["mu"]});
      }
    }
  }
  return sets;
}

std::vector<Contacts> closed_sets(std::int64_t contacts) {
  if (contacts == 0) return graspit_sets();
  Rng rng = stream(1, "certificate_benchmark");
  std::vector<Contacts> sets;
  while (sets.size() < 20) {
    const Contacts set = test::random_contacts(static_cast<int>(contacts), 0.2, rng);
    if (grasp::evaluate(set, {}).force_closure()) sets.push_back(set);
  }
  return sets;
}

void certify(benchmark::State& state) {
  const std::vector<Contacts> sets = closed_sets(state.range(0));
  std::size_t next = 0;
  double edges = 0.0;
  double digits = 0.0;
  double made = 0.0;
  for (auto _ : state) {
    const auto certificate = grasp::certify(sets[next++ % sets.size()], QualityConvention{});
    if (!certificate) {
      state.SkipWithError("a force-closure set was not certified");
      break;
    }
    made += 1.0;
    edges += static_cast<double>(certificate->edges.size());
    digits += static_cast<double>(certificate->edges.front().coefficient.size());
  }
  state.counters["edges"] = edges / made;
  state.counters["digits"] = digits / made;
}

void recheck(benchmark::State& state) {
  const std::vector<Contacts> sets = closed_sets(state.range(0));
  std::vector<Certificate> certificates;
  for (const Contacts& set : sets) certificates.push_back(grasp::certify(set, QualityConvention{}).value());
  std::size_t next = 0;
  for (auto _ : state) {
    const std::size_t i = next++ % sets.size();
    if (!verify::certificate_fault(certificates[i], sets[i], {}).empty()) {
      state.SkipWithError("a certificate does not hold");
      break;
    }
  }
}

void bound_of_epsilon(benchmark::State& state) {
  const std::vector<Contacts> sets = closed_sets(state.range(0));
  std::vector<GraspQuality> qualities;
  for (const Contacts& set : sets) qualities.push_back(grasp::evaluate(set, {}));
  std::size_t next = 0;
  for (auto _ : state) {
    const std::size_t i = next++ % sets.size();
    benchmark::DoNotOptimize(grasp::epsilon_bound(sets[i], {}, qualities[i].direction));
  }
}

void cgal_exact_programme(benchmark::State& state) {
  const std::vector<Contacts> sets = closed_sets(state.range(0));
  std::size_t next = 0;
  for (auto _ : state) {
    if (!test::balance(test::oracle_wrenches(sets[next++ % sets.size()], {}))) {
      state.SkipWithError("CGAL finds a force-closure set open");
      break;
    }
  }
}

void arguments(benchmark::internal::Benchmark* benchmark) {
  benchmark->Arg(4)->Arg(18)->Unit(benchmark::kMicrosecond);
  if (std::filesystem::exists(kGraspIt)) benchmark->Arg(0);
}

BENCHMARK(certify)->Apply(arguments);
BENCHMARK(recheck)->Apply(arguments);
BENCHMARK(bound_of_epsilon)->Apply(arguments);
BENCHMARK(cgal_exact_programme)->Apply(arguments);

}  // namespace
