// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/picture.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "report/facets.hpp"
#include "robot/mesh.hpp"
#include "tests/report/markup_check.hpp"

namespace opponens::report {
namespace {

Eigen::Vector3d random_vector(Rng& rng) { return {rng.normal(), rng.normal(), rng.normal()}; }

/// Boxes, cylinders and spheres thrown together, many of them overlapping; paint = body.
std::vector<Facet> heap(Rng& rng, int bodies) {
  std::vector<Facet> all;
  for (int i = 0; i < bodies; ++i) {
    // One draw after the other: the order of a call's arguments is the compiler's.
    const double depth = rng.uniform(0.1, 0.8);
    const double width = rng.uniform(0.1, 0.8);
    robot::Geometry geometry{robot::Box{Eigen::Vector3d(width, depth, 0.3)}};
    if (i % 3 == 1) geometry.shape = robot::Cylinder{rng.uniform(0.05, 0.3), rng.uniform(0.2, 1.0)};
    if (i % 3 == 2) geometry.shape = robot::Sphere{rng.uniform(0.1, 0.4)};
    const Eigen::Vector3d place = 0.5 * random_vector(rng);
    const Eigen::Vector3d axis = random_vector(rng).normalized();
    geometry.X_BG = Eigen::Translation3d(place) * Eigen::AngleAxisd(rng.uniform(0, 3), axis);
    const auto part = facets(geometry, i, {10, 100});
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

/// Height along `toward` at which the line (u, v) pierces a facet; nullopt when it misses, or passes within 1e-5 m of
/// its rim.
std::optional<double> pierce(const Facet& facet, const View& view, const Eigen::Vector2d& at) {
  const auto flat = [&](const Eigen::Vector3d& p) { return Eigen::Vector2d(view.right.dot(p), view.up.dot(p)); };
  for (std::size_t i = 0; i < facet.corners.size(); ++i) {
    const Eigen::Vector2d a = flat(facet.corners[i]);
    const Eigen::Vector2d edge = flat(facet.corners[(i + 1) % facet.corners.size()]) - a;
    const Eigen::Vector2d to = at - a;
    if (edge.x() * to.y() - edge.y() * to.x() < 1e-5 * edge.norm()) return std::nullopt;
  }
  const Eigen::Vector3d base = at.x() * view.right + at.y() * view.up;
  return facet.normal.dot(facet.corners.front() - base) / facet.normal.dot(view.toward);
}

/// Share of random lines of sight on which the facet painted last is not the nearest one.
double wrong_share(const std::vector<Facet>& painted, const std::vector<Facet>& truth, const View& view, Rng& rng) {
  int hits = 0;
  int wrong = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d at(rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0));
    std::optional<double> nearest;
    for (const auto& facet : truth) {
      if (facet.normal.dot(view.toward) <= 1e-6) continue;
      const auto height = pierce(facet, view, at);
      if (height && (!nearest || *height > *nearest)) nearest = height;
    }
    std::optional<double> last;
    for (const auto& facet : painted) {
      if (const auto height = pierce(facet, view, at)) last = height;
    }
    if (!nearest || !last) continue;
    ++hits;
    wrong += std::abs(*nearest - *last) > 1e-5;
  }
  EXPECT_GT(hits, 200);
  return static_cast<double>(wrong) / std::max(1, hits);
}

TEST(PaintersOrder, LastPaintedIsNearestToTheViewer) {
  for (int seed = 1; seed <= 5; ++seed) {
    Rng rng = stream(static_cast<std::uint64_t>(seed), "heap");
    const auto bodies = heap(rng, 12);
    const View view = fit_view(random_vector(rng), Eigen::Vector3d::UnitZ(), {{0, 0, 0}, {1, 1, 1}}, 100, 100, 1);
    const auto ordered = back_to_front(bodies, view.toward);
    EXPECT_EQ(wrong_share(ordered, bodies, view, rng), 0.0) << seed;
    auto front_only = bodies;
    std::erase_if(front_only, [&](const Facet& facet) { return facet.normal.dot(view.toward) <= 1e-6; });
    EXPECT_GT(wrong_share(front_only, bodies, view, rng), 0.02) << "the unordered list must be seen to be wrong";
  }
}

TEST(Facets, OfClosedShapesPointOutwardAndClose) {
  Rng rng = stream(5, "shapes");
  const auto mesh = std::make_shared<const robot::TriangleMesh>(
      robot::revolve({{0.02, 0.0}, {0.03, 0.05}, {0.03, 0.1}, {0.01, 0.12}}, 24));
  robot::TriangleMesh turned = *mesh;
  turned.triangles.row(0).swap(turned.triangles.row(1));
  const std::vector<robot::Shape> shapes{robot::Box{{0.1, 0.2, 0.3}}, robot::Cylinder{0.1, 0.4}, robot::Sphere{0.2},
                                         mesh, std::make_shared<const robot::TriangleMesh>(turned)};
  for (const auto& shape : shapes) {
    const robot::Geometry geometry{shape, Eigen::Isometry3d(Eigen::Translation3d(random_vector(rng)))};
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    double volume = 0.0;
    for (const auto& facet : facets(geometry, 0, {24, 100000})) {
      Eigen::Vector3d twice = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < facet.corners.size(); ++i) {
        twice += facet.corners[i].cross(facet.corners[(i + 1) % facet.corners.size()]);
      }
      area += 0.5 * twice;
      volume += 0.5 * twice.dot(facet.corners.front()) / 3.0;
      EXPECT_NEAR(facet.normal.dot(twice.normalized()), 1.0, 1e-9);
    }
    EXPECT_LT(area.norm(), 1e-12) << "a closed surface has no net area";
    EXPECT_GT(volume, 0.0) << "normals point outward";
    if (std::holds_alternative<robot::Box>(shape)) {
      EXPECT_NEAR(volume, 0.006, 1e-12);
    }
    if (std::holds_alternative<robot::Cylinder>(shape)) {
      EXPECT_NEAR(volume, 0.004 * std::numbers::pi, 0.02 * 0.004 * std::numbers::pi);
    }
  }
}

TEST(Facets, SimplifiedMeshIsSmallAndKeepsTheShape) {
  const robot::TriangleMesh fine = robot::triangulate(robot::Sphere{0.1}, 128);
  const robot::TriangleMesh coarse = simplified(fine, 500);
  ASSERT_GT(fine.triangles.cols(), 5000);
  EXPECT_LE(coarse.triangles.cols(), 500);
  EXPECT_GE(coarse.triangles.cols(), 100);
  const double sphere = robot::mass_properties(fine).volume;
  EXPECT_NEAR(robot::mass_properties(coarse).volume, sphere, 0.1 * sphere);
  EXPECT_EQ(simplified(coarse, 500).triangles, coarse.triangles);
  EXPECT_THROW(simplified(fine, 1), std::invalid_argument);
}

TEST(View, ShowsAllPointsInsideTheMargin) {
  Rng rng = stream(9, "view");
  for (int round = 0; round < 50; ++round) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 20; ++i) points.push_back(random_vector(rng));
    const View view = fit_view(random_vector(rng), Eigen::Vector3d::UnitZ(), points, 300, 200, 15);
    EXPECT_NEAR(view.right.cross(view.up).dot(view.toward), 1.0, 1e-12);
    for (const auto& p : points) {
      const Eigen::Vector2d at = view.project(p);
      EXPECT_TRUE(at.x() > 14.99 && at.x() < 285.01 && at.y() > 14.99 && at.y() < 185.01) << at.transpose();
    }
  }
  EXPECT_THROW(fit_view(Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ(), {{0, 0, 0}}, 10, 10, 1),
               std::invalid_argument);
  EXPECT_THROW(fit_view(Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ(), {}, 10, 10, 1), std::invalid_argument);
}

std::string picture(bool front_box, bool shows_through) {
  std::vector<Facet> bodies = facets({robot::Sphere{0.1}, Eigen::Isometry3d::Identity()}, 0, {});
  if (front_box) {
    append(bodies, facets({robot::Box{{0.01, 1, 1}}, Eigen::Isometry3d::Identity()}, 1, {}),
           Eigen::Isometry3d(Eigen::Translation3d(1, 0, 0)));
  }
  const View view =
      fit_view(Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ(), {{0, -0.4, -0.4}, {0, 0.4, 0.4}}, 80, 80, 2);
  Svg svg(80, 80, "t");
  draw_facets(svg, view, bodies, {{255, 0, 0, shows_through}, {0, 0, 255, false}});
  return svg.str();
}

TEST(Picture, LeavesHiddenBodiesOutOrShowsThemAsGhosts) {
  const auto reds = [](const std::string& svg) {
    const auto colors = attribute_values(svg, "color");
    return std::count_if(colors.begin(), colors.end(), [](const std::string& c) { return c.ends_with("0000"); });
  };
  EXPECT_GT(reds(picture(false, false)), 0);
  EXPECT_EQ(reds(picture(true, false)), 0);
  EXPECT_GT(reds(picture(true, true)), 0);
  EXPECT_NE(picture(true, true).find("opacity"), std::string::npos);
  EXPECT_EQ(picture(false, true).find("opacity"), std::string::npos);
  EXPECT_EQ(markup_problems(picture(true, true)), std::vector<std::string>{});
}

}  // namespace
}  // namespace opponens::report
