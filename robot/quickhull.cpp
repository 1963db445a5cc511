// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/quickhull.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <utility>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace opponens::robot {

/// qhull keeps pointers to the points and to its stream, so all stay in one place.
struct Quickhull::State {
  explicit State(Eigen::MatrixXd of) : points(std::move(of)) { qh_zero(&qh, sink); }
  ~State() {
    qh_freeqhull(&qh, !qh_ALL);
    int current = 0;
    int total = 0;
    qh_memfreeshort(&qh, &current, &total);
    if (sink != nullptr) std::fclose(sink);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  Eigen::MatrixXd points;
  std::FILE* sink = std::fopen("/dev/null", "w");  // qhull reports flat sets at length
  qhT qh;
};

Quickhull::Quickhull(std::unique_ptr<State> state) : state_(std::move(state)) {}
Quickhull::Quickhull(Quickhull&& other) noexcept = default;
Quickhull::~Quickhull() = default;

std::optional<Quickhull> Quickhull::build(Eigen::MatrixXd points, const std::string& options) {
  if (points.cols() < points.rows() + 1) return std::nullopt;
  auto state = std::make_unique<State>(std::move(points));
  std::string command = "qhull " + options;
  Eigen::MatrixXd& kept = state->points;
  const int error = qh_new_qhull(&state->qh, static_cast<int>(kept.rows()), static_cast<int>(kept.cols()), kept.data(),
                                 false, command.data(), nullptr, state->sink);
  if (error != 0) return std::nullopt;
  return Quickhull(std::move(state));
}

std::vector<Eigen::Index> Quickhull::vertices() const {
  std::vector<Eigen::Index> columns;
  for (const vertexT* vertex = state_->qh.vertex_list; vertex != nullptr && vertex->next != nullptr;
       vertex = vertex->next) {
    columns.push_back((vertex->point - state_->points.data()) / state_->points.rows());
  }
  return columns;
}

double Quickhull::volume() {
  qh_getarea(&state_->qh, state_->qh.facet_list);
  return state_->qh.totvol;
}

double Quickhull::least_offset() const {
  double least = std::numeric_limits<double>::infinity();
  for (const facetT* facet = state_->qh.facet_list; facet != nullptr && facet->next != nullptr; facet = facet->next) {
    if (facet->normal != nullptr) least = std::min(least, -facet->offset);
  }
  return least;
}

}  // namespace opponens::robot
