// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "report/facets.hpp"

namespace opponens::report {
namespace {

constexpr double kOnPlane = 1e-6;    // m, corners closer than this lie on a cutting plane
constexpr std::size_t kLargest = 4;  // cutting planes compared at each node: those of the largest facets, ...
constexpr std::size_t kSpread = 8;   // ... and of some spread over all

using Facets = std::vector<Facet>;

struct Plane {
  Eigen::Vector3d normal;
  double offset;
  double distance(const Eigen::Vector3d& p) const { return normal.dot(p) - offset; }
};

Plane plane_of(const Facet& facet) { return {facet.normal, facet.normal.dot(facet.corners.front())}; }

enum class Side { front, back, on, both };

Side side_of(const Facet& facet, const Plane& plane) {
  bool front = false;
  bool back = false;
  for (const auto& corner : facet.corners) {
    const double distance = plane.distance(corner);
    front = front || distance > kOnPlane;
    back = back || distance < -kOnPlane;
  }
  if (front && back) return Side::both;
  if (front) return Side::front;
  return back ? Side::back : Side::on;
}

/// The part of a convex facet on one side of a plane (Sutherland and Hodgman 1974, doi:10.1145/360767.360802).
Facet clipped(const Facet& facet, const Plane& plane, double sign) {
  Facet part{{}, facet.normal, facet.paint};
  const std::size_t count = facet.corners.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto& a = facet.corners[i];
    const auto& b = facet.corners[(i + 1) % count];
    const double da = sign * plane.distance(a);
    const double db = sign * plane.distance(b);
    if (da >= -kOnPlane) part.corners.push_back(a);
    if ((da > kOnPlane && db < -kOnPlane) || (da < -kOnPlane && db > kOnPlane)) {
      part.corners.push_back(a + (b - a) * (da / (da - db)));
    }
  }
  return part;
}

/// Area by the fan of triangles, a measure to sort by.
double area(const Facet& facet) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 2; i < facet.corners.size(); ++i) {
    sum += (facet.corners[i - 1] - facet.corners[0]).cross(facet.corners[i] - facet.corners[0]);
  }
  return sum.norm();
}

long cost_of(const Facets& facets, const Plane& plane) {
  long front = 0;
  long back = 0;
  long cut = 0;
  for (const auto& facet : facets) {
    const Side side = side_of(facet, plane);
    front += side == Side::front;
    back += side == Side::back;
    cut += side == Side::both;
  }
  return 8 * cut + std::abs(front - back);
}

/// Of a few facets, the one whose plane cuts least and divides best. Large facets (boards of a shelf) come first in the
/// list and are always tried: their planes separate the bodies between them without cutting.
std::size_t choose_splitter(const Facets& facets) {
  std::size_t best = 0;
  long best_cost = std::numeric_limits<long>::max();
  for (std::size_t c = 0; c < kLargest + kSpread; ++c) {
    const std::size_t index = c < kLargest ? c : (c - kLargest) * facets.size() / kSpread;
    if (index >= facets.size()) continue;
    const long cost = cost_of(facets, plane_of(facets[index]));
    if (cost < best_cost) {
      best_cost = cost;
      best = index;
    }
  }
  return best;
}

struct Parts {
  Facets far, on, near;
};

Parts split(Facets facets, const Eigen::Vector3d& toward_viewer) {
  const Plane plane = plane_of(facets[choose_splitter(facets)]);
  const bool front_is_near = plane.normal.dot(toward_viewer) >= 0.0;
  Parts parts;
  Facets& front = front_is_near ? parts.near : parts.far;
  Facets& back = front_is_near ? parts.far : parts.near;
  for (auto& facet : facets) {
    switch (side_of(facet, plane)) {
      case Side::front:
        front.push_back(std::move(facet));
        break;
      case Side::back:
        back.push_back(std::move(facet));
        break;
      case Side::on:
        parts.on.push_back(std::move(facet));
        break;
      case Side::both:
        for (auto* half : {&front, &back}) {
          Facet part = clipped(facet, plane, half == &front ? 1.0 : -1.0);
          if (part.corners.size() >= 3) half->push_back(std::move(part));
        }
        break;
    }
  }
  return parts;
}

struct Job {
  Facets facets;
  bool ordered;
};

}  // namespace

std::vector<Facet> back_to_front(std::vector<Facet> facets, const Eigen::Vector3d& toward_viewer) {
  std::erase_if(facets, [&](const Facet& facet) { return facet.normal.dot(toward_viewer) <= 1e-6; });
  std::stable_sort(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) { return area(a) > area(b); });
  Facets ordered;
  // The viewer's direction is known, so the tree is never stored: its nodes are visited as they are made. A stack of
  // our own, since the tree of a round body is as deep as it has facets.
  std::vector<Job> stack;
  stack.push_back({std::move(facets), false});
  while (!stack.empty()) {
    Job job = std::move(stack.back());
    stack.pop_back();
    if (job.ordered || job.facets.size() < 2) {
      std::move(job.facets.begin(), job.facets.end(), std::back_inserter(ordered));
      continue;
    }
    Parts parts = split(std::move(job.facets), toward_viewer);
    stack.push_back({std::move(parts.near), false});
    stack.push_back({std::move(parts.on), true});
    stack.push_back({std::move(parts.far), false});
  }
  return ordered;
}

}  // namespace opponens::report
