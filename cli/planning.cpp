// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/planning.hpp"

#include <algorithm>
#include <ctime>
#include <utility>

#include "cli/path_likeness.hpp"
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

/// m: nothing further away is asked about when a path is smoothed.
constexpr double kSmoothingReach = 0.011;

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

/// These bodies and what is grasped.
std::set<std::string> with_objects(std::set<std::string> names, const NamedWorld& world) {
  for (const GraspingArm& arm : world.arms) names.insert(arm.object);
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

std::vector<Contact> contacts_of(const Query& query, const std::vector<std::size_t>& grasps) {
  std::vector<Contact> contacts;
  for (const std::size_t i : grasps) {
    const std::vector<Contact>& own = query.grasps[i].value.contacts;
    contacts.insert(contacts.end(), own.begin(), own.end());
  }
  return contacts;
}

double thread_cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

Planning::Planning(const PlanOptions& options, const NamedWorld& world, Query query,
                   std::optional<analysis::LikenessReference> free_motion)
    : options_(options),
      world_(world),
      query_(std::move(query)),
      free_motion_(std::move(free_motion)),
      near_start_(near_start(query_.start, world)),
      exact_(world.robot, world.scene),
      clearance_(std::make_shared<const motion::ContinuousCheck>(
          motion::ContinuousCheck(exact_, world.robot).starting_at(query_.start))),
      free_(world.robot, motion::grown_scene(world.scene, kGrowth, near_start_)),
      closing_free_(world.robot, motion::grown_scene(world.scene, kGrowth, with_objects(near_start_, world))),
      closing_(world.robot, motion::grown_scene(world.scene, kGrowth, with_objects(near_start_, world)),
               world.hand_object_pairs()),
      depth_(world.robot, world.scene, world.touching()),
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
  add_goals();
  if (keeps_clearance()) return;
  for (const auto& pair : exact_.colliding_pairs(query_.start)) {
    start_depths_[pair] = motion::pair_depth(world_.robot, world_.scene, query_.start, pair);
  }
}

/// What may touch on the closing segment: the links of each grasp's own contacts with its object, and nothing else.
motion::World Planning::closing_of(const std::vector<std::size_t>& grasps) const {
  return motion::closing_world(closing_free_, closing_, world_.robot, contacts_of(query_, grasps), densest(options_),
                               {.depth = &depth_, .clearance = clearance_.get()});
}

/// A goal is of use only when the hands can close from it. The grasps were asked at a spacing of their own, and each
/// arm's with the other one at rest, so this is asked again, before the planner may choose such a goal and lose the
/// others with it. One arm's goals that are no place to be at all are left to the planner, which says why it does not
/// use them.
void Planning::add_goals() {
  const auto fault = [this](const Goal& goal) { return fault_of(goal); };
  if (world_.arms.size() > 1) {
    pairs_ = add_pairs(query_, world_.robot, static_cast<std::size_t>(options_.pairs), fault);
    return;
  }
  for (const ArmGoal& part : query_.arm_goals[0]) {
    Goal goal = goal_of(query_, world_.robot, {part});
    const auto why = fault_of(goal);
    if (why && why->closing) {
      ++goals_left_out_;
    } else {
      query_.add(std::move(goal));
    }
  }
}

std::optional<GoalFault> Planning::fault_of(const Goal& goal) const {
  const Eigen::VectorXd& q = goal.root.q;
  if (!world_.robot.within_limits(q)) return GoalFault{"outside the joint limits", {}, false};
  if (!free_.free(q)) return GoalFault{"in collision at the pre-grasp", free_.colliding_pairs(q), false};
  const auto segment = motion::closing_segment(q, goal.q_grasp, world_.robot.hand(), closing_of(goal.grasps));
  if (!segment.invalid) return std::nullopt;
  std::vector<robot::BodyPair> bodies = closing_.colliding_pairs(*segment.invalid);
  if (bodies.empty()) return GoalFault{"too near to something, or too deep in an object, while closing", {}, true};
  return GoalFault{"in collision while closing", std::move(bodies), true};
}

/// Why there is no goal to search for.
std::string Planning::no_goals() const {
  if (!pairs_) {
    return "of " + std::to_string(goals_left_out_) + " goals none has a valid closing segment at this resolution";
  }
  if (pairs_->possible == 0) return "the grasps of one arm have no arm solution";
  return "no pair of grasps fits together: " + left_out_words(*pairs_) +
         "; more grasps of each arm (opponens grasp --count), or objects that stand further apart, may help";
}

Run Planning::run(std::uint64_t seed) const {
  Run result;
  result.seed = seed;
  const double begin = thread_cpu_seconds();
  const auto& robot = world_.robot;
  result.planned = motion::plan(query_.start, query_.start_box(), query_.goals, robot.joint_names(), robot.hand(),
                                robot.lower(), robot.upper(), robot.weights(), space_, settings_, seed);
  result.cpu_seconds = thread_cpu_seconds() - begin;
  if (result.planned.status == PlanStatus::solved) finish(result);
  if (query_.goals.empty() && result.planned.status == PlanStatus::no_goals) {
    result.planned.detail = no_goals();
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
                                motion::box_distance(query_.start_box(), hand), motion::box_distance(goal.box, hand));
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
  const std::vector<std::size_t>& grasps = query_.grasps_of_goal[goal];
  const motion::ClosingSegment closing =
      motion::closing_segment(query_.goals[goal].q, query_.q_grasp[goal], robot.hand(), closing_of(grasps));
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
  run.human_likeness = likeness_of_path(run.planned.path.waypoints, run.motion.waypoints.topRows(run.pregrasp_row + 1),
                                        robot.arms(), groups_of(grasps), free_motion_);
}

std::vector<const SynergyGroup*> Planning::groups_of(const std::vector<std::size_t>& grasps) const {
  std::vector<const SynergyGroup*> groups;
  groups.reserve(grasps.size());
  for (const std::size_t i : grasps) groups.push_back(&group_named(query_.synergies, query_.grasps[i].value.group));
  return groups;
}

}  // namespace opponens::cli
