// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cgal_hull_peer.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <CGAL/Epick_d.h>
#include <CGAL/Triangulation.h>
#include <Eigen/QR>

namespace opponens {

CgalHull cgal_hull(const Eigen::Matrix<double, 6, Eigen::Dynamic>& points) {
  using Kernel = CGAL::Epick_d<CGAL::Dimension_tag<6>>;
  using Triangulation = CGAL::Triangulation<Kernel>;
  std::vector<Triangulation::Point> input;
  Eigen::Matrix<double, 6, 1> center = points.rowwise().mean();
  for (Eigen::Index j = 0; j < points.cols(); ++j) input.emplace_back(points.col(j).data(), points.col(j).data() + 6);
  Triangulation triangulation(6);
  triangulation.insert(input.begin(), input.end());
  CgalHull hull{std::numeric_limits<double>::infinity(), 0};
  std::vector<Triangulation::Full_cell_handle> cells;
  triangulation.incident_full_cells(triangulation.infinite_vertex(), std::back_inserter(cells));
  for (const auto& cell : cells) {
    Eigen::Matrix<double, 6, 6> corners;
    int count = 0;
    for (int i = 0; i <= 6; ++i) {
      if (triangulation.is_infinite(cell->vertex(i))) continue;
      const auto& p = cell->vertex(i)->point();
      for (int k = 0; k < 6; ++k) corners(k, count) = p[k];
      ++count;
    }
    const Eigen::Matrix<double, 6, 5> edges = corners.rightCols<5>().colwise() - corners.col(0);
    const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, 6, 5>> qr(edges);
    ++hull.facets;
    // Exact predicates see the rounding of coplanar edges of a friction cone as slivers, whose planes mean nothing.
    if (std::abs(qr.matrixR()(4, 4)) < 1e-9 * std::abs(qr.matrixR()(0, 0))) continue;
    Eigen::Matrix<double, 6, 1> normal = qr.householderQ() * Eigen::Matrix<double, 6, 1>::Unit(5);
    if (normal.dot(corners.col(0) - center) < 0.0) normal = -normal;
    hull.least_offset = std::min(hull.least_offset, normal.dot(corners.col(0)));
  }
  return hull;
}

}  // namespace opponens
