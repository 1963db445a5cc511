// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/certificate.hpp"

#include <algorithm>
#include <numeric>

#include "core/rng.hpp"
#include "grasp/conic_basis.hpp"
#include "grasp/exact_balance.hpp"
#include "grasp/exact_edges.hpp"
#include "grasp/exact_programme.hpp"
#include "grasp/min_norm_point.hpp"

namespace opponens::grasp {
namespace {

constexpr int kShortBits = 20;  // of the forces: a loss of friction of 1e-5, and coefficients half as long
constexpr int kFullBits = 48;   // of the forces: what doubles have, less their rounding
constexpr int kTriesOfOne = 8;  // single edges to be balanced, before sums of more are
constexpr int kLargestWeight = 15;
constexpr double kClear = 1e-6;    // least over largest weight of a basis whose signs doubles surely have right
constexpr double kOutside = 1e-9;  // of unit wrenches: a separation that rounding cannot have made

/// Distinct edges at random, with small weights.
GivenEdges some_edges(int count, std::size_t available, Rng& rng) {
  std::vector<int> all(available);
  std::iota(all.begin(), all.end(), 0);
  GivenEdges given;
  for (int k = 0; k < count; ++k) {
    const auto left = static_cast<std::size_t>(k);
    std::swap(all[left], all[left + rng.index(available - left)]);
    given.edges.push_back(all[left]);
    given.weights.push_back(count == 1 ? 1 : 1 + static_cast<int>(rng.index(kLargestWeight)));
  }
  return given;
}

/// A certificate by a basis in doubles: of one edge against six others, or of a few against six.
std::optional<Certificate> certify_in_doubles(const std::vector<CertificateEdge>& edges,
                                              const std::vector<Contact>& contacts,
                                              const QualityConvention& convention) {
  const Matrix6Xd wrenches = scaled_wrenches(edges, contacts);
  if (edges.size() < 7 || !wrenches.allFinite()) return std::nullopt;
  Rng rng = stream(0, "certificate");
  for (int attempt = 0; attempt < kTriesOfOne + 5; ++attempt) {
    const int count = std::max(1, attempt - kTriesOfOne + 2);
    const GivenEdges given = some_edges(count, edges.size(), rng);
    Vector6d v = Vector6d::Zero();
    for (int k = 0; k < count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      v -= given.weights[at] * wrenches.col(given.edges[at]);
    }
    const auto basis = conic_basis(wrenches, v);
    if (!basis) return std::nullopt;
    const bool last = attempt == kTriesOfOne + 4;
    if (basis->columns.size() < 6) continue;
    if (!last && basis->weights.minCoeff() < kClear * basis->weights.maxCoeff()) continue;
    auto certificate = exact_balance(edges, contacts, given, basis->columns);
    if (certificate && certificate_fault(*certificate, contacts, convention).empty()) return certificate;
  }
  return std::nullopt;
}

/// Whether some direction separates the origin from all wrenches by more than rounding: then nothing balances.
bool surely_open(const std::vector<CertificateEdge>& edges, const std::vector<Contact>& contacts) {
  const Matrix6Xd wrenches = scaled_wrenches(edges, contacts).colwise().normalized();
  if (!wrenches.allFinite()) return false;
  const Vector6d nearest = min_norm_point(WrenchSpace(wrenches, 1, WrenchNorm::l1)).point;
  return (nearest.transpose() * wrenches).minCoeff() > kOutside * nearest.norm();
}

/// Six independent edges against a basic solution of the exact programme.
std::optional<Certificate> certify_exactly(const std::vector<CertificateEdge>& edges,
                                           const std::vector<Contact>& contacts, const QualityConvention& convention) {
  const std::vector<int> independent = independent_edges(edges, contacts, {});
  if (independent.size() < 6) return std::nullopt;
  const GivenEdges given{independent, std::vector<int>(6, 1)};
  const auto positive = exact_conic_basis(edges, contacts, given);
  if (!positive) return std::nullopt;
  auto certificate = exact_balance(edges, contacts, given, independent_edges(edges, contacts, *positive));
  if (!certificate || !certificate_fault(*certificate, contacts, convention).empty()) return std::nullopt;
  return certificate;
}

}  // namespace

std::optional<Certificate> certify(const std::vector<Contact>& contacts, const QualityConvention& convention) {
  if (auto certificate = certify_in_doubles(inner_edges(contacts, convention, kShortBits), contacts, convention)) {
    return certificate;
  }
  const std::vector<CertificateEdge> edges = inner_edges(contacts, convention, kFullBits);
  if (edges.size() < 7 || surely_open(edges, contacts)) return std::nullopt;
  if (auto certificate = certify_in_doubles(edges, contacts, convention)) return certificate;
  return certify_exactly(edges, contacts, convention);
}

std::optional<Certificate> certify(const std::vector<Contact>& contacts, const GraspQuality& quality) {
  auto certificate = certify(contacts, quality.convention);
  // The exact support function is that of pyramids, which a quadratic cone's epsilon may exceed.
  const bool bounded = quality.convention.cone == FrictionCone::pyramid && !quality.direction.isZero(0.0);
  if (certificate && bounded) {
    certificate->epsilon_bound = epsilon_bound(contacts, quality.convention, quality.direction);
  }
  return certificate;
}

}  // namespace opponens::grasp
