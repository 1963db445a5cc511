// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <set>

#include "analysis/synergy_box.hpp"
#include "core/grasp.hpp"
#include "grasp/grasp_search.hpp"
#include "grasp/quality.hpp"
#include "grasp/wrench_hull.hpp"
#include "robot/mesh.hpp"
#include "robot/mesh_distance.hpp"

namespace opponens::test {

/// Least signed distance of a link's densely sampled surface to the object.
inline double least_distance(const robot::RobotModel& hand, const Eigen::Isometry3d& X_OH, const Eigen::VectorXd& q,
                             std::size_t link, const robot::MeshDistance& object) {
  const Eigen::Isometry3d X_OL = X_OH * hand.link_poses(q)[link];
  double least = 1e9;
  for (const robot::Geometry& geometry : hand.links()[link].collision) {
    for (const Eigen::Vector3d& p : robot::surface_samples(geometry, 0.002)) {
      least = std::min(least, object.signed_distance(X_OL * p));
    }
  }
  return least;
}

/// A link's contacts lie on its surface too, to the tolerance (and what triangles of a round shape are off).
inline void expect_contacts_on(const Grasp& grasp, const robot::RobotModel& hand, std::size_t link, double tolerance) {
  const robot::Link& body = hand.links()[link];
  const robot::MeshDistance surface(std::make_shared<const robot::TriangleMesh>(robot::merge(body.collision)));
  const Eigen::Isometry3d X_LO = (grasp.X_OH * hand.link_poses(grasp.q_grasp)[link]).inverse();
  for (const Contact& contact : grasp.contacts) {
    if (contact.link == body.name) {
      EXPECT_LT(std::abs(surface.signed_distance(X_LO * contact.p_OC)), tolerance + 2e-4) << body.name;
    }
  }
}

/// Everything a returned grasp promises, checked with code that the search does not use.
inline void recheck(const Grasp& grasp, const robot::RobotModel& hand, const robot::Scene& scene,
                    const SynergyGroup& group, const grasp::SearchSettings& settings) {
  const auto mesh = std::make_shared<const robot::TriangleMesh>(robot::merge(scene.body("object").geometry));
  const robot::MeshDistance object(mesh);
  EXPECT_TRUE(hand.within_limits(grasp.q_grasp) && hand.within_limits(grasp.q_pregrasp));
  std::set<std::string> touching;
  for (const Contact& contact : grasp.contacts) {
    touching.insert(contact.link);
    const auto at = object.query(contact.p_OC);
    EXPECT_NEAR(at.distance, 0.0, 1e-9);
    EXPECT_LT(object.signed_distance(contact.p_OC + 1e-4 * contact.n_O), 0.0)
        << "normal does not point into the object";
    EXPECT_EQ(contact.mu, settings.mu);
  }
  for (std::size_t link = 0; link < hand.links().size(); ++link) {
    const double d = least_distance(hand, grasp.X_OH, grasp.q_grasp, link, object);
    EXPECT_GT(d, -settings.max_penetration - 2e-4) << hand.links()[link].name;
    if (touching.contains(hand.links()[link].name)) expect_contacts_on(grasp, hand, link, settings.contact_tolerance);
    EXPECT_GT(least_distance(hand, grasp.X_OH_pregrasp, grasp.q_pregrasp, link, object),
              settings.clearance_pregrasp - 2e-4);
  }
  const auto hull = grasp::wrench_hull(grasp::contact_wrenches(grasp.contacts, grasp.quality.convention));
  ASSERT_TRUE(hull.has_value());
  EXPECT_GT(hull->least_offset, 0.0);
  EXPECT_NEAR(hull->least_offset, grasp.quality.epsilon.value(), 1e-9);
  const Eigen::VectorXd on_box = analysis::configuration(group.box, grasp.coefficients);
  EXPECT_NEAR((on_box + grasp.slack - grasp.q_grasp).norm(), 0.0, 1e-12);
  EXPECT_TRUE((grasp.coefficients.cwiseAbs().array() <= group.box.half_width.array() + 1e-12).all());
  EXPECT_EQ(grasp.synergy_grasp, grasp.slack.norm() <= settings.slack_bound);
}

}  // namespace opponens::test
