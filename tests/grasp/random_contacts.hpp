// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/grasp.hpp"
#include "core/rng.hpp"

namespace opponens::test {

inline Eigen::Vector3d random_unit(Rng& rng) {
  return Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
}

/// Contacts on the unit sphere whose normals are off by about `spread` rad: small: mostly force closure; 1: mixed.
inline std::vector<Contact> random_contacts(int count, double spread, Rng& rng) {
  std::vector<Contact> contacts;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d p = random_unit(rng);
    const Eigen::Vector3d off(rng.normal(), rng.normal(), rng.normal());
    contacts.push_back({"link", p, (-p + spread * off).normalized(), rng.uniform(0.1, 1.0)});
  }
  return contacts;
}

/// Clusters of contacts that are nearly one, on nearly opposite flat sides, as pads on a box have them: their wrenches
/// make ill-conditioned bases. `apart`: how far the contacts of a cluster and their normals differ.
inline std::vector<Contact> clustered_contacts(int clusters, double apart, Rng& rng) {
  std::vector<Contact> contacts;
  for (int i = 0; i < clusters; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const Eigen::Vector3d p(0.3 * side, rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0));
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector3d n = (Eigen::Vector3d(-side, 0.0, 0.0) + apart * random_unit(rng)).normalized();
      contacts.push_back({"link", p + apart * random_unit(rng), n, 0.5});
    }
  }
  return contacts;
}

/// The unit vectors of R^6 and their opposites: the ball in it has radius 1/sqrt(6).
inline Eigen::Matrix<double, 6, Eigen::Dynamic> cross_polytope() {
  Eigen::Matrix<double, 6, Eigen::Dynamic> w(6, 12);
  w << Eigen::Matrix<double, 6, 6>::Identity(), -Eigen::Matrix<double, 6, 6>::Identity();
  return w;
}

}  // namespace opponens::test
