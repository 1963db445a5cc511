// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/planning.hpp"

#include <algorithm>
#include <ctime>
#include <utility>

#include "core/require.hpp"
#include "motion/blended_path.hpp"
#include "motion/closing_segment.hpp"
#include "motion/edge_check.hpp"
#include "motion/goal_configurations.hpp"
#include "motion/grown_scene.hpp"
#include "motion/joint_groups.hpp"
#include "motion/joint_metric.hpp"
#include "motion/pair_depth.hpp"
#include "motion/scene_clearance.hpp"
#include "motion/shortcut.hpp"
#include "motion/smooth.hpp"

namespace opponens::cli {
namespace {

using analysis::LikenessReference;

/// m: nothing further away is asked about when a path is smoothed.
constexpr double kSmoothingReach = 0.011;

/// Covariance of a group's grasp phase, in radians.
LikenessReference grasp_phase_reference(const SynergyGroup& group) {
  const Eigen::MatrixXd scaled = group.basis.axes * group.basis.variance.asDiagonal() * group.basis.axes.transpose();
  return {"grasp phase of group " + group.name, group.box.scale.asDiagonal() * scaled * group.box.scale.asDiagonal()};
}

/// m. Paths keep a clearance that is proven for all of their motion (motion::ContinuousCheck). The search itself asks
/// at samples, so it asks of bodies this much larger, a little more than the clearance: then few answers fail.
constexpr double kGrowth = 0.00075;

/// Bodies that the start is nearer to than that are left as they are.
std::set<std::string> near_start(const Eigen::VectorXd& start, const NamedWorld& world) {
  std::set<std::string> bodies;
  const robot::CollisionChecker grown(world.robot, motion::grown_scene(world.scene, kGrowth));
  for (const robot::BodyPair& pair : grown.colliding_pairs(start)) bodies.insert(pair.second);
  return bodies;
}

std::set<std::string> with(std::set<std::string> names, const std::string& name) {
  names.insert(name);
  return names;
}

std::vector<motion::GroupLimit> limits_of(const robot::RobotModel& robot, const GroupLengths& own) {
  std::vector<motion::GroupLimit> limits;
  if (own.arm) limits.push_back(motion::limit_of(robot.arm(), *own.arm));
  if (own.hand) limits.push_back(motion::limit_of(robot.hand(), *own.hand));
  return limits;
}

/// Closing segments are looked at as densely as any group's motion.
double densest(const PlanOptions& options) {
  const GroupLengths& own = options.own_resolution;
  return std::min({options.resolution, own.arm.value_or(options.resolution), own.hand.value_or(options.resolution)});
}

/// How far planned and final path are from the boxes they follow, at most.
Json distances(const motion::FollowedBoxes& boxes, const Run& run) {
  const Eigen::MatrixXd final = run.motion.waypoints.topRows(run.pregrasp_row + 1);
  const auto change = motion::change_row(boxes, final);
  require(change.has_value(), "plan: the final path is further from its boxes than the planned one");
  const auto after = motion::followed_boxes(final, *change, boxes.start, boxes.goal);
  return {{"start_planned", boxes.start_limit},
          {"start_final", after.start_limit},
          {"goal_planned", boxes.goal_limit},
          {"goal_final", after.goal_limit}};
}

double thread_cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

Query make_query(const storage::Store& store, const NamedWorld& world) {
  auto synergies = newest_synergies(store);
  require_same_joints(synergies.value, world.hand);
  Query query{start_configuration(world.robot, world.scene), std::move(synergies.value), {}, {}, {}, {}};
  query.grasps = grasps_of(store, synergies.id, world.key());
  if (query.grasps.empty()) {
    throw InputError(store.directory().string() + ": no grasps of " + world.object +
                     " with this robot, scene and the newest synergies; run: opponens grasp");
  }
  for (std::size_t i = 0; i < query.grasps.size(); ++i) {
    const Grasp& grasp = query.grasps[i].value;
    for (const auto& arm : grasp.arm_solutions) {
      query.goals.push_back({motion::join(world.robot, arm.q_pregrasp, grasp.q_pregrasp),
                             group_named(query.synergies, grasp.group).box, static_cast<int>(query.goals.size())});
      query.grasp_of_goal.push_back(i);
      query.q_grasp.push_back(motion::join(world.robot, arm.q_grasp, grasp.q_grasp));
    }
  }
  return query;
}

std::optional<LikenessReference> free_motion_reference(const storage::Store& store) {
  const Motions motions = hand_motions(store);
  std::vector<const Demonstration*> values;
  for (const auto& motion : motions.newest) values.push_back(&motion.value);
  return analysis::free_motion_reference(values);
}

Planning::Planning(const PlanOptions& options, const NamedWorld& world, Query query,
                   std::optional<LikenessReference> free_motion)
    : options_(options),
      world_(world),
      query_(std::move(query)),
      free_motion_(std::move(free_motion)),
      near_start_(near_start(query_.start, world)),
      exact_(world.robot, world.scene),
      clearance_(std::make_shared<const motion::ContinuousCheck>(
          motion::ContinuousCheck(exact_, world.robot).starting_at(query_.start))),
      free_(world.robot, motion::grown_scene(world.scene, kGrowth, near_start_)),
      closing_free_(world.robot, motion::grown_scene(world.scene, kGrowth, with(near_start_, world.object))),
      closing_(world.robot, motion::grown_scene(world.scene, kGrowth, with(near_start_, world.object)),
               world.hand_object_pairs()),
      depth_(world.robot, world.scene, world.object, world.hand_links()),
      space_(motion::make_world(free_, world.robot,
                                {options.resolution, limits_of(world.robot, options.own_resolution)}, clearance_)) {
  const auto variant = motion::variant_named(options.planner);
  require(variant.has_value(), "--planner: no such planner: " + options.planner);
  settings_.variant = *variant;
  settings_.step = options.step;
  settings_.max_checks = options.max_checks;
  settings_.group_steps = limits_of(world.robot, options.own_step);
  settings_.diagnose = options.diagnose;
  settings_.time_limit = options.time_limit.value_or(0.0);
  settings_.interrupted = [] { return interrupt_requested.load(); };
  motion::validate(settings_);
  if (options.smooth) clearances_ = motion::scene_clearances(world.robot, world.scene, kSmoothingReach);
  leave_out_goals();
  if (keeps_clearance()) return;
  for (const auto& pair : exact_.colliding_pairs(query_.start)) {
    start_depths_[pair] = motion::pair_depth(world_.robot, world_.scene, query_.start, pair);
  }
}

/// What may touch on the closing segment: the links of the grasp's own contacts with the object, and nothing else.
motion::World Planning::closing_of(const Grasp& grasp) const {
  return motion::closing_world(closing_free_, closing_, world_.robot, grasp.contacts, densest(options_),
                               {.depth = &depth_, .clearance = clearance_.get()});
}

/// A goal is of use only when the hand can close from it. The grasps were asked at a spacing of their own, so this is
/// asked again at the chosen one, before the planner may choose such a goal and lose the others with it. Goals that are
/// no place to be at all are left to the planner, which says why it does not use them.
void Planning::leave_out_goals() {
  Query kept{query_.start, std::move(query_.synergies), std::move(query_.grasps), {}, {}, {}};
  for (std::size_t i = 0; i < query_.goals.size(); ++i) {
    const std::size_t grasp = query_.grasp_of_goal[i];
    const auto segment = motion::closing_segment(query_.goals[i].q, query_.q_grasp[i], world_.robot.hand(),
                                                 closing_of(kept.grasps[grasp].value));
    const Eigen::VectorXd& q = query_.goals[i].q;
    if (segment.invalid && world_.robot.within_limits(q) && free_.free(q)) {
      ++goals_left_out_;
      continue;
    }
    kept.goals.push_back({query_.goals[i].q, query_.goals[i].box, static_cast<int>(kept.goals.size())});
    kept.grasp_of_goal.push_back(grasp);
    kept.q_grasp.push_back(query_.q_grasp[i]);
  }
  query_ = std::move(kept);
}

Run Planning::run(std::uint64_t seed) const {
  Run result;
  result.seed = seed;
  const double begin = thread_cpu_seconds();
  const auto& robot = world_.robot;
  result.planned = motion::plan(query_.start, query_.synergies.pre_grasp.box, query_.goals, robot.joint_names(),
                                robot.hand(), robot.lower(), robot.upper(), robot.weights(), space_, settings_, seed);
  result.cpu_seconds = thread_cpu_seconds() - begin;
  if (result.planned.status == PlanStatus::solved) finish(result);
  if (query_.goals.empty() && result.planned.status == PlanStatus::no_goals) {
    result.planned.detail =
        "of " + std::to_string(goals_left_out_) + " goals none has a valid closing segment at this resolution";
  }
  return result;
}

double Planning::start_depth(const robot::BodyPair& pair) const {
  const auto found = start_depths_.find(pair);
  return found == start_depths_.end() ? 0.0 : found->second;
}

/// The boxes that the planned path followed; nullopt for the baseline, which follows none.
std::optional<motion::FollowedBoxes> Planning::followed(const PlanResult& planned) const {
  if (settings_.variant != motion::Variant::synergy) return std::nullopt;
  const auto& hand = world_.robot.hand();
  const auto& goal = query_.goals[static_cast<std::size_t>(planned.goal)];
  return motion::followed_boxes(planned.path.waypoints, planned.bridge_row,
                                motion::box_distance(query_.synergies.pre_grasp.box, hand),
                                motion::box_distance(goal.box, hand));
}

/// Shortened within the boxes it followed, corners rounded, the closing segment appended, timed. At rest at the start,
/// the pre-grasp and the grasp, and at the closing segment's corner.
void Planning::finish(Run& run) const {
  const auto& robot = world_.robot;
  const auto boxes = followed(run.planned);
  auto shorter =
      boxes ? motion::shortcut_in_boxes(run.planned.path, robot.weights(), space_, *boxes, robot.arm(), run.seed)
            : motion::shortcut(run.planned.path, robot.weights(), space_, {}, run.seed);
  if (clearances_) {
    shorter.path = motion::smooth(shorter.path, robot.weights(), robot.lower(), robot.upper(), space_,
                                  boxes ? &*boxes : nullptr, clearances_, {})
                       .path;
    shorter.length = motion::path_length(robot.weights(), shorter.path.waypoints);
  }
  run.length = shorter.length;
  const auto goal = static_cast<std::size_t>(run.planned.goal);
  const Grasp& grasp = query_.grasps[query_.grasp_of_goal[goal]].value;
  const motion::ClosingSegment closing =
      motion::closing_segment(query_.goals[goal].q, query_.q_grasp[goal], robot.hand(), closing_of(grasp));
  require(!closing.invalid, "plan: a goal without a valid closing segment was reached");
  const motion::BlendSettings blends;
  const motion::RateLimits limits{options_.speed * robot.velocity(), options_.speed * robot.acceleration()};
  run.trajectory = motion::time_optimal(motion::stop_at_corners(closing.waypoints), limits, blends);
  run.pregrasp_row = 0;
  const Eigen::MatrixXd waypoints = motion::distinct(shorter.path.waypoints);
  if (waypoints.rows() > 1) {  // else the start is the pre-grasp
    const auto blended = motion::blend_corners(waypoints, space_, blends, boxes ? &*boxes : nullptr);
    const auto transit = motion::time_optimal(blended, limits, blends);
    run.stops = blended.stops;
    run.pregrasp_row = static_cast<int>(transit.times.size()) - 1;
    run.trajectory = motion::joined(transit, run.trajectory);
  }
  run.motion = {run.planned.path.joint_names, run.trajectory.positions};
  if (boxes) run.box_distance = distances(*boxes, run);
  add_human_likeness(run, group_named(query_.synergies, grasp.group));
}

void Planning::add_human_likeness(Run& run, const SynergyGroup& group) const {
  const auto hand = [&](const Eigen::MatrixXd& q) {
    return Eigen::MatrixXd(q.middleCols(world_.robot.hand().first, world_.robot.hand().count));
  };
  const auto add = [&](const char* of, const Eigen::MatrixXd& waypoints, const LikenessReference& reference) {
    run.human_likeness.push_back({{"of", of},
                                  {"value", number(analysis::human_likeness(hand(waypoints), reference))},
                                  {"reference", reference.name}});
  };
  const Eigen::MatrixXd final = run.motion.waypoints.topRows(run.pregrasp_row + 1);
  if (free_motion_) {
    add("planned", run.planned.path.waypoints, *free_motion_);
    add("final", final, *free_motion_);
  } else {
    run.human_likeness.push_back({{"of", "planned"}, {"value", nullptr}, {"reference", "none in the store"}});
  }
  add("planned", run.planned.path.waypoints, grasp_phase_reference(group));
  add("final", final, grasp_phase_reference(group));
}

}  // namespace opponens::cli
