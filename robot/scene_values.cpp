// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/scene_values.hpp"

#include <cmath>

namespace opponens::robot {

double positive(const YamlValue& value) {
  const double number = value.number();
  if (number <= 0.0) value.fail("expected a positive number, found '" + value.text() + "'");
  return number;
}

std::string name_of(const YamlValue& value) {
  std::string name = value.text();
  if (name.empty()) value.fail("expected a name, found an empty text");
  return name;
}

Eigen::Isometry3d pose_of(const YamlValue& value) {
  value.allow_keys({"xyz", "rpy", "quaternion"});
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  const std::optional<YamlValue> quaternion = value.find("quaternion");
  if (const auto rpy = value.find("rpy")) {
    if (quaternion) value.fail("has both rpy and quaternion, expected one of them");
    X = pose_from_xyz_rpy(Eigen::Vector3d::Zero(), rpy->numbers(3));
  }
  if (quaternion) {
    const Eigen::Vector4d wxyz = quaternion->numbers(4);
    if (std::abs(wxyz.norm() - 1.0) > 1e-3) {
      quaternion->fail("expected a unit quaternion (w, x, y, z), its norm is " + std::to_string(wxyz.norm()));
    }
    X.linear() = Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized().toRotationMatrix();
  }
  if (const auto xyz = value.find("xyz")) X.translation() = xyz->numbers(3);
  return X;
}

Eigen::Vector3d ros_vector(const YamlValue& value) {
  if (!value.is_map()) return value.numbers(3);
  value.allow_keys({"x", "y", "z"});
  return {value.at("x").number(), value.at("y").number(), value.at("z").number()};
}

Eigen::Quaterniond ros_quaternion(const YamlValue& value) {
  Eigen::Vector4d xyzw;
  if (value.is_map()) {
    value.allow_keys({"x", "y", "z", "w"});
    xyzw = Eigen::Vector4d(value.at("x").number(), value.at("y").number(), value.at("z").number(),
                           value.at("w").number());
  } else {
    xyzw = value.numbers(4);
  }
  if (std::abs(xyzw.norm() - 1.0) > kQuaternionTolerance) {
    value.fail("expected a unit quaternion (x, y, z, w), its norm is " + std::to_string(xyzw.norm()));
  }
  return Eigen::Quaterniond(xyzw[3], xyzw[0], xyzw[1], xyzw[2]).normalized();
}

}  // namespace opponens::robot
