// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/grasp_card.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "core/require.hpp"
#include "report/contact_marks.hpp"

namespace opponens::report {
namespace {

constexpr int kViews = 3;
constexpr double kPictureWidth = 336.0;  // px
constexpr double kPictureHeight = 300.0;

using Facts = std::vector<std::pair<std::string, Markup>>;

std::string vector_words(const Eigen::Vector3d& v, double unit, int decimals) {
  return concat(
      {fixed(unit * v.x(), decimals), ", ", fixed(unit * v.y(), decimals), ", ", fixed(unit * v.z(), decimals)});
}

Markup colored_dot(int finger) {
  return {concat({"<span class=\"dot\" style=\"background:", css(contact_paint(finger)), "\"></span>"})};
}

/// The finger that a contact belongs to; empty without a hand's model.
std::string finger_of(const GraspStage* stage, const std::vector<int>& fingers, std::size_t contact) {
  if (stage == nullptr) return "";
  const int finger = fingers[contact];
  return finger < 0 ? std::string("palm") : finger_names(stage->hand)[static_cast<std::size_t>(finger)];
}

Markup pictures(const GraspStage& stage, const GraspItem& item, const std::string& name) {
  require(item.grasp.q_grasp.size() == stage.hand.dof(), [&] {
    return concat({"grasp ", item.id, ": q_grasp has another number of joints than the hand"});
  });
  const GraspBodies bodies = grasp_bodies(stage, item.grasp);
  std::vector<Markup> row;
  for (const auto& view : grasp_views(bodies, item.grasp.contacts, kViews)) {
    const auto seen = std::count_if(view.sights.begin(), view.sights.end(),
                                    [](Sight sight) { return sight != Sight::behind_others; });
    const std::string caption = concat(
        {view.words, ": ", std::to_string(seen), " of ", std::to_string(view.sights.size()), " contacts in sight"});
    row.push_back(figure(
        draw_grasp(stage, bodies, item.grasp, view, concat({name, ", ", view.words}), kPictureWidth, kPictureHeight),
        caption));
  }
  return row_of(row, "views");
}

std::string robust_words(const RobustQuality& robust) {
  return concat({"force closure in ", percent(robust.force_closure), " of ", std::to_string(robust.noise.samples),
                 " disturbed grasps [", percent(robust.force_closure_low), ", ", percent(robust.force_closure_high),
                 "], \u03B5 ", significant(robust.epsilon_mean), " on average, ", significant(robust.epsilon_low),
                 " at the 5 % quantile (object moved by ", compact(1e3 * robust.noise.position, 1), " mm and ",
                 compact(robust.noise.angle, 4), " rad, \u03BC by ", compact(robust.noise.friction, 4),
                 ", standard deviations)"});
}

Markup certificate_words(const std::optional<Certificate>& certificate) {
  if (!certificate) return text("no");
  Markup out = badge(true, "yes");
  out += text(concat({", by ", std::to_string(certificate->edges.size()), " edge forces in exact balance"}));
  if (certificate->epsilon_bound) {
    out += text(concat({"; \u03B5 is at most ", significant(*certificate->epsilon_bound), " for certain"}));
  }
  return out;
}

Facts facts_of(const GraspItem& item) {
  const auto& grasp = item.grasp;
  const auto& quality = grasp.quality;
  Facts facts{{"state", badge(quality.force_closure(), words(quality.state))},
              {"\u03B5", text(optional_number(quality.epsilon))},
              {"l*", text(optional_number(quality.min_weight))}};
  facts.emplace_back("certified", certificate_words(grasp.certificate));
  if (quality.volume) facts.emplace_back("volume", text(significant(*quality.volume)));
  if (grasp.robust) facts.emplace_back("under errors", text(robust_words(*grasp.robust)));
  facts.emplace_back("posture",
                     text(concat({posture_words(grasp), ", slack ", significant(grasp.slack.norm()), " rad"})));
  facts.emplace_back("arm", text(concat({std::to_string(grasp.arm_solutions.size()), " solutions for both poses"})));
  if (grasp.origin == GraspOrigin::imported) facts.emplace_back("origin", text("imported"));
  facts.emplace_back(
      "verified", item.verified ? badge(*item.verified, *item.verified ? "yes" : "failed") : text("not checked yet"));
  return facts;
}

Markup list_of(const Facts& facts) {
  Markup list{"<dl class=\"facts\">\n"};
  for (const auto& [name, value] : facts) {
    list.html += concat({"<dt>", escape(name), "</dt><dd>", value.html, "</dd>\n"});
  }
  list.html += "</dl>\n";
  return list;
}

/// "link_3.0_tip: 1, 4; link_2.0: 2" per finger.
Markup contacts_by_finger(const GraspStage* stage, const Grasp& grasp, const std::vector<int>& fingers) {
  constexpr int kLast = 1000;                                 // the palm stands after the fingers
  std::map<int, std::map<std::string, std::string>> numbers;  // finger -> link -> numbers
  for (std::size_t i = 0; i < grasp.contacts.size(); ++i) {
    const int finger = stage == nullptr || fingers[i] < 0 ? kLast : fingers[i];
    auto& list = numbers[finger][grasp.contacts[i].link];
    list += concat({list.empty() ? "" : ", ", std::to_string(i + 1)});
  }
  Markup out{concat(
      {"<p class=\"touching\">", std::to_string(grasp.contacts.size()), " contacts:</p>\n<ul class=\"touching\">\n"})};
  for (const auto& [finger, links] : numbers) {
    out.html += "<li>";
    if (stage != nullptr) {
      const bool palm = finger == kLast;
      const std::string name = palm ? "palm" : finger_names(stage->hand)[static_cast<std::size_t>(finger)];
      out.html += concat({colored_dot(palm ? -1 : finger).html, "<b>", escape(name), "</b> "});
    }
    std::string words;
    for (const auto& [link, list] : links) words += concat({words.empty() ? "" : "; ", link, ": ", list});
    out.html += concat({escape(words), "</li>\n"});
  }
  out.html += "</ul>\n";
  return out;
}

Markup contact_table(const GraspStage* stage, const Grasp& grasp, const std::vector<int>& fingers) {
  Table table("Contacts in the object's frame", {"contact", "link", "finger", "position (mm)", "normal", "\u03BC"});
  for (std::size_t i = 0; i < grasp.contacts.size(); ++i) {
    const auto& contact = grasp.contacts[i];
    table.row({text(std::to_string(i + 1)), text(contact.link), text(finger_of(stage, fingers, i)),
               text(vector_words(contact.p_OC, 1e3, 1)), text(vector_words(contact.n_O, 1.0, 3)),
               text(significant(contact.mu))});
  }
  return table.str();
}

/// Tenths of a millimetre: a centre of mass that rounding left 1e-19 m off an axis is on it.
std::string position_words(const Eigen::Vector3d& p) {
  if (p.isZero(0.0)) return "the object's origin";
  return concat({"(", compact(p.x(), 4), ", ", compact(p.y(), 4), ", ", compact(p.z(), 4), ") m in the object"});
}

}  // namespace

std::string words(ContactModel model) {
  switch (model) {
    case ContactModel::frictionless:
      return "frictionless point contacts";
    case ContactModel::point_with_friction:
      return "point contacts with friction";
    case ContactModel::soft_finger:
      return "soft fingers";
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
  const bool round = convention.cone == FrictionCone::quadratic;
  const std::string edges = concat({"cones of ", std::to_string(convention.edges), " edges"});
  if (convention.model == ContactModel::point_with_friction) {
    out += concat({", friction coefficient \u03BC = ", compact(convention.mu, 3), ", ",
                   round ? concat({"round cones (l*: ", edges, ")"}) : edges});
  }
  if (convention.model == ContactModel::soft_finger) {
    out += concat({", friction coefficient \u03BC = ", compact(convention.mu, 3), ", torsion radius ",
                   significant(convention.torsion_radius), " m", round ? ", whole ellipsoids" : ""});
  }
  out +=
      convention.unit == ForceUnit::normal ? "; edge forces with a normal component of 1" : "; edge forces of length 1";
  out += convention.norm == WrenchNorm::l1
             ? "; L1: the fingers share a total force of 1 (the hull of all edge wrenches)"
             : "; L\u221E: each contact has a force of 1 of its own (the sum of the contacts' hulls)";
  return out + concat({"; torques about ", position_words(convention.origin),
                       ", divided by \u03C1 = ", significant(convention.rho), " m"});
}

std::string optional_number(const std::optional<double>& value) {
  return value ? significant(*value) : std::string("none");
}

std::string posture_words(const Grasp& grasp) { return grasp.synergy_grasp ? "along the synergies" : "free"; }

Markup finger_legend(const robot::RobotModel& hand) {
  const auto names = finger_names(hand);
  Markup out{"<p class=\"legend\">"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    out.html += concat({"<span>", colored_dot(static_cast<int>(i)).html, escape(names[i]), "</span> "});
  }
  out.html += concat({"<span>", colored_dot(-1).html, "palm</span></p>\n"});
  return out;
}

Markup grasp_card(const GraspStage* stage, const GraspItem& item, const std::string& name) {
  const std::vector<int> fingers = stage == nullptr ? std::vector<int>{} : contact_fingers(*stage, item.grasp);
  Markup card{concat({"<div class=\"card\"><h4>", escape(name), " <code title=\"", escape(item.id), "\">",
                      escape(shortened(item.id)), "</code></h4>\n"})};
  if (stage != nullptr) card += pictures(*stage, item, name);
  card.html += "<div class=\"about\">\n";
  card += list_of(facts_of(item));
  card.html += "<div>\n";
  card += contacts_by_finger(stage, item.grasp, fingers);
  card.html += "</div>\n</div>\n";
  if (!item.grasp.contacts.empty()) card += details("contacts in numbers", contact_table(stage, item.grasp, fingers));
  card.html += "</div>\n";
  return card;
}

}  // namespace opponens::report
