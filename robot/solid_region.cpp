// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/solid_region.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "robot/mesh.hpp"

namespace opponens::robot {

namespace {

/// A closed component that fills less of its box than this is a sheet counted there and back, not a solid.
constexpr double kLeastFilling = 1e-9;
constexpr double kTouching = 1e-7;  ///< m

}  // namespace

bool SolidRegion::Enclosure::encloses(const Eigen::Vector3d& p) const {
  return box.contains(p) && (distance.signed_distance(p) < 0.0) == outward;
}

SolidRegion::SolidRegion(const TriangleMesh& mesh) : mesh_(mesh) {
  std::vector<Eigen::Vector3d> seed_of;
  for (TriangleMesh& component : components(mesh)) {
    const Eigen::Vector3d seed = component.vertices.col(component.triangles(0, 0));
    seeds_.push_back(seed);
    const double volume = mass_properties(component).volume;
    const Eigen::AlignedBox3d box(component.vertices.rowwise().minCoeff(), component.vertices.rowwise().maxCoeff());
    if (!is_closed(component) || std::abs(volume) <= kLeastFilling * box.volume()) {
      sheets_.emplace_back(component);
      continue;
    }
    enclosures_.push_back({box, MeshDistance(std::make_shared<TriangleMesh>(std::move(component))), volume > 0.0});
    seed_of.push_back(seed);
  }
  // Inside out and within an outward component: a hollow. Inside out on its own: a solid written with flipped faces.
  for (std::size_t i = 0; i < enclosures_.size(); ++i) {
    if (enclosures_[i].outward) continue;
    enclosures_[i].cavity = std::any_of(enclosures_.begin(), enclosures_.end(),
                                        [&](const Enclosure& e) { return e.outward && e.encloses(seed_of[i]); });
  }
}

bool SolidRegion::contains(const Eigen::Vector3d& p) const {
  int layers = 0;
  for (const Enclosure& e : enclosures_) {
    if (e.encloses(p)) layers += e.cavity ? -1 : 1;
  }
  return layers > 0;
}

bool SolidRegion::touches(const Eigen::Vector3d& p) const {
  int layers = 0;
  for (const Enclosure& e : enclosures_) {
    if (e.box.squaredExteriorDistance(p) >= kTouching * kTouching) continue;
    const double distance = e.distance.signed_distance(p);
    if (std::abs(distance) < kTouching) return true;
    if (e.box.contains(p) && (distance < 0.0) == e.outward) layers += e.cavity ? -1 : 1;
  }
  return layers > 0 || std::any_of(sheets_.begin(), sheets_.end(), [&](const BoundingVolumeTree& sheet) {
           return sheet.nearest(p).squared_distance < kTouching * kTouching;
         });
}

const BoundingVolumeTree& SolidRegion::triangles() const {
  std::call_once(triangles_once_, [this] { triangles_.emplace(mesh_); });
  return *triangles_;
}

}  // namespace opponens::robot
