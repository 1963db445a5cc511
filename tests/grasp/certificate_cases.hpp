// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

#include "core/grasp.hpp"

namespace opponens::test {

inline QualityConvention of_model(ContactModel model) {
  QualityConvention convention;
  convention.model = model;
  convention.torsion_radius = model == ContactModel::soft_finger ? 0.01 : 0.0;
  return convention;
}

inline std::vector<Contact> pinch(double mu) {
  return {{"a", Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitX(), mu},
          {"b", -Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitX(), mu}};
}

/// Contacts on the unit sphere in the plane z = height, pushing towards the z axis.
inline std::vector<Contact> ring(int count, double mu, double height = 0.0) {
  std::vector<Contact> contacts;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * M_PI * i / count;
    const double radius = std::sqrt(1.0 - height * height);
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    contacts.push_back({"tip", radius * out + height * Eigen::Vector3d::UnitZ(), -out, mu});
  }
  return contacts;
}

}  // namespace opponens::test
