// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/frogger_grasps/search.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <map>
#include <ostream>

#include "core/require.hpp"

namespace opponens {
namespace {

constexpr double kContactBound = 0.0005;  // m, of a valid grasp's tips

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// What a valid grasp is held to, beside force closure and touching tips.
struct Bounds {
  double depth;         ///< m
  double joint_beyond;  ///< rad
};

/// The grasps of one side on one object.
struct Side {
  std::vector<double> min_weight, epsilon, face_min_weight, face_epsilon, seconds;
  int valid = 0;
  double deepest = 1.0;  ///< m, least clearance
};

void add(const FroggerObject& object, const robot::RobotModel& hand, grasp::TipModel model, const Posture& posture,
         const Bounds& bounds, double seconds, Side& side, std::ostream& csv) {
  const double mu = object.reference.mu;
  const Score by_distance =
      score(object, tip_contacts(hand, object.surface, object.target, model, posture, NormalRule::distance, mu));
  const Score by_face =
      score(object, tip_contacts(hand, object.surface, object.target, model, posture, NormalRule::face, mu));
  const double gap = largest_gap(hand, object.surface, object.target, model, posture);
  const double clearance = least_clearance(hand, object, posture);
  const bool valid = by_distance.force_closure && gap <= kContactBound && clearance >= -bounds.depth &&
                     hand.within_limits(posture.q, bounds.joint_beyond);
  side.min_weight.push_back(by_distance.min_weight);
  side.epsilon.push_back(by_distance.epsilon);
  side.face_min_weight.push_back(by_face.min_weight);
  side.face_epsilon.push_back(by_face.epsilon);
  side.seconds.push_back(seconds);
  side.valid += valid ? 1 : 0;
  side.deepest = std::min(side.deepest, clearance);
  csv << by_distance.min_weight << ',' << by_distance.epsilon << ',' << by_face.min_weight << ',' << by_face.epsilon
      << ',' << 1e3 * gap << ',' << 1e3 * clearance << ',' << valid << ',' << seconds << '\n';
}

Side theirs(const FroggerObject& object, const robot::RobotModel& hand, std::ostream& csv) {
  Side side;
  const ReferenceFile& file = object.reference;
  const Bounds bounds{file.depth + file.collision_tolerance, file.joint_tolerance};
  for (const ReferenceGrasp& grasp : file.valid) {
    csv << object.reference.object << ",frogger,," << grasp.index << ",,";
    add(object, hand, grasp::TipModel::fixed_point, posture_of(grasp), bounds, grasp.seconds, side, csv);
  }
  return side;
}

Side ours(const FroggerObject& object, const robot::RobotModel& hand, const Comparison& comparison, std::ostream& csv,
          std::map<std::string, std::int64_t>& rejected) {
  Side side;
  const grasp::PrecisionSettings& settings = comparison.settings;
  const grasp::HandCheckers checkers = grasp::hand_checkers(hand, object.scene, "object");
  const QualityConvention convention = frogger_convention(object.reference.mu, object.reference.edges);
  std::vector<grasp::PrecisionSpace> spaces;
  for (const SynergyGroup& group : comparison.groups) {
    spaces.push_back(grasp::make_precision_space(hand, object.surface, object.target, group.box, settings.tips,
                                                 convention, settings.goal, settings.max_penetration));
  }
  for (int seed = 1; seed <= comparison.seeds; ++seed) {
    const std::size_t turn = static_cast<std::size_t>(seed - 1) % spaces.size();
    const std::string& name = comparison.groups[turn].name;
    const double start = cpu_seconds();
    const grasp::SearchResult found = grasp::search_precision_grasps({spaces[turn], settings, checkers, name, nullptr},
                                                                     static_cast<std::uint64_t>(seed));
    const double seconds = cpu_seconds() - start;
    for (const auto& [reason, count] : found.rejected) rejected[reason] += count;
    csv << object.reference.object << ",opponens," << name << ',' << seed << ',' << found.trials << ',';
    if (found.grasps.empty()) {
      for (std::vector<double>* values : {&side.min_weight, &side.epsilon, &side.face_min_weight, &side.face_epsilon})
        values->push_back(0.0);
      side.seconds.push_back(seconds);
      csv << "0,0,0,0,,,0," << seconds << '\n';
      continue;
    }
    const Grasp& grasp = found.grasps.front();
    add(object, hand, settings.tips, {grasp.X_OH, grasp.q_grasp}, {settings.max_penetration, 1e-9}, seconds, side, csv);
  }
  return side;
}

void print(const char* who, const Side& side) {
  std::printf("  %-9s l* %.4f epsilon %.5f (face normals %.4f %.5f), valid %d of %zu, deepest %.2f mm, median %.3f s\n",
              who, median(side.min_weight), median(side.epsilon), median(side.face_min_weight),
              median(side.face_epsilon), side.valid, side.seconds.size(), -1e3 * side.deepest, median(side.seconds));
}

}  // namespace

int compare(const Folders& folders, const robot::RobotModel& hand, const Comparison& comparison, std::ostream& csv) {
  require(!comparison.groups.empty(), "compare: no synergy group");
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folders.reference)) {
    const std::string file = entry.path().filename().string();
    if (file.ends_with(".frogger.json")) files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  csv << "object,set,group,seed,trials,min_weight,epsilon,face_min_weight,face_epsilon,gap_mm,clearance_mm,valid,"
         "seconds\n";
  int better = 0;
  for (const std::string& file : files) {
    const FroggerObject object = load_object(folders, file, hand, comparison.table);
    std::map<std::string, std::int64_t> rejected;
    const Side left = theirs(object, hand, csv);
    const Side right = ours(object, hand, comparison, csv, rejected);
    const bool wins =
        median(right.min_weight) >= median(left.min_weight) && median(right.epsilon) >= median(left.epsilon);
    better += wins ? 1 : 0;
    std::printf("%s%s\n", object.reference.object.c_str(), wins ? "" : "  (not better in both)");
    print("frogger", left);
    print("opponens", right);
    std::printf("  rejected:");
    for (const auto& [reason, count] : rejected)
      std::printf(" %s %lld;", reason.c_str(), static_cast<long long>(count));
    std::printf("\n");
    std::fflush(stdout);
  }
  std::printf("both medians at least theirs on %d of %zu objects\n", better, files.size());
  return better;
}

}  // namespace opponens
