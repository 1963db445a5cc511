// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/object_choice.hpp"

#include <algorithm>
#include <map>

#include "core/require.hpp"

namespace opponens::cli {
namespace {

std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

/// By arm; "" is for the arms that are not named.
using Choice = std::map<std::string, std::string>;

void choose(Choice& choice, const std::string& arm, const std::string& object, const std::string& argument) {
  if (choice.emplace(arm, object).second) return;
  const std::string of_arm = arm.empty() ? "" : " for arm " + arm;
  throw InputError("--object " + argument + ": a second object" + of_arm + ", after " + choice.at(arm));
}

void require_arm(const std::string& arm, const std::vector<std::string>& arms, const std::string& argument) {
  if (std::find(arms.begin(), arms.end(), arm) != arms.end()) return;
  throw InputError("--object " + argument + ": no driven arm '" + arm + "', expected one of " + list_of(arms));
}

Choice read_arguments(const std::vector<std::string>& arguments, const std::vector<std::string>& arms) {
  Choice choice;
  for (const std::string& argument : arguments) {
    // With one arm the whole of it is the name, whatever letters that has.
    const std::size_t equals = arms.size() > 1 ? argument.find('=') : std::string::npos;
    const std::string arm = equals == std::string::npos ? "" : argument.substr(0, equals);
    if (equals != std::string::npos) require_arm(arm, arms, argument);
    choose(choice, arm, equals == std::string::npos ? argument : argument.substr(equals + 1), argument);
  }
  return choice;
}

void require_body(const std::string& name, const robot::Scene& scene, const std::string& scene_file) {
  std::vector<std::string> bodies;
  for (const auto& body : scene.bodies) bodies.push_back(body.name);
  if (std::find(bodies.begin(), bodies.end(), name) != bodies.end()) return;
  throw InputError("--object " + name + ": no such body in " + scene_file + ", which has " + list_of(bodies));
}

}  // namespace

std::vector<std::string> objects_of_arms(const std::vector<std::string>& arguments,
                                         const std::vector<std::string>& arms, const robot::Scene& scene,
                                         const std::string& scene_file) {
  const Choice choice = read_arguments(arguments, arms);
  const auto for_all = choice.find("");
  std::vector<std::string> objects;
  for (const std::string& arm : arms.empty() ? std::vector<std::string>{""} : arms) {
    const auto own = choice.find(arm);
    objects.push_back(own != choice.end() ? own->second : for_all != choice.end() ? for_all->second : scene.object);
    if (objects.back().empty()) throw InputError(scene_file + ": names no object to grasp; use --object");
    require_body(objects.back(), scene, scene_file);
  }
  return objects;
}

std::vector<std::string> object_arguments(const Json& world) {
  if (!world.contains("objects")) return {world.at("object").get<std::string>()};
  std::vector<std::string> arguments;
  for (const auto& [arm, object] : world.at("objects").items()) {
    arguments.push_back(arm + "=" + object.get<std::string>());
  }
  return arguments;
}

}  // namespace opponens::cli
