// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/timing.hpp"

#include <cmath>
#include <string>

#include "core/require.hpp"

namespace opponens::motion {
namespace {

/// Time at which the trapezoidal profile of total length `length` (s at unit speed) has come to u. peak: highest speed,
/// rate: its slope up and down.
double time_at(double u, double length, double peak, double rate) {
  const double ramp_length = 0.5 * peak * peak / rate;
  if (u <= ramp_length) return std::sqrt(2.0 * u / rate);
  const double ramp_time = peak / rate;
  const double cruise_end = length - ramp_length;
  if (u <= cruise_end) return ramp_time + (u - ramp_length) / peak;
  const double total = 2.0 * ramp_time + (cruise_end - ramp_length) / peak;
  return total - std::sqrt(2.0 * (length - u) / rate);
}

}  // namespace

void validate(const TimingSettings& settings) {
  require(settings.velocity_scale > 0.0 && settings.velocity_scale <= 1.0,
          "TimingSettings::velocity_scale = " + std::to_string(settings.velocity_scale) + ": must be in (0, 1]");
  require(std::isfinite(settings.ramp) && settings.ramp >= 0.0,
          "TimingSettings::ramp = " + std::to_string(settings.ramp) + ": must be >= 0 s");
}

Eigen::VectorXd waypoint_times(const JointPath& path, const Eigen::VectorXd& velocity, const TimingSettings& settings) {
  validate(settings);
  require(path.waypoints.rows() > 0 && path.waypoints.cols() == velocity.size(),
          "waypoint_times: needs a waypoint, and one velocity limit per joint");
  require((velocity.array() > 0.0).all() && velocity.allFinite(),
          "waypoint_times: velocity limits must be positive and finite");
  const Eigen::Index count = path.waypoints.rows();
  Eigen::VectorXd u = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 1; i < count; ++i) {
    const Eigen::VectorXd step = (path.waypoints.row(i) - path.waypoints.row(i - 1)).transpose();
    const double duration = (step.array().abs() / velocity.array()).maxCoeff() / settings.velocity_scale;
    require(duration > 0.0, "waypoint_times: waypoint " + std::to_string(i) + " repeats the one before");
    u[i] = u[i - 1] + duration;
  }
  const double length = u[count - 1];
  if (settings.ramp == 0.0 || count < 2) return u;
  const double rate = 1.0 / settings.ramp;
  const double peak = std::min(1.0, std::sqrt(length * rate));
  Eigen::VectorXd times(count);
  for (Eigen::Index i = 0; i < count; ++i) times[i] = time_at(u[i], length, peak, rate);
  for (Eigen::Index i = 1; i < count; ++i) {
    require(times[i] > times[i - 1], "waypoint_times: waypoints " + std::to_string(i - 1) + " and " +
                                         std::to_string(i) + " are too close to be told apart in time");
  }
  return times;
}

}  // namespace opponens::motion
