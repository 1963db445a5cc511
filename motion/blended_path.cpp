// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/blended_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>

#include "core/require.hpp"

namespace opponens::motion {
namespace {

constexpr double kStraight = 1e-9;  ///< rad: a smaller turn needs no arc, a shorter straight piece is left out

/// A blend around an inner waypoint: none (a stop) when it has no arc and turns, or passed straight on.
struct Corner {
  double reach = 0.0;  ///< rad, l: from the waypoint to where the arc begins and ends
  PathPiece arc;       ///< of length 0: none
  bool stop = false;
};

/// The arc with reach l around `corner`, from direction `in` to `out`, turning by alpha.
Corner arc_around(const Eigen::VectorXd& corner, const Eigen::VectorXd& in, const Eigen::VectorXd& out, double alpha,
                  double reach) {
  const double radius = reach / std::tan(0.5 * alpha);
  const Eigen::VectorXd centre = corner + (out - in).normalized() * (radius / std::cos(0.5 * alpha));
  PathPiece arc;
  arc.origin = centre;
  arc.x = (corner - reach * in - centre).normalized();
  arc.y = in;
  arc.radius = radius;
  arc.length = radius * alpha;
  return {reach, std::move(arc), false};
}

class Blending {
 public:
  Blending(const Eigen::MatrixXd& waypoints, const World& world, const BlendSettings& settings,
           const FollowedBoxes* boxes)
      : waypoints_(waypoints), world_(world), settings_(settings), boxes_(boxes) {
    if (boxes_ != nullptr) {
      const auto row = change_row(*boxes_, waypoints_);
      require(row.has_value(), "blend_corners: the path is further from its boxes than they allow");
      change_row_ = *row;
    }
  }

  BlendedPath path() {
    std::vector<Corner> corners(static_cast<std::size_t>(waypoints_.rows()));
    for (int i = 1; i + 1 < waypoints_.rows(); ++i) corners[static_cast<std::size_t>(i)] = blend(i);
    while (give_up_blends(corners)) {
    }
    return assembled(corners);
  }

 private:
  Eigen::VectorXd row(int i) const { return waypoints_.row(i).transpose(); }
  Eigen::VectorXd way(int i) const { return (row(i + 1) - row(i)).normalized(); }
  double length(int i) const { return (row(i + 1) - row(i)).norm(); }

  Corner blend(int i) {
    const Eigen::VectorXd in = way(i - 1);
    const Eigen::VectorXd out = way(i);
    const double alpha = 2.0 * std::atan2((out - in).norm(), (out + in).norm());
    if (alpha < kStraight) return {};
    if (alpha > std::numbers::pi - 1e-3) return {0.0, {}, true};
    double reach = std::min({0.5 * length(i - 1), 0.5 * length(i),
                             settings_.deviation * std::sin(0.5 * alpha) / (1.0 - std::cos(0.5 * alpha))});
    // Beside a segment hardly longer than nothing there is no room: what is left of it has to be a piece still.
    for (int k = 0; k <= settings_.halvings && reach >= kStraight; ++k, reach *= 0.5) {
      Corner corner = arc_around(row(i), in, out, alpha, reach);
      corner.arc.row = i;
      if (valid(corner.arc, i)) return corner;
    }
    return {0.0, {}, true};
  }

  bool valid(const PathPiece& arc, int i) {
    const int count = chords(arc, settings_);
    Eigen::MatrixXd rows(count + 1, waypoints_.cols());
    for (int k = 0; k <= count; ++k) rows.row(k) = position(arc, arc.length * k / count).transpose();
    if (boxes_ != nullptr && i == change_row_ && !change_row(*boxes_, rows)) return false;
    for (int k = 0; k < count; ++k) {
      if (!valid_motion(world_, rows.row(k).transpose(), rows.row(k + 1).transpose(), checks_)) return false;
    }
    return true;
  }

  /// What is left of a segment is checked at other fractions than the whole was. Where that finds something, the blends
  /// at both ends make room for the segment as it was. Whether any did.
  bool give_up_blends(std::vector<Corner>& corners) {
    bool any = false;
    for (int i = 0; i + 1 < waypoints_.rows(); ++i) {
      Corner& from = corners[static_cast<std::size_t>(i)];
      Corner& to = corners[static_cast<std::size_t>(i) + 1];
      if (from.reach + to.reach == 0.0 || length(i) - from.reach - to.reach < kStraight) continue;
      const Eigen::VectorXd begin = row(i) + from.reach * way(i);
      const Eigen::VectorXd end = row(i + 1) - to.reach * way(i);
      if (valid_motion(world_, begin, end, checks_)) continue;
      for (Corner* corner : {&from, &to}) {
        if (corner->reach > 0.0) *corner = {0.0, {}, true};
      }
      any = true;
    }
    return any;
  }

  BlendedPath assembled(const std::vector<Corner>& corners) const {
    BlendedPath path;
    path.corners = std::max(0, static_cast<int>(waypoints_.rows()) - 2);
    path.collision_checks = checks_;
    for (int i = 0; i + 1 < waypoints_.rows(); ++i) {
      const Corner& from = corners[static_cast<std::size_t>(i)];
      const Corner& to = corners[static_cast<std::size_t>(i) + 1];
      const double left = length(i) - from.reach - to.reach;
      if (left >= kStraight) {
        PathPiece straight{row(i) + from.reach * way(i), {}, way(i), 0.0, left, to.stop, i};
        path.pieces.push_back(std::move(straight));
      }
      if (to.stop) ++path.stops;
      if (to.arc.length > 0.0) path.pieces.push_back(to.arc);
    }
    path.pieces.back().rest = true;
    return path;
  }

  const Eigen::MatrixXd& waypoints_;
  const World& world_;
  const BlendSettings& settings_;
  const FollowedBoxes* boxes_;
  int change_row_ = -1;
  std::int64_t checks_ = 0;
};

void require_path(const Eigen::MatrixXd& waypoints, const std::string& caller) {
  require(waypoints.rows() >= 2 && waypoints.cols() > 0 && waypoints.allFinite(),
          caller + ": needs two waypoints at least, of finite entries");
  for (Eigen::Index i = 1; i < waypoints.rows(); ++i) {
    require((waypoints.row(i) - waypoints.row(i - 1)).norm() > kStraight,
            [&] { return caller + ": waypoint " + std::to_string(i) + " repeats the one before"; });
  }
}

}  // namespace

Eigen::VectorXd position(const PathPiece& piece, double s) {
  if (piece.radius == 0.0) return piece.origin + s * piece.y;
  const double angle = s / piece.radius;
  return piece.origin + piece.radius * (piece.x * std::cos(angle) + piece.y * std::sin(angle));
}

Eigen::VectorXd direction(const PathPiece& piece, double s) {
  if (piece.radius == 0.0) return piece.y;
  const double angle = s / piece.radius;
  return piece.y * std::cos(angle) - piece.x * std::sin(angle);
}

Eigen::VectorXd curvature(const PathPiece& piece, double s) {
  if (piece.radius == 0.0) return Eigen::VectorXd::Zero(piece.y.size());
  const double angle = s / piece.radius;
  return -(piece.x * std::cos(angle) + piece.y * std::sin(angle)) / piece.radius;
}

Eigen::MatrixXd distinct(const Eigen::MatrixXd& waypoints) {
  Eigen::MatrixXd result(waypoints.rows(), waypoints.cols());
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < waypoints.rows(); ++i) {
    const bool repeats = count > 0 && (waypoints.row(i) - result.row(count - 1)).norm() <= kStraight;
    if (!repeats) {
      result.row(count++) = waypoints.row(i);
    } else if (i + 1 == waypoints.rows() && count > 1) {
      result.row(count - 1) = waypoints.row(i);  // the end itself, not the waypoint beside it
    }
  }
  result.conservativeResize(count, Eigen::NoChange);
  return result;
}

void validate(const BlendSettings& settings) {
  const auto positive = [](const char* field, double value) {
    require(std::isfinite(value) && value > 0.0, [&] {
      return std::string("BlendSettings::") + field + " = " + std::to_string(value) + ": must be positive and finite";
    });
  };
  positive("deviation", settings.deviation);
  positive("arc_deviation", settings.arc_deviation);
  positive("arc_step", settings.arc_step);
  require(settings.halvings >= 0,
          [&] { return "BlendSettings::halvings = " + std::to_string(settings.halvings) + ": must be >= 0"; });
}

int chords(const PathPiece& arc, const BlendSettings& settings) {
  const double turn = arc.length / arc.radius;
  // A chord of turn t is off the arc by radius (1 - cos(t / 2)) <= radius t^2 / 8.
  const double step = std::min(settings.arc_step, std::sqrt(8.0 * settings.arc_deviation / arc.radius));
  return std::max(1, static_cast<int>(std::ceil(turn / step)));
}

BlendedPath blend_corners(const Eigen::MatrixXd& waypoints, const World& world, const BlendSettings& settings,
                          const FollowedBoxes* boxes) {
  validate(settings);
  require_path(waypoints, "blend_corners");
  return Blending(waypoints, world, settings, boxes).path();
}

BlendedPath stop_at_corners(const Eigen::MatrixXd& waypoints) {
  require_path(waypoints, "stop_at_corners");
  BlendedPath path;
  path.corners = path.stops = static_cast<int>(waypoints.rows()) - 2;
  for (int i = 0; i + 1 < waypoints.rows(); ++i) {
    const Eigen::VectorXd step = (waypoints.row(i + 1) - waypoints.row(i)).transpose();
    path.pieces.push_back({waypoints.row(i).transpose(), {}, step.normalized(), 0.0, step.norm(), true, i});
  }
  return path;
}

}  // namespace opponens::motion
