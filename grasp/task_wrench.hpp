// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "grasp/wrench_space.hpp"

namespace opponens::grasp {

/// Largest k such that the contacts can supply k times a wrench.
struct LoadFactor {
  double factor = 0.0;                    ///< k, reached; 0: no force of the contacts, however large, supplies the load
  double upper = 0.0;                     ///< the true k is at most this
  Vector6d direction = Vector6d::Zero();  ///< u with h(u) = upper u'load: the plane that ends the ray; where factor is
                                          ///< 0 u separates the load from all that the contacts can supply
  bool converged = true;                  ///< false: upper - factor is more than was asked
};

/// The wrenches that the contacts can supply: WrenchSpace joined with the origin, since contacts may push less (the L1
/// hull alone leaves it out; for a force-closure set that changes nothing). Then a grasp that only carries, without
/// force closure, resists some loads too. With a total normal force of F N (L1; L-infinity: of F N each) the load is
/// held when F k >= 1, so 1/k is the force it takes. load: [6], finite, not zero, in the units of the space's wrenches.
/// L1 pyramids: 1/k = min 1'a, W a = load, a >= 0, one linear programme of six rows. Otherwise the same over points of
/// the set, which grow by the support point of the programme's dual (Dantzig and Wolfe 1960, doi:10.1287/opre.8.1.101)
/// until upper <= (1 + max(relative_gap, 1e-9)) factor. A curved set needs a relative_gap > 0.
LoadFactor load_factor(const WrenchSpace& space, const Vector6d& load, double relative_gap = 0.0);

struct TaskQuality {
  LoadFactor least;
  Eigen::Index limiting = 0;  ///< the load that it belongs to
};

/// Largest k such that k times each column of loads [6 x n], n > 0, is supplied: the least of their factors, and so of
/// all loads in their convex hull (task wrench space: Li and Sastry 1988, doi:10.1109/56.769; Borst, Fischer and
/// Hirzinger 2004, doi:10.1109/ROBOT.2004.1307170).
TaskQuality task_quality(const WrenchSpace& space, const Matrix6Xd& loads, double relative_gap = 0.0);

/// What the contacts must supply against a wrench that acts on the object: its opposite, in the convention's units.
/// force: [3] N; torque: [3] N m about the convention's origin; both in O.
Vector6d load_against(const Eigen::Vector3d& force, const Eigen::Vector3d& torque, const QualityConvention& convention);

/// The same against gravity on a mass (kg, >= 0) at p_OM [3] m, acting along `down` [3], any length but zero; 9.80665
/// m/s^2.
Vector6d load_against_gravity(double mass, const Eigen::Vector3d& p_OM, const Eigen::Vector3d& down,
                              const QualityConvention& convention);

}  // namespace opponens::grasp
