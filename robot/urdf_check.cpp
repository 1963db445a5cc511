// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/urdf_check.hpp"

#include <cmath>
#include <locale>
#include <map>
#include <sstream>
#include <string>

#include <tinyxml.h>

#include "robot/urdf_geometry.hpp"

namespace opponens::robot {

namespace {

/// tag -> attribute -> how many numbers.
using Expected = std::map<std::string, std::map<std::string, int>>;

const Expected& expected_numbers() {
  static const Expected kExpected = {
      {"origin", {{"xyz", 3}, {"rpy", 3}}},
      {"axis", {{"xyz", 3}}},
      {"limit", {{"lower", 1}, {"upper", 1}, {"effort", 1}, {"velocity", 1}}},
      {"mimic", {{"multiplier", 1}, {"offset", 1}}},
      {"mesh", {{"scale", 3}}},
      {"box", {{"size", 3}}},
      {"sphere", {{"radius", 1}}},
      {"cylinder", {{"radius", 1}, {"length", 1}}},
      {"mass", {{"value", 1}}},
      {"inertia", {{"ixx", 1}, {"ixy", 1}, {"ixz", 1}, {"iyy", 1}, {"iyz", 1}, {"izz", 1}}},
  };
  return kExpected;
}

bool holds_numbers(const std::string& text, int count) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  int found = 0;
  for (double value = 0.0; stream >> value;) {
    if (!std::isfinite(value)) return false;
    ++found;
  }
  return stream.eof() && found == count;
}

/// The element and those inside it; owner: "joint 'j'".
void check_element(const std::filesystem::path& file, const TiXmlElement& element, const std::string& owner) {
  if (const auto known = expected_numbers().find(element.ValueStr()); known != expected_numbers().end()) {
    for (const auto& [name, count] : known->second) {
      const char* const value = element.Attribute(name.c_str());
      if (value == nullptr || holds_numbers(value, count)) continue;
      fail_urdf(file, "line " + std::to_string(element.Row()) + ": " + owner + ": <" + known->first + "> " + name +
                          " '" + value + "': expected " + std::to_string(count) + " finite number" +
                          (count == 1 ? "" : "s"));
    }
  }
  for (const TiXmlElement* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
    check_element(file, *child, owner);
  }
}

bool has_known_shape(const TiXmlElement& body) {
  const TiXmlElement* const geometry = body.FirstChildElement("geometry");
  const TiXmlElement* const shape = geometry == nullptr ? nullptr : geometry->FirstChildElement();
  if (shape == nullptr) return false;
  const std::string& tag = shape->ValueStr();
  if (tag != "mesh") return tag == "box" || tag == "sphere" || tag == "cylinder";
  const char* const name = shape->Attribute("filename");
  return name != nullptr && *name != '\0';
}

}  // namespace

std::vector<std::string> drop_unknown_shapes(const std::filesystem::path& file, TiXmlElement& robot) {
  std::vector<std::string> notes;
  for (TiXmlElement* link = robot.FirstChildElement("link"); link; link = link->NextSiblingElement("link")) {
    for (const char* tag : {"visual", "collision"}) {
      for (TiXmlElement* body = link->FirstChildElement(tag); body;) {
        TiXmlElement* const next = body->NextSiblingElement(tag);
        if (!has_known_shape(*body)) {
          const char* const name = link->Attribute("name");
          notes.push_back(file.filename().string() + ": link '" + (name ? name : "") + "': <" + tag + "> in line " +
                          std::to_string(body->Row()) + " has no box, sphere, cylinder or mesh and is left out");
          link->RemoveChild(body);
        }
        body = next;
      }
    }
  }
  return notes;
}

void check_urdf_numbers(const std::filesystem::path& file, const TiXmlElement& robot) {
  for (const char* tag : {"link", "joint"}) {
    for (const TiXmlElement* element = robot.FirstChildElement(tag); element;
         element = element->NextSiblingElement(tag)) {
      const char* const name = element->Attribute("name");
      if (name == nullptr || *name == '\0') {
        fail_urdf(file, "line " + std::to_string(element->Row()) + ": a " + tag + " has no name");
      }
      check_element(file, *element, std::string(tag) + " '" + name + "'");
    }
  }
}

}  // namespace opponens::robot
