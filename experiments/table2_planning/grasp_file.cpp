// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/table2_planning/grasp_file.hpp"

#include <cstddef>
#include <fstream>
#include <set>

#include <nlohmann/json.hpp>

#include "core/require.hpp"

namespace opponens::table2 {
namespace {

using Json = nlohmann::ordered_json;

Json pose_json(const Eigen::Isometry3d& X) {
  Json result = Json::array();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) result.push_back(X.matrix()(i, j));
  }
  return result;
}

Eigen::Isometry3d pose_of(const Json& json) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) X.matrix()(i, j) = json.at(static_cast<std::size_t>(4 * i + j)).get<double>();
  }
  return X;
}

Json positions_json(const std::vector<std::string>& names, const Eigen::VectorXd& q) {
  Json result = Json::object();
  for (std::size_t j = 0; j < names.size(); ++j) result[names[j]] = q[static_cast<Eigen::Index>(j)];
  return result;
}

Eigen::VectorXd positions_of(const Json& json, const std::vector<std::string>& names) {
  Eigen::VectorXd q(static_cast<Eigen::Index>(names.size()));
  for (std::size_t j = 0; j < names.size(); ++j) q[static_cast<Eigen::Index>(j)] = json.at(names[j]).get<double>();
  return q;
}

Grasp grasp_of(const Json& json, const std::vector<std::string>& names) {
  Grasp grasp;
  grasp.group = json.at("group");
  grasp.quality.epsilon = json.at("epsilon").get<double>();
  grasp.X_OH = pose_of(json.at("X_OH"));
  grasp.X_OH_pregrasp = pose_of(json.at("X_OH_pregrasp"));
  grasp.q_grasp = positions_of(json.at("q_grasp"), names);
  grasp.q_pregrasp = positions_of(json.at("q_pregrasp"), names);
  for (const Json& link : json.at("contact_links")) {
    Contact contact;
    contact.link = link;
    grasp.contacts.push_back(contact);
  }
  return grasp;
}

}  // namespace

PredefinedGrasps load_grasps(const std::filesystem::path& file, const std::vector<std::string>& joint_names) {
  std::ifstream stream(file);
  if (!stream) throw InputError(file.string() + ": cannot read it");
  try {
    const Json document = Json::parse(stream);
    PredefinedGrasps result{document.at("hand"), document.at("object"), {}};
    for (const Json& one : document.at("grasps")) result.grasps.push_back(grasp_of(one, joint_names));
    return result;
  } catch (const Json::exception& error) {
    throw InputError(file.string() + ": " + error.what());
  }
}

void save_grasps(const std::filesystem::path& file, const PredefinedGrasps& grasps,
                 const std::vector<std::string>& joint_names) {
  Json list = Json::array();
  for (const Grasp& grasp : grasps.grasps) {
    std::set<std::string> links;
    for (const Contact& contact : grasp.contacts) links.insert(contact.link);
    list.push_back({{"group", grasp.group},
                    {"epsilon", grasp.quality.epsilon.value_or(0.0)},
                    {"X_OH", pose_json(grasp.X_OH)},
                    {"X_OH_pregrasp", pose_json(grasp.X_OH_pregrasp)},
                    {"q_grasp", positions_json(joint_names, grasp.q_grasp)},
                    {"q_pregrasp", positions_json(joint_names, grasp.q_pregrasp)},
                    {"contact_links", links}});
  }
  std::ofstream stream(file);
  stream << Json({{"hand", grasps.hand}, {"object", grasps.object}, {"grasps", list}}).dump(1) << "\n";
  if (!stream) throw InputError(file.string() + ": cannot write there");
}

}  // namespace opponens::table2
