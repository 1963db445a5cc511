// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <optional>

#include "report/grasp_card.hpp"
#include "report/grasp_drawing.hpp"
#include "report/grasp_rejections.hpp"
#include "report/sections.hpp"

namespace opponens::report {
namespace {

/// The hand and the object's body, when the input has what a picture needs.
std::optional<GraspStage> stage_of(const robot::RobotModel& hand, const robot::Scene& scene,
                                   const std::string& object) {
  for (const auto& body : scene.bodies) {
    if (body.name == object && !body.geometry.empty()) return grasp_stage(hand, body);
  }
  return std::nullopt;
}

/// Names of the groups: those searched, in their order, then others that have grasps.
std::vector<std::string> group_names(const GraspPart& part) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const auto& search : part.searches) add(search.group);
  for (const auto& item : part.items) add(item.grasp.group);
  return names;
}

std::vector<const GraspItem*> items_of(const GraspPart& part, const std::string& group) {
  std::vector<const GraspItem*> items;
  for (const auto& item : part.items) {
    if (item.grasp.group == group) items.push_back(&item);
  }
  return items;
}

const GraspSearch* search_of(const GraspPart& part, const std::string& group) {
  const auto found = std::find_if(part.searches.begin(), part.searches.end(),
                                  [&](const GraspSearch& search) { return search.group == group; });
  return found == part.searches.end() ? nullptr : &*found;
}

std::string titled(const GraspPart& part, const std::string& group) {
  const GraspSearch* search = search_of(part, group);
  const std::string of_arm = part.arm.empty() ? "" : concat({"arm ", part.arm, ", "});
  if (search != nullptr && !search->of_group) return concat({of_arm, group});
  return concat({of_arm, part.grouped_by.empty() ? "group" : part.grouped_by, " ", group});
}

std::string grasps_of_object(const GraspPart& part, std::int64_t count) {
  if (count == 0) return concat({"No grasp of ", part.object});
  return concat({count == 1 ? std::string("One grasp of ") : concat({grouped(count), " grasps of "}), part.object});
}

/// Why a search found nothing, with what to try first.
std::string reasons_of(const GraspSearch& search) {
  const std::string why = rejection_words(search, 5);
  const std::string advice = search.causes.empty() ? "" : search.causes.front().advice;
  return concat({why.empty() ? "no reason is stored" : why, advice.empty() ? "." : ". To try first: ", advice,
                 advice.empty() ? "" : "."});
}

/// What the search of a group came to, in a sentence: a group without a grasp says why.
std::string outcome(const GraspPart& part, const std::string& group, std::size_t grasps) {
  const auto count = static_cast<std::int64_t>(grasps);
  const GraspSearch* search = search_of(part, group);
  if (search == nullptr) return concat({grasps_of_object(part, count), "; no search of this group is stored."});
  if (search->trials == 0) return concat({grasps_of_object(part, count), ": the search made no trial."});
  const std::string trials = concat({" in ", grouped(search->trials), search->trials == 1 ? " trial" : " trials"});
  if (!search->of_group && search->found > 0) {
    return concat({grasps_of_object(part, search->found), trials, ", shown with the groups that they are nearest to."});
  }
  if (count == 0 || !search->of_group) {
    return concat({grasps_of_object(part, 0), trials, ": ", reasons_of(*search)});
  }
  if (count == search->found) return concat({grasps_of_object(part, count), trials, "."});
  return concat(
      {grasps_of_object(part, count), "; the search of this group found ", grouped(search->found), trials, "."});
}

Markup group_section(const GraspPart& part, const GraspStage* stage, const std::string& group) {
  const auto items = items_of(part, group);
  const std::string title = titled(part, group);
  Markup out = subheading(concat({"Grasps: ", title}));
  out += paragraph(outcome(part, group, items.size()));
  if (const GraspSearch* search = search_of(part, group)) {
    out += rejection_chart(*search);
    if (!search->rejected.empty()) out += details("all reasons, and what was in the way", rejection_table(*search));
  }
  const std::size_t shown = std::min(static_cast<std::size_t>(std::max(0, part.max_pictures)), items.size());
  for (std::size_t i = 0; i < shown; ++i) {
    out += grasp_card(stage, *items[i], concat({"Grasp ", std::to_string(i + 1), " of ", title}));
  }
  if (shown < items.size()) {
    out += note(concat({"The best ", std::to_string(shown), " are shown; the others stand in the table below."}));
  }
  return out;
}

Markup certified_words(const Grasp& grasp) { return grasp.certificate ? badge(true, "yes") : text("no"); }

Markup grasp_table(const GraspPart& part) {
  Table table(
      part.arm.empty() ? "All grasps, the best first" : concat({"All grasps of arm ", part.arm, ", the best first"}),
      {"grasp", "group", "state", "\u03B5", "l*", "slack (rad)", "posture", "contacts", "touching links",
       "arm solutions", "certified", "verified"});
  for (const auto& item : part.items) {
    const auto& grasp = item.grasp;
    std::vector<std::string> links;
    for (const auto& contact : grasp.contacts) links.push_back(contact.link);
    std::sort(links.begin(), links.end());
    links.erase(std::unique(links.begin(), links.end()), links.end());
    table.row({identifier(item.id), text(grasp.group), text(words(grasp.quality.state)),
               text(optional_number(grasp.quality.epsilon)), text(optional_number(grasp.quality.min_weight)),
               text(significant(grasp.slack.norm())), text(posture_words(grasp)),
               text(std::to_string(grasp.contacts.size())), text(std::to_string(links.size())),
               text(std::to_string(grasp.arm_solutions.size())), certified_words(grasp),
               item.verified ? badge(*item.verified, *item.verified ? "yes" : "no") : text("not checked")});
  }
  return table.str();
}

/// How the pictures are read.
Markup picture_key(const GraspStage& stage) {
  Markup out = paragraph(
      "Each grasp is drawn from the three sides that show most of its contacts. A dot is a contact point in the colour "
      "of its finger, a ring one that the object or another link hides from this side; the arrow is the normal, into "
      "the object, and the cone around it holds the forces that friction allows (half angle: the arc tangent of "
      "\u03BC; "
      "its length means nothing). Parts of the hand behind the object show through. Numbers are those of the lists.");
  out += finger_legend(stage.hand);
  return out;
}

/// One note per convention that occurs: a value is meaningless without it.
Markup conventions(const GraspPart& part) {
  std::vector<std::string> seen;
  for (const auto& item : part.items) {
    const std::string convention = convention_words(item.grasp.quality.convention);
    if (std::find(seen.begin(), seen.end(), convention) == seen.end()) seen.push_back(convention);
  }
  Markup out;
  for (const auto& convention : seen) out += note(concat({"Convention of \u03B5 and l*: ", convention, "."}));
  if (seen.empty()) return out;
  out += note(
      "\u03B5 is the radius of the largest ball around the origin inside the wrench hull; l* is the largest weight "
      "that "
      "every edge wrench can keep while all balance each other (at most 1 / their number). Both are positive for force "
      "closure. Slack: how far fitting the fingers to the object took the posture away from the synergies; up to the "
      "search's bound the grasp counts as one along the synergies, beyond it as free. Certified: exact arithmetic "
      "proves "
      "force closure of the stored contacts, which says nothing of how well they describe the world.");
  return out;
}

bool is_empty(const GraspPart& part) { return part.items.empty() && part.searches.empty(); }

Markup grasps_of_hand(const GraspPart& part, const std::optional<GraspStage>& stage) {
  Markup out;
  if (!part.arm.empty()) out += subheading(concat({"Arm ", part.arm}));
  out += paragraph(concat({grasps_of_object(part, static_cast<std::int64_t>(part.items.size())), "."}));
  if (!part.items.empty()) {
    out += stage ? picture_key(*stage) : note("The hand's model or the object's shape was not given: no pictures.");
  }
  out += conventions(part);
  for (const auto& group : group_names(part)) out += group_section(part, stage ? &*stage : nullptr, group);
  if (!part.items.empty())
    out += subheading(concat({"All grasps", part.arm.empty() ? "" : concat({" of arm ", part.arm})}));
  if (!part.items.empty()) out += grasp_table(part);
  return out;
}

}  // namespace

Markup grasp_section(const ReportInput& input) {
  const bool nothing = std::all_of(input.further_hands.begin(), input.further_hands.end(),
                                   [](const FurtherHand& further) { return is_empty(further.grasps); });
  if (!input.grasps || (is_empty(*input.grasps) && nothing)) {
    return note("No grasp has been found or searched yet.");
  }
  const auto stage = [&](const robot::RobotModel& hand, const GraspPart& part) {
    return input.scene ? stage_of(hand, *input.scene, part.object) : std::nullopt;
  };
  Markup out = grasps_of_hand(*input.grasps, input.hand ? stage(*input.hand, *input.grasps) : std::nullopt);
  for (const auto& further : input.further_hands) {
    out += grasps_of_hand(further.grasps, stage(further.hand, further.grasps));
  }
  return out;
}

}  // namespace opponens::report
