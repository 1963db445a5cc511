// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/grasp.hpp"
#include "core/synergies.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"
#include "verify/verdict.hpp"

namespace opponens::verify {

struct GraspCheckSettings {
  double tolerance = 1e-6;           ///< rad, m or 1: of stored numbers that follow from each other
  double slack_bound = 0.3;          ///< rad, 2-norm of the slack of a synergy grasp
  double contact_distance = 0.0025;  ///< m, of a contact from the object's and from its link's surface
  double normal_angle = 0.35;        ///< rad, of a contact normal from the object's surface normal nearby
};

/// What a stored grasp is checked against.
struct GraspContext {
  const SynergyBox* box;           ///< of the grasp's group
  const robot::RobotModel* hand;   ///< rooted at the palm
  const robot::SceneBody* object;  ///< body frame = O
};

/// Re-checks a stored grasp without the code that found it: orthonormal poses; joint limits of grasp and pre-grasp;
/// slack = q_grasp - scale .* (center + axes c), coefficients inside the box and, for a synergy grasp, the slack's
/// bound; contacts with unit normals on the surfaces of object and link, normals along the object's; and force closure
/// of the contact model (positive_span). No collision: see paths.hpp.
Verdict check_grasp(const Grasp& grasp, const GraspContext& context, const GraspCheckSettings& settings = {});

struct PositiveSpan {
  bool spans = false;     ///< rank 6, and some a >= 1 has W a = 0: the wrenches positively span R^6
  double residual = 0.0;  ///< min |W a| / sum a over a >= 1, columns of W scaled to length 1
  double rank_ratio = 0;  ///< smallest over largest singular value of W so scaled
  int wrenches = 0;
};

/// Force closure of contacts by non-negative least squares. The wrenches are made here, from the definition: for each
/// contact 2 * edges forces n + mu (cos t_x + sin t_y), which hold every edge of the stored convention among them, each
/// checked to lie in the friction cone e.n > 0, (1 + mu^2) (e.n)^2 >= |e|^2 (to 1e-12). Without friction: n alone. Soft
/// fingers are checked as points with friction, which they are at least as strong as: so "spans" is certain there, and
/// a grasp that closes by torsion alone is refused. At least one, at most `contacts.size() * 2 * edges` columns.
PositiveSpan positive_span(const std::vector<Contact>& contacts, const QualityConvention& convention);

}  // namespace opponens::verify
