// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/grasp_causes.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

namespace opponens::cli {
namespace {

struct Meaning {
  std::string_view prefix;  ///< of a reason
  std::string_view cause;
  std::string_view advice;
};

constexpr std::string_view kReach = "out of the arm's reach";
constexpr std::string_view kReachAdvice = "move the object or the robot's base";
constexpr std::string_view kGrip = "the hand does not close around the object";
constexpr std::string_view kGripAdvice = "try other groups, --free-joints or more trials";
constexpr std::string_view kObstacle = "collision with the surroundings";
constexpr std::string_view kRoomAdvice = "make room around the object";

/// Reasons without a named pair of bodies; the first prefix that fits.
constexpr std::array<Meaning, 20> kMeanings{{
    {"no inverse kinematics", kReach, kReachAdvice},
    {"outside the joint limits: ", "a hand joint beyond its limit", "check the file's joint names and units"},
    {"outside the joint limits", kReach, kReachAdvice},
    {"joint beyond its limit", kGrip, kGripAdvice},
    {"the tips do not reach the surface", kGrip, kGripAdvice},
    {"no chord through the object", kGrip, kGripAdvice},
    {"the optimiser met no finite point", kGrip, kGripAdvice},
    {"closure cannot be certified", "not force closure", ""},
    {"too near to an obstacle", kObstacle, kRoomAdvice},
    {"no seed pose with a clear palm", "no room for the palm", kRoomAdvice},
    {"no clear pre-grasp", "no way to draw the open hand back",
     "make room around the object, or a smaller --clearance"},
    {"hand in collision", kObstacle, kRoomAdvice},
    {"fingers touch each other", "the robot meets itself", ""},
    {"cannot be freed from the object", kGrip, kGripAdvice},
    {"fewer than three contacts", kGrip, kGripAdvice},
    {"penetrates the object", kGrip, kGripAdvice},
    {"not force closure", "not force closure",
     "try more trials, --free-joints, or a larger --mu if the surfaces allow it"},
    {"epsilon did not converge", "not force closure", ""},
    {"closing segment too deep in the object", kGrip, kGripAdvice},
    {"closing segment nearer to something than the clearance", kObstacle, kRoomAdvice},
}};

/// Whether the pair "a-b" names this body; names may have dashes of their own.
bool names(const std::string& pair, const std::string& body) {
  const std::string before = body + "-";
  const std::string after = "-" + body;
  return pair.rfind(before, 0) == 0 ||
         (pair.size() >= after.size() && pair.compare(pair.size() - after.size(), after.size(), after) == 0);
}

/// The scene body of a pair that is no contact: the longest name that fits; empty: two links of the robot.
std::string body_of(const std::string& pair, const robot::Scene& scene) {
  std::string longest;
  for (const auto& body : scene.bodies) {
    if (names(pair, body.name) && body.name.size() > longest.size()) longest = body.name;
  }
  return longest;
}

Meaning meaning_of(const std::string& reason) {
  const auto found = std::find_if(kMeanings.begin(), kMeanings.end(),
                                  [&](const Meaning& one) { return reason.rfind(one.prefix, 0) == 0; });
  return found == kMeanings.end() ? Meaning{"", reason, ""} : *found;
}

Cause cause_of(const std::string& reason, const robot::Scene& scene, const std::string& object) {
  const std::size_t colon = reason.find(": ");
  const bool named = colon != std::string::npos;
  const bool near = named && reason.rfind("too near to an obstacle", 0) == 0;
  const bool collision = named && reason.find("collision") < colon;
  if (!collision && !near) {
    const Meaning meaning = meaning_of(reason);
    return {std::string(meaning.cause), std::string(meaning.advice), 0, {}};
  }
  const std::string what = reason.substr(colon + 2);
  const std::string body = near ? what : body_of(what, scene);
  if (body.empty()) return {"the robot meets itself", "", 0, {}};
  if (body == object) return {"arm or hand runs into the object", "try more trials or a larger --clearance", 0, {}};
  return {"collision with " + body, "move " + body + " away from " + object, 0, {}};
}

double percent(std::int64_t count, std::int64_t trials) {
  return 100.0 * static_cast<double>(count) / static_cast<double>(std::max<std::int64_t>(trials, 1));
}

}  // namespace

std::vector<Cause> causes_of(const std::map<std::string, std::int64_t>& rejected, const robot::Scene& scene,
                             const std::string& object) {
  std::map<std::string, Cause> by_name;
  for (const auto& [reason, count] : rejected) {
    Cause cause = cause_of(reason, scene, object);
    Cause& kept = by_name.try_emplace(cause.name, cause).first->second;
    if (kept.advice.empty()) kept.advice = cause.advice;
    kept.trials += count;
    kept.reasons[reason] += count;
  }
  std::vector<Cause> causes;
  for (auto& [name, cause] : by_name) causes.push_back(std::move(cause));
  std::stable_sort(causes.begin(), causes.end(), [](const Cause& a, const Cause& b) { return a.trials > b.trials; });
  return causes;
}

std::string shares(const std::vector<Cause>& causes, std::int64_t trials) {
  constexpr std::size_t kShown = 5;
  std::string text;
  const auto add = [&](std::int64_t count, const std::string& name) {
    char part[32];
    std::snprintf(part, sizeof part, "%.0f %% ", percent(count, trials));
    text += (text.empty() ? "" : ", ") + (part + name);
  };
  std::int64_t others = 0;
  for (std::size_t i = 0; i < causes.size(); ++i) {
    if (i < kShown) add(causes[i].trials, causes[i].name);
    if (i >= kShown) others += causes[i].trials;
  }
  if (others > 0) add(others, "other");
  return text;
}

Json causes_json(const std::vector<Cause>& causes, std::int64_t trials) {
  Json result = Json::array();
  for (const Cause& cause : causes) {
    result.push_back({{"cause", cause.name},
                      {"trials", cause.trials},
                      {"percent", percent(cause.trials, trials)},
                      {"advice", cause.advice},
                      {"reasons", cause.reasons}});
  }
  return result;
}

}  // namespace opponens::cli
