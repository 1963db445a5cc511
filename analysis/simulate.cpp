// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/require.hpp"
#include "core/rng.hpp"

namespace opponens::analysis {
namespace {

Eigen::VectorXd normal_vector(Eigen::Index size, double deviation, Rng& rng) {
  Eigen::VectorXd result(size);
  for (Eigen::Index i = 0; i < size; ++i) result[i] = deviation * rng.normal();
  return result;
}

Eigen::VectorXd uniform_vector(Eigen::Index size, double high, Rng& rng) {
  Eigen::VectorXd result(size);
  for (Eigen::Index i = 0; i < size; ++i) result[i] = rng.uniform(0.0, high);
  return result;
}

Eigen::VectorXd clip(const SimulationModel& model, const Eigen::VectorXd& q) {
  return q.cwiseMax(model.lower).cwiseMin(model.upper);
}

/// What the glove reports: noise, then rounding to its resolution.
void measure(const SimulationModel& model, Eigen::MatrixXd& q, Rng& rng) {
  for (Eigen::Index row = 0; row < q.rows(); ++row) {
    for (Eigen::Index column = 0; column < q.cols(); ++column) {
      double& value = q(row, column);
      value += model.noise * rng.normal();
      if (model.resolution > 0.0) value = std::round(value / model.resolution) * model.resolution;
    }
  }
}

Eigen::VectorXd sample_times(double duration, double rate) {
  const auto samples = static_cast<Eigen::Index>(std::floor(duration * rate)) + 1;
  return Eigen::VectorXd::LinSpaced(samples, 0.0, static_cast<double>(samples - 1)) / rate;
}

Demonstration movement(const SimulationModel& model, const SimulationSettings& settings, const SimulatedGraspType& type,
                       int repetition, Rng& rng) {
  const auto n = static_cast<Eigen::Index>(model.channels.size());
  const GraspEnd& target = type.ends[static_cast<std::size_t>(repetition) % type.ends.size()];
  const double opening = model.opening_duration * std::exp(model.duration_spread * rng.normal());
  const double closing = model.closing_duration * std::exp(model.duration_spread * rng.normal());
  const double open_factor = 1.0 + model.amplitude_spread * rng.normal();
  const double close_factor = 1.0 + model.amplitude_spread * rng.normal();
  const Eigen::VectorXd rest = clip(model, model.rest + normal_vector(n, model.rest_spread, rng));
  const Eigen::VectorXd open =
      clip(model, rest + open_factor * (model.open - rest) + normal_vector(n, model.open_spread, rng));
  const Eigen::VectorXd end =
      clip(model, open + close_factor * (target.posture - open) + normal_vector(n, model.end_spread, rng));
  const Eigen::VectorXd open_onset = uniform_vector(n, model.onset_spread, rng);
  const Eigen::VectorXd close_onset = uniform_vector(n, model.onset_spread, rng);

  Demonstration result;
  result.origin = Origin::simulated;
  result.joint_names = model.channels;
  result.known_transition = opening;
  result.time = sample_times(opening + closing, settings.rate);
  result.q_h.resize(result.time.size(), n);
  for (Eigen::Index row = 0; row < result.q_h.rows(); ++row) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const double t = result.time[row];
      const double first = minimum_jerk((t - open_onset[j]) / (opening - open_onset[j]));
      const double second = minimum_jerk((t - opening - close_onset[j]) / (closing - close_onset[j]));
      result.q_h(row, j) = rest[j] + first * (open[j] - rest[j]) + second * (end[j] - open[j]);
    }
  }
  measure(model, result.q_h, rng);
  const std::string number = std::to_string(repetition + 1);
  result.id = "sim_" + type.name + "_r" + (number.size() < 2 ? "0" : "") + number;
  result.labels = {{"subject", settings.subject},
                   {"object", target.object},
                   {"grasp_type", type.name},
                   {"family", type.family},
                   {"family_assumed", type.family_assumed ? "true" : "false"},
                   {"repetition", number},
                   {"kind", "grasp"}};
  return result;
}

/// A course in [0, 1]: minimum-jerk segments between uniform random targets, of uniform random durations.
Eigen::VectorXd random_course(const FreeMotionModel& free, const Eigen::VectorXd& time, Rng& rng) {
  Eigen::VectorXd course(time.size());
  double begin = 0.0;
  double duration = rng.uniform(free.segment_shortest, free.segment_longest);
  double from = rng.uniform();
  double to = rng.uniform();
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    while (time[i] >= begin + duration) {
      begin += duration;
      duration = rng.uniform(free.segment_shortest, free.segment_longest);
      from = to;
      to = rng.uniform();
    }
    course[i] = from + (to - from) * minimum_jerk((time[i] - begin) / duration);
  }
  return course;
}

Demonstration free_motion(const SimulationModel& model, const SimulationSettings& settings, int number, Rng& rng) {
  const auto n = static_cast<Eigen::Index>(model.channels.size());
  Demonstration result;
  result.id = "sim_free_" + std::to_string(number + 1);
  result.origin = Origin::simulated;
  result.labels = {{"subject", settings.subject}, {"repetition", std::to_string(number + 1)}, {"kind", "free"}};
  result.joint_names = model.channels;
  result.time = sample_times(model.free.duration, settings.rate);
  result.q_h.resize(result.time.size(), n);
  std::map<std::string, Eigen::VectorXd> finger_course;
  for (Eigen::Index j = 0; j < n; ++j) {
    const std::string& finger = model.fingers[static_cast<std::size_t>(j)];
    Eigen::VectorXd course;
    if (finger.empty()) {
      course = random_course(model.free, result.time, rng);
    } else {
      const auto [entry, added] = finger_course.try_emplace(finger);
      if (added) entry->second = random_course(model.free, result.time, rng);
      // A uniform variable on [0, 1] has standard deviation 1/sqrt(12).
      const Eigen::VectorXd own = random_course(model.free, result.time, rng);
      course = entry->second.array() + model.free.deviation * std::sqrt(12.0) * (own.array() - 0.5);
    }
    const double range = model.upper[j] - model.lower[j];
    result.q_h.col(j) = model.lower[j] + range * course.array().max(0.0).min(1.0);
  }
  measure(model, result.q_h, rng);
  return result;
}

void validate_free(const FreeMotionModel& free) {
  require(free.recordings >= 0 && free.duration > 0.0,
          "simulation model: free motion needs recordings >= 0, duration > 0");
  require(free.segment_shortest > 0.0 && free.segment_longest >= free.segment_shortest,
          "simulation model: free motion needs 0 < segment_shortest <= segment_longest");
  require(free.deviation >= 0.0, "simulation model: free deviation must be >= 0");
}

}  // namespace

double minimum_jerk(double u) {
  if (u <= 0.0) return 0.0;
  if (u >= 1.0) return 1.0;
  return u * u * u * (10.0 + u * (6.0 * u - 15.0));
}

void validate(const SimulationModel& model) {
  const auto n = static_cast<Eigen::Index>(model.channels.size());
  const auto posture = [&](const Eigen::VectorXd& q, const std::string& name) {
    require(q.size() == n && q.allFinite(), "simulation model: " + name + " needs one finite value per channel");
    require(((q - model.lower).array() >= -1e-9).all() && ((model.upper - q).array() >= -1e-9).all(),
            "simulation model: " + name + " leaves the joint ranges");
  };
  require(n >= 1 && model.fingers.size() == model.channels.size() && model.lower.size() == n && model.upper.size() == n,
          "simulation model: channels, fingers, lower and upper differ in length");
  require((model.lower.array() < model.upper.array()).all(), "simulation model: a joint range is empty");
  posture(model.rest, "rest");
  posture(model.open, "open");
  require(!model.types.empty(), "simulation model: no grasp types");
  for (const SimulatedGraspType& type : model.types) {
    require(!type.ends.empty(), "simulation model: type " + type.name + " has no end posture");
    for (const GraspEnd& end : type.ends) posture(end.posture, "type " + type.name + " on " + end.object);
  }
  require(model.opening_duration > 0.0 && model.closing_duration > 0.0 && model.onset_spread >= 0.0 &&
              model.onset_spread < 0.5 * std::min(model.opening_duration, model.closing_duration),
          "simulation model: durations must be > 0 and more than twice onset_spread");
  for (const double spread : {model.duration_spread, model.amplitude_spread, model.rest_spread, model.open_spread,
                              model.end_spread, model.noise, model.resolution}) {
    require(std::isfinite(spread) && spread >= 0.0, "simulation model: a spread, noise or resolution is negative");
  }
  validate_free(model.free);
}

std::vector<Demonstration> simulate(const SimulationModel& model, const SimulationSettings& settings,
                                    std::uint64_t seed) {
  validate(model);
  require(settings.repetitions >= 1 && settings.rate > 0.0, "simulate: repetitions must be >= 1, rate > 0 Hz");
  std::vector<Demonstration> recordings;
  for (const SimulatedGraspType& type : model.types) {
    for (int repetition = 0; repetition < settings.repetitions; ++repetition) {
      Rng rng = stream(seed, "simulate/" + type.name + "/" + std::to_string(repetition));
      recordings.push_back(movement(model, settings, type, repetition, rng));
    }
  }
  for (int number = 0; number < model.free.recordings; ++number) {
    Rng rng = stream(seed, "simulate/free/" + std::to_string(number));
    recordings.push_back(free_motion(model, settings, number, rng));
  }
  return recordings;
}

}  // namespace opponens::analysis
