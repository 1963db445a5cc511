// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/mesh_distance.hpp"
#include "robot/motion_bound.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::motion {

/// Links that may touch an object: a hand's, with what it grasps.
struct TouchingLinks {
  std::string object;              ///< a body of the scene
  std::vector<std::string> links;  ///< names
};

/// How deep some links stick in their object: what bounds the contacts of a closing segment, whose link-object pairs
/// the collision checker leaves out. Measured at points on the links' surfaces, so a depth may be missed by at most
/// about spacing^2 / (8 r) where the object's radius of curvature is r, and by spacing at its edges. Immutable,
/// thread-safe.
class ContactDepth {
 public:
  /// spacing of the surface points, m. robot is referred to and must outlive this.
  ContactDepth(const robot::RobotModel& robot, const robot::Scene& scene, const std::vector<TouchingLinks>& hands,
               double spacing = 0.003);
  /// Of one hand.
  ContactDepth(const robot::RobotModel& robot, const robot::Scene& scene, const std::string& object,
               const std::vector<std::string>& links, double spacing = 0.003);

  /// m, >= 0. q: [d] rad.
  double operator()(const Eigen::VectorXd& q) const;

  /// Where the motion q_from to q_to is deeper than max_depth, as a fraction; nullopt: nowhere. Proven by how far the
  /// links can have moved (robot::MotionBound) where that is enough, which it is but for depths near max_depth: there
  /// it is asked at spacings of at most `shortest` of the motion. Adds the configurations evaluated to checks.
  std::optional<double> first_deeper(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to, double max_depth,
                                     double shortest, std::int64_t& checks) const;

 private:
  /// A ball around some of a link's surface points. Children follow their parent.
  struct Ball {
    Eigen::Vector3d center;  ///< m, in the link
    double radius;           ///< m
    std::size_t begin, end;  ///< its points
    std::size_t next;        ///< the first ball after those inside this one
    bool leaf;
  };
  struct LinkSurface {
    int link;
    std::vector<Eigen::Vector3d> points;  ///< m, in the link
    std::vector<Ball> balls;
    std::size_t first_solid, last_solid;  ///< of its object: [first, last)
    void enclose(std::size_t begin, std::size_t end);
  };
  struct Solid {
    robot::MeshDistance distance;
    Eigen::Isometry3d X_GR;   ///< robot root in the geometry's frame
    Eigen::AlignedBox3d box;  ///< of the geometry: what is outside is at least as far from the surface as from it
  };
  void add_object(const robot::Scene& scene, const std::string& object);
  void add_link(const std::string& name, double spacing, std::size_t first_solid);

  /// The greater of depth and what the points of the link reach in the solid; looks no further than what is deeper
  /// than `enough`.
  static double deepest(const LinkSurface& link, const Solid& solid, const Eigen::Isometry3d& X_GL, double depth,
                        double enough);
  /// Whether the links are nowhere deeper than max_depth while they move from here by a share of a travel at most.
  bool keeps(const std::vector<Eigen::Isometry3d>& X_RL, const robot::LinkTravel& travel, double share,
             double max_depth) const;

  const robot::RobotModel* robot_;
  robot::MotionBound bound_;
  std::vector<LinkSurface> links_;
  std::vector<Solid> solids_;
};

class ContinuousCheck;

/// What a closing segment keeps. Without a measure its depth is not bounded.
struct ContactLimit {
  const ContactDepth* depth = nullptr;
  /// m. Paths are asked at their samples, and `verify` holds all of their motion to 1 mm: a tenth is kept in hand.
  double max_depth = 0.0009;
  /// Of all that may not touch; null: the default clearance.
  const ContinuousCheck* clearance = nullptr;
};

}  // namespace opponens::motion
