// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/time_optimal.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "core/require.hpp"
#include "motion/half_planes.hpp"

namespace opponens::motion {
namespace {

/// A step of the grid: a straight piece, or a chord of an arc, with the path's derivatives at both ends.
struct Step {
  const PathPiece* piece;
  double begin;   ///< rad along the piece
  double length;  ///< rad
  Eigen::VectorXd direction_begin;
  Eigen::VectorXd direction_end;
  Eigen::VectorXd curvature_begin;
  Eigen::VectorXd curvature_end;
  bool rest;  ///< at its end
  bool straight() const { return piece->radius == 0.0; }
};

std::vector<Step> steps_of(const BlendedPath& path, const BlendSettings& settings) {
  std::vector<Step> steps;
  for (const PathPiece& piece : path.pieces) {
    const int count = piece.radius == 0.0 ? 1 : chords(piece, settings);
    for (int k = 0; k < count; ++k) {
      const double begin = piece.length * k / count;
      const double end = piece.length * (k + 1) / count;
      steps.push_back({&piece, begin, end - begin, direction(piece, begin), direction(piece, end),
                       curvature(piece, begin), curvature(piece, end), piece.rest && k + 1 == count});
    }
  }
  return steps;
}

/// Largest x = (ds/dt)^2 with |q' ds/dt| <= v.
double speed_cap(const Eigen::VectorXd& direction, const Eigen::VectorXd& velocity) {
  const double speed = (velocity.array() / direction.array().abs().max(1e-12)).minCoeff();
  return speed * speed;
}

/// Largest |d2s/dt2| on a straight piece.
double straight_rate(const Eigen::VectorXd& direction, const Eigen::VectorXd& acceleration) {
  return (acceleration.array() / direction.array().abs().max(1e-12)).minCoeff();
}

/// |q' u + q'' x| <= a at one end of a step, where x there is x_begin + share u.
void add_rows(std::vector<HalfPlane>& planes, const Eigen::VectorXd& direction, const Eigen::VectorXd& curvature,
              double share, const Eigen::VectorXd& acceleration) {
  for (Eigen::Index j = 0; j < direction.size(); ++j) {
    const double b = direction[j] + share * curvature[j];
    planes.push_back({curvature[j], b, acceleration[j]});
    planes.push_back({-curvature[j], -b, acceleration[j]});
  }
}

/// What x at the beginning of a chord and the acceleration u along it have to keep, when x at its end is at most x_end.
std::vector<HalfPlane> chord_rows(const Step& step, double x_begin, double x_end, const Eigen::VectorXd& acceleration) {
  std::vector<HalfPlane> planes;
  planes.reserve(4 * static_cast<std::size_t>(acceleration.size()) + 4);
  const double share = 2.0 * step.length;  // x_end = x_begin + 2 length u
  planes.push_back({1.0, 0.0, x_begin});
  planes.push_back({-1.0, 0.0, 0.0});
  planes.push_back({1.0, share, x_end});
  planes.push_back({-1.0, -share, 0.0});
  add_rows(planes, step.direction_begin, step.curvature_begin, 0.0, acceleration);
  add_rows(planes, step.direction_end, step.curvature_end, share, acceleration);
  return planes;
}

/// The grid with its pass backward and its pass forward.
class Pass {
 public:
  Pass(std::vector<Step> steps, const RateLimits& limits) : steps_(std::move(steps)), limits_(limits) {
    const std::size_t count = steps_.size();
    cap_.assign(count + 1, 0.0);
    for (std::size_t i = 1; i < count; ++i) {
      cap_[i] = steps_[i - 1].rest ? 0.0
                                   : std::min(speed_cap(steps_[i - 1].direction_end, limits_.velocity),
                                              speed_cap(steps_[i].direction_begin, limits_.velocity));
    }
    backward();
  }

  Trajectory forward();

 private:
  void backward();
  double reached(const Step& step, double x, double x_end) const;
  void add_straight(const Step& step, double x_begin, double x_end);
  void add_knot(const Step& step, double s, double x, double u, double x_next, double length);

  std::vector<Step> steps_;
  const RateLimits& limits_;
  std::vector<double> cap_;           ///< [steps + 1] of x, by the speeds
  std::vector<double> controllable_;  ///< [steps + 1] largest x from which the end can be reached
  std::vector<Eigen::VectorXd> positions_;
  std::vector<Eigen::VectorXd> velocities_;
  std::vector<Eigen::VectorXd> accelerations_;
  std::vector<double> times_{0.0};
};

/// The set of x that can be run from is an interval [0, largest]: it is convex, and 0 is in it.
void Pass::backward() {
  controllable_ = cap_;
  for (std::size_t i = steps_.size(); i-- > 0;) {
    const Step& step = steps_[i];
    double& x = controllable_[i];
    if (step.straight()) {
      const double rate = straight_rate(step.direction_begin, limits_.acceleration);
      x = std::min(x, controllable_[i + 1] + 2.0 * rate * step.length);
    } else {
      const auto planes = chord_rows(step, x, controllable_[i + 1], limits_.acceleration);
      // Not quite to the border, so that rounding does not leave the forward pass without an acceleration.
      x = (1.0 - 1e-9) * std::max(0.0, largest_x(planes).value_or(0.0));
    }
  }
}

/// Largest x at a step's end from x at its beginning.
double Pass::reached(const Step& step, double x, double x_end) const {
  if (step.straight()) {
    return std::min(x_end, x + 2.0 * straight_rate(step.direction_begin, limits_.acceleration) * step.length);
  }
  const Interval u = range_of_u(chord_rows(step, x, x_end, limits_.acceleration), x);
  const double chosen = u.empty() ? 0.5 * (u.lower + u.upper) : u.upper;
  return std::clamp(x + 2.0 * step.length * chosen, 0.0, x_end);
}

void Pass::add_knot(const Step& step, double s, double x, double u, double x_next, double length) {
  const double speed = std::sqrt(x);
  const Eigen::VectorXd tangent = direction(*step.piece, s);
  positions_.push_back(position(*step.piece, s));
  velocities_.push_back(speed * tangent);
  accelerations_.push_back(u * tangent + x * curvature(*step.piece, s));
  times_.push_back(times_.back() + 2.0 * length / (speed + std::sqrt(x_next)));
}

/// Up with the largest rate, at the cap, and down: as many of the three as there is room for.
void Pass::add_straight(const Step& step, double x_begin, double x_end) {
  const double rate = straight_rate(step.direction_begin, limits_.acceleration);
  const double cap = speed_cap(step.direction_begin, limits_.velocity);
  const double peak = std::max({x_begin, x_end, std::min(cap, 0.5 * (x_begin + x_end) + rate * step.length)});
  const double up = std::min(step.length, 0.5 * (peak - x_begin) / rate);
  const double down = std::min(step.length - up, 0.5 * (peak - x_end) / rate);
  const double level = step.length - up - down;
  constexpr double kShort = 1e-9;  // rad: not worth a knot
  double s = 0.0;
  double x = x_begin;
  const auto add = [&](double length, double x_next) {
    if (length < kShort) return;
    add_knot(step, s, x, 0.5 * (x_next - x) / length, x_next, length);
    s += length;
    x = x_next;
  };
  add(up, level < kShort && down < kShort ? x_end : peak);
  add(level, down < kShort ? x_end : peak);
  add(down, x_end);
}

Trajectory Pass::forward() {
  double x = 0.0;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step& step = steps_[i];
    const double x_end = reached(step, x, controllable_[i + 1]);
    if (step.straight()) {
      add_straight(step, x, x_end);
    } else {
      require(x + x_end > 0.0, "time_optimal: an arc between two stops");
      add_knot(step, step.begin, x, 0.5 * (x_end - x) / step.length, x_end, step.length);
    }
    x = x_end;
  }
  const auto count = static_cast<Eigen::Index>(positions_.size()) + 1;
  const Eigen::Index d = limits_.velocity.size();
  Trajectory result{Eigen::MatrixXd(count, d), Eigen::MatrixXd::Zero(count, d), Eigen::MatrixXd(count, d),
                    Eigen::Map<const Eigen::VectorXd>(times_.data(), count)};
  for (Eigen::Index i = 0; i + 1 < count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    result.positions.row(i) = positions_[index].transpose();
    result.velocities.row(i) = velocities_[index].transpose();
    result.accelerations.row(i) = accelerations_[index].transpose();
  }
  const Step& last = steps_.back();
  result.positions.row(count - 1) = position(*last.piece, last.begin + last.length).transpose();
  result.accelerations.row(count - 1) = result.accelerations.row(count - 2);  // the last piece is straight
  return result;
}

}  // namespace

Trajectory time_optimal(const BlendedPath& path, const RateLimits& limits, const BlendSettings& settings) {
  validate(settings);
  require(!path.pieces.empty(), "time_optimal: the path is empty");
  const Eigen::Index d = path.pieces.front().y.size();
  for (const Eigen::VectorXd* limit : {&limits.velocity, &limits.acceleration}) {
    require(limit->size() == d && limit->allFinite() && (limit->array() > 0.0).all(),
            "time_optimal: limits must be one positive and finite number for each joint");
  }
  require(path.pieces.front().radius == 0.0 && path.pieces.back().radius == 0.0,
          "time_optimal: the path must begin and end with a straight piece");
  const double room = std::cos(0.5 * settings.arc_step);  // of what lies between the ends of a chord
  const RateLimits kept{room * limits.velocity, room * limits.acceleration};
  return Pass(steps_of(path, settings), kept).forward();
}

Trajectory joined(const Trajectory& first, const Trajectory& second) {
  const Eigen::Index end = first.times.size() - 1;
  require(end >= 0 && second.times.size() > 0 && first.positions.cols() == second.positions.cols() &&
              (first.positions.row(end) - second.positions.row(0)).norm() < 1e-9,
          "joined: the second trajectory must begin where the first ends");
  const Eigen::Index more = second.times.size();
  Trajectory result{Eigen::MatrixXd(end + more, first.positions.cols()),
                    Eigen::MatrixXd(end + more, first.positions.cols()),
                    Eigen::MatrixXd(end + more, first.positions.cols()), Eigen::VectorXd(end + more)};
  result.positions << first.positions.topRows(end), second.positions;
  result.velocities << first.velocities.topRows(end), second.velocities;
  result.accelerations << first.accelerations.topRows(end), second.accelerations;
  result.times << first.times.head(end), (second.times.array() + first.times[end]).matrix();
  return result;
}

Eigen::MatrixXd state_at(const Trajectory& trajectory, double time) {
  const Eigen::VectorXd& times = trajectory.times;
  require(times.size() > 1 && time >= times[0] && time <= times[times.size() - 1],
          [&] { return "state_at: time " + std::to_string(time) + " s is outside the trajectory"; });
  const double* const after = std::upper_bound(times.data() + 1, times.data() + times.size() - 1, time);
  const Eigen::Index i = after - times.data() - 1;
  const double h = times[i + 1] - times[i];
  const double t = (time - times[i]) / h;
  const Eigen::RowVectorXd v0 = h * trajectory.velocities.row(i);
  const Eigen::RowVectorXd v1 = h * trajectory.velocities.row(i + 1);
  const Eigen::RowVectorXd step = trajectory.positions.row(i + 1) - trajectory.positions.row(i);
  const Eigen::RowVectorXd second = 3.0 * step - 2.0 * v0 - v1;
  const Eigen::RowVectorXd third = v0 + v1 - 2.0 * step;
  Eigen::MatrixXd state(3, trajectory.positions.cols());
  state.row(0) = trajectory.positions.row(i) + t * (v0 + t * (second + t * third));
  state.row(1) = (v0 + t * (2.0 * second + 3.0 * t * third)) / h;
  state.row(2) = (2.0 * second + 6.0 * t * third) / (h * h);
  return state;
}

double least_duration(const Eigen::MatrixXd& waypoints, const RateLimits& limits) {
  require(waypoints.rows() > 0 && waypoints.cols() == limits.velocity.size(),
          "least_duration: needs a waypoint, and one limit per joint");
  double at_full_speed = 0.0;
  for (Eigen::Index i = 1; i < waypoints.rows(); ++i) {
    const Eigen::VectorXd step = (waypoints.row(i) - waypoints.row(i - 1)).transpose();
    at_full_speed += (step.array().abs() / limits.velocity.array()).maxCoeff();
  }
  double rest_to_rest = 0.0;
  for (Eigen::Index j = 0; j < waypoints.cols(); ++j) {
    const double way = std::abs(waypoints(waypoints.rows() - 1, j) - waypoints(0, j));
    const double v = limits.velocity[j];
    const double a = limits.acceleration[j];
    rest_to_rest = std::max(rest_to_rest, way * a > v * v ? way / v + v / a : 2.0 * std::sqrt(way / a));
  }
  return std::max(at_full_speed, rest_to_rest);
}

}  // namespace opponens::motion
