// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <cstdio>
#include <ctime>
#include "core/require.hpp"
#include "fcl_peer.hpp"
#include "robot/collision.hpp"
#include "shelf_motions.hpp"
using namespace opponens;
using namespace opponens::benchmarks;
static double cpu() { timespec t; clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t); return t.tv_sec + 1e-9 * t.tv_nsec; }
int main() {
  const std::filesystem::path root = OPPONENS_SOURCE_DIR;
  setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 0);
  for (const char* kind : {"urdf", "visual"}) {
    if (getenv("KIND") && std::string(getenv("KIND")) != kind) continue;
    double t0 = cpu();
    auto problem = shelf_problem(root / ("tests/data/robots/paper_lab_ur5_allegro_right_" + std::string(kind) + ".yaml"),
                                 root / "models/scenes/cylinder_shelf.yaml");
    double t1 = cpu();
    const auto motions = record_motions(problem, 300);
    double t2 = cpu();
    std::printf("%s: set up %.2f s, goals %zu, record %.2f s\n", kind, t1 - t0, problem.goals.size(), t2 - t1);
    t0 = cpu();
    robot::CollisionChecker truth(problem.robot, problem.scene);
    std::printf("truth built %.3f\n", cpu() - t0);
    t0 = cpu();
    FclPeer peer(problem.robot, problem.scene);
    std::printf("peer built %.3f\n", cpu() - t0);
    long n = 0, nfree = 0, agree = 0, m_free = 0;
    double t_truth = 0, t_peer = 0, t_truth_free = 0, t_peer_free = 0;
    std::vector<Eigen::MatrixXd> confs;
    for (auto& m : motions) confs.push_back(configurations_of(m, problem.robot.weights()));
    for (auto& c : confs) {
      bool all = true;
      for (Eigen::Index i = 0; i < c.rows() && all; ++i) {
        const Eigen::VectorXd q = c.row(i);
        double a = cpu(); bool f = truth.exact_free(q); double b = cpu(); bool g = peer.free(q); double d = cpu();
        t_truth += b - a; t_peer += d - b; ++n; nfree += f; agree += f == g;
        if (f) { t_truth_free += b - a; t_peer_free += d - b; }
        all = f;
      }
      m_free += all;
    }
    std::printf("%ld configs %.1f%% free, motions %zu, %.1f%% free, agree %ld; truth %.2f us (free %.2f, coll %.2f), peer %.2f us (free %.2f coll %.2f)\n", n, 100.0 * nfree / n,
      motions.size(), 100.0 * m_free / motions.size(), agree, 1e6 * t_truth / n, 1e6*t_truth_free/nfree, 1e6*(t_truth-t_truth_free)/(n-nfree), 1e6 * t_peer / n,1e6*t_peer_free/nfree, 1e6*(t_peer-t_peer_free)/(n-nfree));
    std::vector<robot::ConfigurationBatch> batches(confs.begin(), confs.end());
    for (int rep = 0; rep < 3; ++rep) {
      robot::CollisionCounts counts;
      long bad = 0, fr = 0;
      double a = cpu();
      for (auto& b : batches) fr += !truth.first_colliding(b, &counts);
      double b = cpu();
      std::printf("two-stage %.3f us per config of the peer; motions free %ld (%ld); configs %ld pairs asked %ld  speed-up peer %.1f\n", 1e6 * (b - a) / n, fr, m_free, counts.configurations, counts.pairs, t_peer / (b - a));
      robot::ConfigurationBatch one(1, problem.robot.dof());
      a = cpu();
      for (auto& c : batches) for (Eigen::Index i = 0; i < c.rows(); ++i) bad += truth.free(Eigen::VectorXd(c.row(i))) ;
      b = cpu();
      long tot = 0; for (auto& c : batches) tot += c.rows();
      std::printf("single %.3f us (%ld configs, free %ld)\n", 1e6 * (b - a) / tot, tot, bad);
    }
    long diff = 0, tot = 0;
    for (auto& c : batches) { auto v = truth.free_rows(c); for (Eigen::Index i = 0; i < c.rows(); ++i) { ++tot; diff += v[i] != truth.exact_free(Eigen::VectorXd(c.row(i))); } }
    std::printf("different verdicts %ld of %ld\n", diff, tot);
  }
}
