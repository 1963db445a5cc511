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

/// The unit vectors of R^6 and their opposites: the ball in it has radius 1/sqrt(6).
inline Eigen::Matrix<double, 6, Eigen::Dynamic> cross_polytope() {
  Eigen::Matrix<double, 6, Eigen::Dynamic> w(6, 12);
  w << Eigen::Matrix<double, 6, 6>::Identity(), -Eigen::Matrix<double, 6, 6>::Identity();
  return w;
}

}  // namespace opponens::test
