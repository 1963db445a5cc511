// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/mesh_repair.hpp"

#include <algorithm>
#include <array>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/box_intersection_d.h>

#include "core/require.hpp"
#include "robot/mesh.hpp"
#include "robot/mesh_topology.hpp"

namespace opponens::robot {

namespace {

namespace processing = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;
using Corners = std::array<std::size_t, 3>;

struct Soup {
  std::vector<Point> points;
  std::vector<Corners> triangles;
};

Soup soup_of(const TriangleMesh& mesh) {
  Soup soup;
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
    soup.points.emplace_back(mesh.vertices(0, v), mesh.vertices(1, v), mesh.vertices(2, v));
  }
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    const auto corner = [&](int k) { return static_cast<std::size_t>(mesh.triangles(k, f)); };
    soup.triangles.push_back({corner(0), corner(1), corner(2)});
  }
  return soup;
}

/// Vertices and faces in the order of the surface, which is the same on every run.
TriangleMesh mesh_of(const Surface& surface, const std::string& source) {
  TriangleMesh mesh;
  mesh.source = source;
  mesh.vertices.resize(3, static_cast<Eigen::Index>(surface.number_of_vertices()));
  mesh.triangles.resize(3, static_cast<Eigen::Index>(surface.number_of_faces()));
  std::vector<int> index(surface.num_vertices(), -1);
  int count = 0;
  for (const Surface::Vertex_index v : surface.vertices()) {
    const Point& p = surface.point(v);
    mesh.vertices.col(count) << p.x(), p.y(), p.z();
    index[v.idx()] = count++;
  }
  Eigen::Index f = 0;
  for (const Surface::Face_index face : surface.faces()) {
    int k = 0;
    for (const Surface::Vertex_index v : vertices_around_face(surface.halfedge(face), surface)) {
      mesh.triangles(k++, f) = index[v.idx()];
    }
    ++f;
  }
  return mesh;
}

/// Whether two triangles meet in more than the vertices that they share. Corners that both have come first.
bool cross(const Soup& soup, const Corners& a, const Corners& b) {
  const auto point = [&](std::size_t i) { return soup.points[i]; };
  std::vector<std::size_t> shared;
  std::vector<std::size_t> only_a;
  std::vector<std::size_t> only_b;
  for (const std::size_t i : a) (std::count(b.begin(), b.end(), i) > 0 ? shared : only_a).push_back(i);
  for (const std::size_t i : b) {
    if (std::count(a.begin(), a.end(), i) == 0) only_b.push_back(i);
  }
  if (shared.size() == 3) return false;
  if (shared.size() == 2) {  // folded onto each other
    const Point p = point(shared[0]), q = point(shared[1]), r = point(only_a[0]), s = point(only_b[0]);
    return CGAL::coplanar(p, q, r, s) && CGAL::coplanar_orientation(p, q, r, s) == CGAL::POSITIVE;
  }
  const Kernel::Triangle_3 of_a(point(a[0]), point(a[1]), point(a[2]));
  const Kernel::Triangle_3 of_b(point(b[0]), point(b[1]), point(b[2]));
  if (shared.size() == 1) {
    return CGAL::do_intersect(Kernel::Segment_3(point(only_a[0]), point(only_a[1])), of_b) ||
           CGAL::do_intersect(Kernel::Segment_3(point(only_b[0]), point(only_b[1])), of_a);
  }
  return CGAL::do_intersect(of_a, of_b);
}

bool has_area(const Soup& soup, const Corners& t) {
  return !CGAL::collinear(soup.points[t[0]], soup.points[t[1]], soup.points[t[2]]);
}

/// What repair_mesh did, with the counts.
class Changes {
 public:
  void add(std::size_t count, const std::string& what) {
    if (count > 0) list_.push_back(std::to_string(count) + " " + what);
  }
  std::vector<std::string> take() { return std::move(list_); }

 private:
  std::vector<std::string> list_;
};

Corners corners_of(const TriangleMesh& mesh, Eigen::Index triangle) {
  Corners corners{};
  for (int k = 0; k < 3; ++k)
    corners[static_cast<std::size_t>(k)] = static_cast<std::size_t>(mesh.triangles(k, triangle));
  return corners;
}

/// Keeps the triangles that are marked.
void keep(TriangleMesh& mesh, const std::vector<bool>& kept) {
  Eigen::Index count = 0;
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    if (kept[static_cast<std::size_t>(f)]) mesh.triangles.col(count++) = mesh.triangles.col(f).eval();
  }
  mesh.triangles.conservativeResize(3, count);
}

/// Equal and close vertices become one; triangles without area go.
TriangleMesh joined(const TriangleMesh& written, Changes& changes) {
  TriangleMesh mesh = merge_equal_vertices(written);
  changes.add(static_cast<std::size_t>(written.vertices.cols() - mesh.vertices.cols()), "equal vertices merged");
  auto flat = static_cast<std::size_t>(written.triangles.cols() - mesh.triangles.cols());
  const double diagonal = (mesh.vertices.rowwise().maxCoeff() - mesh.vertices.rowwise().minCoeff()).norm();
  if (diagonal == 0.0) return mesh;
  const std::vector<int> first = first_close_vertex(mesh, kCloseVertices * diagonal);
  std::size_t close = 0;
  for (std::size_t v = 0; v < first.size(); ++v) close += first[v] != static_cast<int>(v) ? 1 : 0;
  changes.add(close, "close vertices merged");
  const Soup soup = soup_of(mesh);
  std::vector<bool> kept;
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    for (int k = 0; k < 3; ++k) mesh.triangles(k, f) = first[static_cast<std::size_t>(mesh.triangles(k, f))];
    kept.push_back(has_area(soup, corners_of(mesh, f)));
    flat += kept.back() ? 0 : 1;
  }
  keep(mesh, kept);
  changes.add(flat, "triangles without area dropped");
  return mesh;
}

void agree_with_neighbours(TriangleMesh& mesh, Changes& changes) {
  const PatchOrientation orientation = patch_orientation(mesh, mesh_edges(mesh));
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    if (orientation.turned[static_cast<std::size_t>(f)]) turn_triangle(mesh, f);
  }
  changes.add(static_cast<std::size_t>(orientation.turned_count), "triangles turned to agree with their neighbours");
}

/// Closes every border by triangles; counts the borders that could not be.
void fill_holes(Surface& surface, Changes& changes) {
  std::vector<Surface::Halfedge_index> borders;
  processing::extract_boundary_cycles(surface, std::back_inserter(borders));
  std::size_t filled = 0;
  std::size_t triangles = 0;
  for (const Surface::Halfedge_index border : borders) {
    std::vector<Surface::Face_index> patch;
    processing::triangulate_hole(surface, border, std::back_inserter(patch));
    filled += patch.empty() ? 0 : 1;
    triangles += patch.size();
  }
  changes.add(filled, "holes filled with " + std::to_string(triangles) + " triangles");
  changes.add(borders.size() - filled, "holes that could not be filled");
}

/// Turns the parts that are inside out and no cavities.
void face_outwards(TriangleMesh& mesh, Changes& changes) {
  const std::vector<ComponentKind> kinds = component_kinds(mesh);
  const std::vector<int> component = component_of_triangles(mesh);
  std::size_t turned = 0;
  for (const ComponentKind kind : kinds) turned += kind == ComponentKind::inside_out ? 1 : 0;
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    const auto part = static_cast<std::size_t>(component[static_cast<std::size_t>(f)]);
    if (kinds[part] == ComponentKind::inside_out) turn_triangle(mesh, f);
  }
  changes.add(turned, "parts turned outside out");
}

/// The soup as a halfedge surface; where it is no manifold, it is cut open.
bool surface_of(const TriangleMesh& mesh, Surface& surface, Changes& changes) {
  Soup soup = soup_of(mesh);
  const std::size_t before = soup.points.size();
  processing::orient_polygon_soup(soup.points, soup.triangles);
  changes.add(soup.points.size() - before, "vertices doubled to cut non-manifold places open");
  if (!processing::is_polygon_soup_a_polygon_mesh(soup.triangles)) return false;
  processing::polygon_soup_to_polygon_mesh(soup.points, soup.triangles, surface);
  return true;
}

}  // namespace

int count_self_intersections(const TriangleMesh& mesh) {
  using Bounds = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;
  const Soup soup = soup_of(mesh);
  std::vector<Bounds> boxes;
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    const Corners& t = soup.triangles[i];
    if (!has_area(soup, t)) continue;
    boxes.emplace_back(soup.points[t[0]].bbox() + soup.points[t[1]].bbox() + soup.points[t[2]].bbox(), i);
  }
  int count = 0;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Bounds& a, const Bounds& b) {
    count += cross(soup, soup.triangles[a.info()], soup.triangles[b.info()]) ? 1 : 0;
  });
  return count;
}

Result<RepairedMesh> repair_mesh(const TriangleMesh& written) {
  require(written.triangles.cols() > 0, "repair_mesh: a mesh without triangles");
  Changes changes;
  TriangleMesh mesh = joined(written, changes);
  const RepeatedTriangles repeated = repeated_triangles(mesh);
  keep(mesh, repeated.kept);
  changes.add(static_cast<std::size_t>(repeated.fins), "double sheets without volume dropped");
  changes.add(static_cast<std::size_t>(repeated.dropped), "repeated triangles dropped");
  if (mesh.triangles.cols() == 0) return failure(FailureCode::degenerate, "no triangle of the mesh has an area");
  agree_with_neighbours(mesh, changes);
  Surface surface;
  if (!surface_of(mesh, surface, changes)) {
    return failure(FailureCode::not_converged, "the triangles cannot be made a manifold surface");
  }
  processing::remove_isolated_vertices(surface);
  changes.add(processing::stitch_borders(surface), "pairs of border edges joined");
  fill_holes(surface, changes);
  surface.collect_garbage();
  RepairedMesh result{mesh_of(surface, written.source), {}};
  face_outwards(result.mesh, changes);
  result.changes = changes.take();
  return result;
}

Result<TriangleMesh> simplify_mesh(const TriangleMesh& mesh, int triangles) {
  require(triangles >= 4,
          [&] { return "simplify_mesh: expected 4 triangles or more, got " + std::to_string(triangles); });
  const Soup soup = soup_of(mesh);
  if (!processing::is_polygon_soup_a_polygon_mesh(soup.triangles)) {
    return failure(FailureCode::invalid_input, "only an oriented manifold can be simplified; repair the mesh first");
  }
  Surface surface;
  processing::polygon_soup_to_polygon_mesh(soup.points, soup.triangles, surface);
  namespace simplification = CGAL::Surface_mesh_simplification;
  // A closed triangle mesh has 3 edges for 2 triangles.
  const auto edges = static_cast<std::size_t>(triangles) * 3 / 2;
  simplification::edge_collapse(surface, simplification::Count_stop_predicate<Surface>(edges));
  surface.collect_garbage();
  return mesh_of(surface, mesh.source);
}

}  // namespace opponens::robot
