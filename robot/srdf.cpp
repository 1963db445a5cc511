// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/srdf.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include <tinyxml.h>

#include "core/require.hpp"
#include "robot/link_pairs.hpp"
#include "robot/robot_model.hpp"
#include "robot/text_file.hpp"

namespace opponens::robot {

namespace {

/// One element of the file, with the file for messages.
class Element {
 public:
  Element(const std::filesystem::path& file, const TiXmlElement& element) : file_(file), element_(element) {}

  const std::string& tag() const { return element_.ValueStr(); }

  std::string attribute(const char* name) const {
    const char* value = element_.Attribute(name);
    if (value == nullptr || *value == '\0') fail(std::string("needs an attribute '") + name + "'");
    return value;
  }
  std::string optional_attribute(const char* name) const {
    const char* value = element_.Attribute(name);
    return value == nullptr ? "" : value;
  }

  std::vector<Element> children() const {
    std::vector<Element> result;
    for (const TiXmlElement* child = element_.FirstChildElement(); child; child = child->NextSiblingElement()) {
      result.emplace_back(file_, *child);
    }
    return result;
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(file_.string() + ": line " + std::to_string(element_.Row()) + ": <" + tag() + "> " + message);
  }

 private:
  const std::filesystem::path& file_;
  const TiXmlElement& element_;
};

SrdfGroup group_of(const Element& element, Srdf& srdf) {
  SrdfGroup group;
  group.name = element.attribute("name");
  for (const Element& child : element.children()) {
    if (child.tag() == "joint") {
      group.joints.push_back(child.attribute("name"));
    } else if (child.tag() == "link") {
      group.links.push_back(child.attribute("name"));
    } else if (child.tag() == "chain") {
      group.chains.emplace_back(child.attribute("base_link"), child.attribute("tip_link"));
    } else if (child.tag() == "group") {
      group.groups.push_back(child.attribute("name"));
    } else {
      ++srdf.ignored[child.tag()];
    }
  }
  return group;
}

SrdfGroupState state_of(const Element& element, Srdf& srdf) {
  SrdfGroupState state{element.attribute("name"), element.attribute("group"), {}};
  for (const Element& child : element.children()) {
    if (child.tag() != "joint") {
      ++srdf.ignored[child.tag()];
      continue;
    }
    std::istringstream text(child.attribute("value"));
    text.imbue(std::locale::classic());
    std::vector<double>& values = state.joints[child.attribute("name")];
    for (double value = 0.0; text >> value;) values.push_back(value);
    const bool finite = std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
    if (!text.eof() || values.empty() || !finite) {
      child.fail("needs finite numbers as its value, found '" + child.attribute("value") + "'");
    }
  }
  return state;
}

void read_element(const Element& element, Srdf& srdf) {
  if (element.tag() == "group") {
    srdf.groups.push_back(group_of(element, srdf));
  } else if (element.tag() == "group_state") {
    srdf.group_states.push_back(state_of(element, srdf));
  } else if (element.tag() == "end_effector") {
    srdf.end_effectors.push_back(
        {element.attribute("name"), element.attribute("parent_link"), element.attribute("group")});
  } else if (element.tag() == "disable_collisions") {
    srdf.disabled.push_back(
        {element.attribute("link1"), element.attribute("link2"), element.optional_attribute("reason")});
  } else {
    ++srdf.ignored[element.tag()];
  }
}

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string listed(const std::set<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

}  // namespace

Srdf read_srdf(const std::filesystem::path& file) {
  TiXmlDocument document;
  parse_xml(file, read_text_file(file, "an SRDF file"), document);
  const TiXmlElement* robot = document.FirstChildElement("robot");
  if (!robot) throw InputError(file.string() + ": has no <robot> element");
  Srdf srdf;
  srdf.file = file;
  for (const Element& element : Element(file, *robot).children()) read_element(element, srdf);
  return srdf;
}

void apply_srdf(const Srdf& srdf, RobotDescription& description) {
  const std::string name = srdf.file.filename().string();
  std::set<std::string> absent;
  int left_out = 0;
  for (const SrdfDisabledPair& pair : srdf.disabled) {
    const std::optional<int> a = find_link(description, pair.link1);
    const std::optional<int> b = find_link(description, pair.link2);
    if (!a) absent.insert(pair.link1);
    if (!b) absent.insert(pair.link2);
    if (!a || !b) {
      ++left_out;
    } else if (*a != *b) {
      description.allowed_collisions.emplace(std::min(*a, *b), std::max(*a, *b));
    }
  }
  if (left_out > 0) {
    description.notes.push_back(name + ": " + counted(static_cast<std::size_t>(left_out), "disabled pair") +
                                " left out, of links that the robot does not have: " + listed(absent));
  }
  if (!srdf.groups.empty() || !srdf.end_effectors.empty() || !srdf.group_states.empty()) {
    description.notes.push_back(name + ": " + counted(srdf.groups.size(), "group") + ", " +
                                counted(srdf.end_effectors.size(), "end effector") + " and " +
                                counted(srdf.group_states.size(), "group state") +
                                " are listed but not used: the YAML files name the planning groups");
  }
  for (const auto& [tag, count] : srdf.ignored) {
    description.notes.push_back(name + ": <" + tag + "> ignored (" + std::to_string(count) + ")");
  }
  description.semantics.push_back(srdf);
}

}  // namespace opponens::robot
