// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/robust_quality.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "analysis/intervals.hpp"
#include "core/require.hpp"
#include "grasp/quality.hpp"

namespace opponens::grasp {
namespace {

constexpr double kMet = 1e-5;          // m, this near to the surface a contact is on it
constexpr int kMaxMarch = 64;          // steps of one line; one that grazes the surface for longer is lost
constexpr double kLeastClosing = 0.2;  // cosine of the angle between closing and normal: 78 degrees
constexpr double kConfidence = 0.95;
constexpr double kLowQuantile = 0.05;

struct Disturbance {
  Eigen::Isometry3d X_OD;  ///< the object where it really is, D, in the object where it was thought to be
  double friction;
};

Disturbance draw(const GraspNoise& noise, const Eigen::Vector3d& center, Rng& rng) {
  const auto normal3 = [&](double deviation) {
    const double x = rng.normal();
    const double y = rng.normal();
    const double z = rng.normal();
    return Eigen::Vector3d(deviation * Eigen::Vector3d(x, y, z));
  };
  const Eigen::Vector3d shift = normal3(noise.position);
  const Eigen::Vector3d turn = normal3(noise.angle);
  const double angle = turn.norm();
  const Eigen::AngleAxisd rotation(angle, angle > 0.0 ? Eigen::Vector3d(turn / angle) : Eigen::Vector3d::UnitX());
  return {Eigen::Translation3d(center + shift) * rotation * Eigen::Translation3d(-center),
          noise.friction * rng.normal()};
}

/// Per contact the unit direction, in O, in which it follows the object.
std::vector<Eigen::Vector3d> following_directions(const robot::RobotModel& hand, const Grasp& grasp) {
  const std::vector<Eigen::Isometry3d> X_HL = hand.link_poses(grasp.q_grasp);
  const Eigen::VectorXd closing = grasp.q_grasp - grasp.q_pregrasp;
  std::vector<Eigen::Vector3d> directions;
  for (const Contact& contact : grasp.contacts) {
    const Eigen::Vector3d p_H = grasp.X_OH.inverse() * contact.p_OC;
    const Eigen::Vector3d way =
        grasp.X_OH.linear() * (hand.point_jacobian(X_HL, hand.link_index(contact.link), p_H) * closing);
    const double length = way.norm();
    const bool closes = length > 1e-6 && way.dot(contact.n_O) > kLeastClosing * length;
    directions.push_back(closes ? Eigen::Vector3d(way / length) : contact.n_O);
  }
  return directions;
}

/// Where a point that slides along a line meets the surface: forward from outside, back from inside, by steps as long
/// as the distance to the surface, so that none crosses it.
std::optional<robot::MeshDistance::Query> meet(const robot::MeshDistance& object, const Eigen::Vector3d& p,
                                               const Eigen::Vector3d& direction) {
  robot::MeshDistance::Query at = object.query(p);
  const double way = at.distance < 0.0 ? -1.0 : 1.0;
  double travelled = 0.0;
  for (int step = 0; step < kMaxMarch; ++step) {
    if (std::abs(at.distance) <= kMet) return at;
    travelled += std::abs(at.distance);
    if (travelled > kFollow) return std::nullopt;
    at = object.query(p + way * travelled * direction);
  }
  return std::nullopt;
}

std::vector<Contact> find_again(const robot::MeshDistance& object, const Grasp& grasp,
                                const std::vector<Eigen::Vector3d>& directions, const Disturbance& disturbance) {
  const Eigen::Isometry3d X_DO = disturbance.X_OD.inverse();
  std::vector<Contact> contacts;
  for (std::size_t i = 0; i < grasp.contacts.size(); ++i) {
    const Contact& contact = grasp.contacts[i];
    const auto at = meet(object, X_DO * contact.p_OC, X_DO.linear() * directions[i]);
    if (!at) continue;
    contacts.push_back(
        {contact.link, at->point, -at->gradient.normalized(), std::max(0.0, contact.mu + disturbance.friction)});
  }
  return contacts;
}

}  // namespace

void validate(const GraspNoise& noise) {
  const auto check = [](const char* field, double value) {
    require(value >= 0.0 && std::isfinite(value), [&] {
      return "GraspNoise: " + std::string(field) + " = " + std::to_string(value) + " must be finite and not negative";
    });
  };
  check("position", noise.position);
  check("angle", noise.angle);
  check("friction", noise.friction);
  require(noise.samples > 0,
          [&] { return "GraspNoise: samples = " + std::to_string(noise.samples) + " must be positive"; });
}

std::vector<Contact> disturbed_contacts(const robot::RobotModel& hand, const robot::MeshDistance& object,
                                        const Grasp& grasp, const Eigen::Isometry3d& X_OD, double friction) {
  return find_again(object, grasp, following_directions(hand, grasp), {X_OD, friction});
}

RobustQuality robust_quality(const robot::RobotModel& hand, const robot::MeshDistance& object, const Grasp& grasp,
                             const GraspNoise& noise, Rng& rng) {
  validate(noise);
  require(grasp.q_grasp.size() == hand.dof() && grasp.q_pregrasp.size() == hand.dof(),
          "robust_quality: the grasp is of another hand");
  const std::vector<Eigen::Vector3d> directions = following_directions(hand, grasp);
  std::vector<double> epsilon;
  int closed = 0;
  double sum = 0.0;
  for (int i = 0; i < noise.samples; ++i) {
    const Disturbance disturbance = draw(noise, grasp.quality.convention.origin, rng);
    const std::vector<Contact> contacts = find_again(object, grasp, directions, disturbance);
    const GraspQuality quality = evaluate(contacts, grasp.quality.convention);
    epsilon.push_back(quality.force_closure() ? quality.epsilon.value_or(0.0) : 0.0);
    closed += epsilon.back() > 0.0 ? 1 : 0;
    sum += epsilon.back();
  }
  std::sort(epsilon.begin(), epsilon.end());
  const analysis::Interval interval = analysis::proportion_interval(closed, noise.samples, kConfidence);
  RobustQuality result;
  result.noise = noise;
  result.force_closure = static_cast<double>(closed) / noise.samples;
  result.force_closure_low = interval.low;
  result.force_closure_high = interval.high;
  result.epsilon_mean = sum / noise.samples;
  result.epsilon_low = analysis::bootstrap_quantile(epsilon, kLowQuantile);
  return result;
}

}  // namespace opponens::grasp
