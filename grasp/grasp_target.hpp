// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/grasp.hpp"
#include "core/rng.hpp"
#include "grasp/body_distance.hpp"
#include "grasp/distance_grid.hpp"
#include "grasp/point_tree.hpp"
#include "robot/mesh_distance.hpp"
#include "robot/scene.hpp"

namespace opponens::grasp {

struct Obstacle {
  std::string name;
  BodyDistance distance;
  Eigen::Isometry3d X_BO;  ///< maps object coordinates to the body's
};

/// The object to grasp and what stands around it, in the object's frame O; made once per search.
struct GraspTarget {
  std::string name;
  Eigen::Isometry3d X_WO;
  std::shared_ptr<const robot::TriangleMesh> mesh;  ///< all geometry of the body, one mesh
  std::shared_ptr<const robot::MeshDistance> distance;
  std::shared_ptr<const DistanceGrid> grid;
  PointTree surface;                ///< points 2.5 mm apart (or coarser: at most about 40,000)
  Eigen::VectorXd cumulative_area;  ///< [F] of the triangles, for uniform sampling
  Eigen::Vector3d center_of_mass;   ///< uniform density; mean of the vertices for an open mesh
  Eigen::Matrix3d axes;             ///< columns: principal axes of the surface, the longest last
  double rho;                       ///< m, largest distance of a vertex from it
  std::vector<Obstacle> obstacles;  ///< every other body of the scene
  /// Of a lower bound of their distance, within 20 cm of the object; null: there are none.
  std::shared_ptr<const DistanceGrid> obstacle_grid;

  /// The mesh's nearest point, exactly: distance->query with what the grid knows of the distance.
  robot::MeshDistance::Query nearest(const Eigen::Vector3d& p_O) const;
  /// Distance of p_O to the nearest obstacle, and its gradient; a lower bound beyond horizon.
  SignedDistance obstacle_distance(const Eigen::Vector3d& p_O, double horizon) const;
};

GraspTarget make_target(const robot::Scene& scene, const std::string& object, int threads);

/// How the searches score grasps: point contact with friction, normal force 1, L1, torque divided by the object's
/// radius, about its centre of mass.
QualityConvention default_convention(const GraspTarget& target, double mu, int edges = 8);

struct SurfaceSeed {
  Eigen::Vector3d p_O;
  Eigen::Vector3d n_O;  ///< out of the object
};
/// A point drawn uniformly by area.
SurfaceSeed sample_surface(const GraspTarget& target, Rng& rng);
/// The surface as seen along a principal axis, drawn with its sign (n_O): straight towards the centre of mass, or past
/// it by where a point drawn by area lies along the longest axis.
SurfaceSeed sample_axis(const GraspTarget& target, Rng& rng);

}  // namespace opponens::grasp
