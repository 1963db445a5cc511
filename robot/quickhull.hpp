// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace opponens::robot {

/// The convex hull of points, built and owned by qhull (Barber, Dobkin, Huhdanpaa 1996, doi:10.1145/235815.235821).
class Quickhull {
 public:
  Quickhull(Quickhull&& other) noexcept;
  ~Quickhull();

  /// Points [d x n], d >= 2, finite; options as qhull's command line writes them ("Qt"). nullopt when qhull finds no
  /// volume: fewer than d + 1 points, or points that are flat to its rounding.
  static std::optional<Quickhull> build(Eigen::MatrixXd points, const std::string& options);

  std::vector<Eigen::Index> vertices() const;  ///< columns of the points, each once, in qhull's order
  double volume();                             ///< of d dimensions
  /// The smallest distance of the origin from a facet's plane; negative when the origin lies outside.
  double least_offset() const;

 private:
  struct State;
  explicit Quickhull(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace opponens::robot
