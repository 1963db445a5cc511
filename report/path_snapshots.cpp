// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <numbers>

#include "report/scene_drawing.hpp"
#include "report/sections.hpp"

namespace opponens::report {
namespace {

/// A place on the path: row + fraction of the way to the next one.
double place_at(const Eigen::MatrixXd& path, Eigen::Index last, double share) {
  std::vector<double> covered{0.0};
  for (Eigen::Index i = 1; i <= last; ++i) covered.push_back(covered.back() + (path.row(i) - path.row(i - 1)).norm());
  const double wanted = share * covered.back();
  const auto found = std::upper_bound(covered.begin(), covered.end(), wanted);
  if (found == covered.end()) return static_cast<double>(last);
  const auto next = found - covered.begin();
  return static_cast<double>(next - 1) + (wanted - *(found - 1)) / (*found - *(found - 1));
}

/// The row at a place, between two stored ones.
Eigen::VectorXd at_place(const Eigen::MatrixXd& rows, double place) {
  const auto row = static_cast<Eigen::Index>(place);
  const Eigen::Index next = std::min(row + 1, rows.rows() - 1);
  return rows.row(row).transpose() + (place - static_cast<double>(row)) * (rows.row(next) - rows.row(row)).transpose();
}

struct Snapshot {
  double place;
  std::string name;
};

std::vector<Snapshot> snapshots(const PathPart& part) {
  const Eigen::Index last = part.path.waypoints.rows() - 1;
  const Eigen::Index middle_end = part.pregrasp > 0 ? part.pregrasp : last;
  const int between = std::max(1, part.pictures - (part.pregrasp > 0 ? 3 : 2));
  std::vector<Snapshot> shots{{0.0, "start"}};
  for (int i = 1; i <= between; ++i) {
    const double share = static_cast<double>(i) / (between + 1);
    const std::string end = part.pregrasp > 0 ? " of the way to the pre-grasp" : " of the way";
    shots.push_back({place_at(part.path.waypoints, middle_end, share), percent(share, 0) + end});
  }
  if (part.pregrasp > 0) shots.push_back({static_cast<double>(part.pregrasp), "pre-grasp"});
  shots.push_back({static_cast<double>(last), part.pregrasp > 0 ? "grasp" : "end"});
  return shots;
}

std::string snapshot_caption(const PathPart& part, const Snapshot& shot) {
  if (part.times.size() == 0) return shot.name;
  return concat({shot.name, ", t = ", fixed(at_place(part.times, shot.place)[0], 2), " s"});
}

/// Where a palm (link index) passes, in the world; at most about 120 points.
Trail palm_trail(const robot::RobotModel& robot, const robot::Scene& scene, int palm,
                 const std::vector<Eigen::VectorXd>& configurations) {
  Trail trail;
  std::vector<Eigen::Isometry3d> X_RL;
  const std::size_t step = std::max<std::size_t>(1, configurations.size() / 120);
  for (std::size_t i = 0; i < configurations.size(); i += step) {
    robot.link_poses(configurations[i], X_RL);
    trail.push_back(scene.X_WR * X_RL[static_cast<std::size_t>(palm)].translation());
  }
  if (configurations.empty()) return trail;
  robot.link_poses(configurations.back(), X_RL);
  trail.push_back(scene.X_WR * X_RL[static_cast<std::size_t>(palm)].translation());
  return trail;
}

struct CameraSetting {
  Camera camera;
  std::string words;
  double width, height;
  const char* css_class;
};

constexpr double kDegree = std::numbers::pi / 180.0;

/// What is grasped: one object, or one of each arm.
std::vector<std::string> objects_of(const ReportInput& input) {
  std::vector<std::string> objects;
  objects.push_back(input.grasps ? input.grasps->object : input.scene->object);
  for (const auto& further : input.further_hands) objects.push_back(further.grasps.object);
  if (objects.front().empty()) objects.clear();
  return objects;
}

}  // namespace

Markup path_snapshots(const ReportInput& input) {
  const auto& part = *input.path;
  const auto& robot = *input.robot;
  const auto& scene = *input.scene;
  const std::vector<std::string> objects = objects_of(input);
  std::vector<Eigen::VectorXd> all;
  const Eigen::VectorXd rest = rest_configuration(robot);
  for (Eigen::Index i = 0; i < part.path.waypoints.rows(); ++i) {
    all.push_back(robot.clip(by_name(robot, part.path.joint_names, part.path.waypoints.row(i).transpose(), rest)));
  }
  const auto shots = snapshots(part);
  std::vector<Eigen::VectorXd> shown;
  shown.reserve(shots.size());
  for (const auto& shot : shots) {
    shown.push_back(robot.clip(by_name(robot, part.path.joint_names, at_place(part.path.waypoints, shot.place), rest)));
  }
  std::vector<Trail> trails;
  for (const auto& arm : robot.arms()) trails.push_back(palm_trail(robot, scene, arm.palm, all));
  const DrawnScene drawn = drawn_scene(robot, scene, objects, 5000);
  const std::vector<CameraSetting> cameras{
      {{42.0 * kDegree, 22.0 * kDegree},
       "from behind the robot's left shoulder, 42\u00B0 off the line from robot to object, 22\u00B0 above the horizon",
       520.0,
       440.0,
       "shots"},
      {{-75.0 * kDegree, 12.0 * kDegree},
       "from the robot's right, 75\u00B0 off that line, 12\u00B0 above the horizon",
       260.0,
       240.0,
       "shots small"}};
  Markup out;
  for (const auto& setting : cameras) {
    const View view = scene_view(robot, scene, objects, drawn, setting.camera, shown, setting.width, setting.height);
    std::vector<Markup> figures;
    for (std::size_t i = 0; i < shots.size(); ++i) {
      const std::string caption = snapshot_caption(part, shots[i]);
      figures.push_back(figure(
          draw_scene(robot, scene, drawn, view, shown[i], trails, concat({"Robot and scene: ", caption})), caption));
    }
    out += subheading(concat({"Seen ", setting.words}));
    out += row_of(figures, setting.css_class);
  }
  out += note(concat(
      {trails.size() == 1 ? "Blue line: the way of the palm, from" : "Blue lines: the ways of the palms, each from",
       " the open to the filled dot. Robot and object show faintly through what hides them. Shapes are the "
       "collision geometry."}));
  return out;
}

}  // namespace opponens::report
