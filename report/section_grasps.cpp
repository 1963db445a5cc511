// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include "core/require.hpp"
#include "report/hand_drawing.hpp"
#include "report/sections.hpp"

namespace opponens::report {
namespace {

std::string words(ContactModel model) {
  switch (model) {
    case ContactModel::frictionless:
      return "frictionless";
    case ContactModel::point_with_friction:
      return "point with friction";
    case ContactModel::soft_finger:
      return "soft finger";
  }
  return "";
}

std::string words(ClosureState state) {
  switch (state) {
    case ClosureState::force_closure:
      return "force closure";
    case ClosureState::not_force_closure:
      return "not force closure";
    case ClosureState::rank_deficient:
      return "rank deficient";
    case ClosureState::below_incumbent:
      return "given up";
  }
  return "";
}

std::string convention_words(const QualityConvention& convention) {
  std::string out = words(convention.model);
  if (convention.model != ContactModel::frictionless) {
    out += concat({", mu ", compact(convention.mu, 3), ", ", std::to_string(convention.edges), " edges"});
  }
  out +=
      concat({", unit ", convention.unit == ForceUnit::normal ? "normal force" : "force", ", ",
              convention.norm == WrenchNorm::l1 ? "L1" : "L\u221E", ", torque / ", significant(convention.rho), " m"});
  if (convention.model == ContactModel::soft_finger) {
    out += concat({", torsion radius ", significant(convention.torsion_radius), " m"});
  }
  return out;
}

std::string optional_number(const std::optional<double>& value) {
  return value ? significant(*value) : std::string("none");
}

std::string posture_words(const Grasp& grasp) { return grasp.synergy_grasp ? "along the synergies" : "free"; }

/// The hand's configuration and the object's body, when the input has what a picture needs.
const robot::SceneBody* drawable_object(const ReportInput& input) {
  if (!input.hand || !input.scene) return nullptr;
  for (const auto& body : input.scene->bodies) {
    if (body.name == input.grasps->object && !body.geometry.empty()) return &body;
  }
  return nullptr;
}

Markup pictures(const ReportInput& input, const RobotFacets& facets, const robot::SceneBody& object,
                const GraspItem& item, int number) {
  const auto& hand = *input.hand;
  require(item.grasp.q_grasp.size() == hand.dof(), [&] {
    return concat({"grasp ", item.id, ": q_grasp has another number of joints than the hand"});
  });
  std::vector<Markup> pair;
  for (const auto& [side, name] : {std::pair{GraspSide::left, "left"}, {GraspSide::right, "right"}}) {
    const std::string title =
        concat({"Grasp ", std::to_string(number), " of ", input.grasps->object, " from the ", name});
    pair.push_back(figure(draw_grasp(hand, facets, object, item.grasp, side, title, 250.0, 240.0), ""));
  }
  return row_of(pair, "pair");
}

Markup numbers(const GraspItem& item) {
  const auto& grasp = item.grasp;
  const auto& quality = grasp.quality;
  const std::string id_title = escape(item.id);
  std::string html =
      concat({"<p><code title=\"", id_title, "\">", escape(shortened(item.id)), "</code> \u00B7 group ",
              escape(grasp.group), " \u00B7 ", badge(quality.force_closure(), words(quality.state)).html});
  if (item.verified)
    html += concat({" \u00B7 ", badge(*item.verified, *item.verified ? "verified" : "verification failed").html});
  html += concat({"<br>\u03B5 ", optional_number(quality.epsilon), " \u00B7 l* ", optional_number(quality.min_weight),
                  " \u00B7 slack ", significant(grasp.slack.norm()), " rad (", posture_words(grasp), ") \u00B7 ",
                  std::to_string(grasp.contacts.size()), " contacts \u00B7 ",
                  std::to_string(grasp.arm_solutions.size()), " arm solutions</p>\n"});
  return {html};
}

Markup grasp_table(const GraspPart& part) {
  Table table("All grasps", {"grasp", "group", "state", "\u03B5", "l*", "slack (rad)", "posture", "contacts",
                             "touching links", "arm solutions", "verified"});
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
               text(std::to_string(grasp.arm_solutions.size())),
               item.verified ? badge(*item.verified, *item.verified ? "yes" : "no") : text("not checked")});
  }
  return table.str();
}

/// Trials rejected for one reason, with the pair of bodies that is named most often behind it.
struct Rejection {
  std::string reason;
  std::int64_t trials = 0;
  std::string pair;
  std::int64_t of_pair = 0;
};

/// "reason: pair" counted by reason, the most frequent first.
std::vector<Rejection> by_reason(const std::map<std::string, std::int64_t>& rejected) {
  std::map<std::string, Rejection> grouped;
  for (const auto& [words, count] : rejected) {
    const std::size_t colon = words.find(": ");
    auto& entry = grouped[words.substr(0, colon)];
    entry.reason = words.substr(0, colon);
    entry.trials += count;
    if (colon == std::string::npos || count <= entry.of_pair) continue;
    entry.pair = words.substr(colon + 2);
    entry.of_pair = count;
  }
  std::vector<Rejection> sorted;
  for (auto& [reason, entry] : grouped) sorted.push_back(std::move(entry));
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Rejection& a, const Rejection& b) { return a.trials > b.trials; });
  return sorted;
}

Markup rejected_table(const GraspPart& part) {
  if (part.rejected.empty()) return {};
  Table table(concat({"Why trials were rejected, of ", grouped(part.trials)}), {"reason", "trials", "most often"});
  for (const auto& one : by_reason(part.rejected)) {
    table.row({text(one.reason), text(grouped(one.trials)),
               text(one.pair.empty() ? "" : concat({one.pair, " (", grouped(one.of_pair), ")"}))});
  }
  return table.str();
}

/// One sentence per convention that occurs: a value is meaningless without it.
Markup conventions(const GraspPart& part) {
  std::vector<std::string> seen;
  for (const auto& item : part.items) {
    const std::string convention = convention_words(item.grasp.quality.convention);
    if (std::find(seen.begin(), seen.end(), convention) == seen.end()) seen.push_back(convention);
  }
  Markup out;
  for (const auto& convention : seen) {
    out += note(concat({"Convention of \u03B5 and l*: ", convention,
                        ". \u03B5 is the radius of the largest ball around the origin inside the wrench hull; l* is "
                        "the largest weight that every wrench can keep while all balance each other (of at most 1 / "
                        "their number). Both are positive for force closure."}));
  }
  out += note(
      "Slack: how far fitting the fingers to the object took the posture away from the synergies. Up to the stated "
      "bound "
      "the grasp counts as one along the synergies, beyond it as free.");
  return out;
}

}  // namespace

Markup grasp_section(const ReportInput& input) {
  if (!input.grasps || input.grasps->items.empty()) return note("No grasp has been found or searched yet.");
  const auto& part = *input.grasps;
  Markup out = paragraph(concat({std::to_string(part.items.size()), " grasps of ", part.object,
                                 ". Magenta: contact points with the normals that point into the object. Parts of the "
                                 "hand behind the object show through."}));
  out += conventions(part);
  const auto* object = drawable_object(input);
  if (object != nullptr) {
    const RobotFacets facets = robot_facets(*input.hand, 2400);
    std::vector<Markup> cards;
    const int shown = std::min(part.max_pictures, static_cast<int>(part.items.size()));
    for (int i = 0; i < shown; ++i) {
      const auto& item = part.items[static_cast<std::size_t>(i)];
      Markup card{concat({"<div class=\"card\"><h3>Grasp ", std::to_string(i + 1), "</h3>\n"})};
      card += pictures(input, facets, *object, item, i + 1);
      card += numbers(item);
      card.html += "</div>\n";
      cards.push_back(std::move(card));
    }
    out += row_of(cards, "cards");
    if (shown < static_cast<int>(part.items.size())) {
      out += note(concat({"Pictures of the first ", std::to_string(shown), " only."}));
    }
  } else {
    out += note("The hand's model or the object's shape was not given: no pictures.");
  }
  out += grasp_table(part);
  out += rejected_table(part);
  return out;
}

}  // namespace opponens::report
