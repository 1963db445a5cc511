// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/import_grasps.hpp"

#include <algorithm>
#include <fstream>
#include <map>

#include "cli/records.hpp"
#include "cli/stored.hpp"
#include "core/require.hpp"

namespace opponens::cli {
namespace {

constexpr double kRigidTolerance = 1e-4;  // of a rotation's columns: files hold eight digits, some fewer

using Numbers = std::map<std::string, double>;

/// One grasp of a file: says where it is when it complains.
class Entry {
 public:
  Entry(std::string file, std::string name, const Json& json)
      : where_(std::move(file) + ": " + name + ": "), name_(std::move(name)), json_(json) {
    if (!json.is_object()) fail("expected an object");
  }

  const std::string& name() const { return name_; }
  [[noreturn]] void fail(const std::string& text) const { throw InputError(where_ + text); }

  const Json& field(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) fail(std::string("field '") + key + "' is missing");
    return *found;
  }

  std::vector<double> numbers(const Json& list, const char* key) const {
    std::vector<double> values;
    const bool good =
        list.is_array() && std::all_of(list.begin(), list.end(), [](const Json& v) {
          return v.is_number() ||
                 (v.is_array() && std::all_of(v.begin(), v.end(), [](const Json& w) { return w.is_number(); }));
        });
    if (!good) fail(std::string("field '") + key + "': expected numbers");
    for (const Json& value : list) {
      if (value.is_number()) values.push_back(value.get<double>());
      if (value.is_array()) {
        for (const Json& inner : value) values.push_back(inner.get<double>());
      }
    }
    return values;
  }
  std::vector<double> numbers(const char* key) const { return numbers(field(key), key); }

  /// 16 numbers row by row, or four rows of four.
  Eigen::Isometry3d pose(const Json& list, const char* key) const {
    const std::vector<double> values = numbers(list, key);
    if (values.size() != 16) fail(std::string("field '") + key + "': expected 16 numbers or 4 x 4");
    Eigen::Isometry3d X;
    for (int i = 0; i < 16; ++i) X.matrix()(i / 4, i % 4) = values[static_cast<std::size_t>(i)];
    const Eigen::Matrix3d R = X.linear();
    const bool rigid = X.matrix().allFinite() &&
                       (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= kRigidTolerance &&
                       R.determinant() > 0.0 &&
                       (X.matrix().row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() <= kRigidTolerance;
    if (!rigid) fail(std::string("field '") + key + "' is no rigid pose (rotation, translation, 0 0 0 1)");
    // What this program wrote comes back bit for bit.
    if (!(R.transpose() * R).isIdentity(1e-12)) X.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
    X.matrix().row(3) << 0, 0, 0, 1;
    return X;
  }

  /// Every joint of the hand, and no other, by name.
  Eigen::VectorXd joints(const Numbers& values, const robot::RobotModel& hand) const {
    for (const auto& [name, value] : values) {
      const auto& known = hand.joint_names();
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      fail("joint " + name + " is not the hand's, whose joints are " + joined(known));
    }
    Eigen::VectorXd q(hand.dof());
    for (int j = 0; j < hand.dof(); ++j) {
      const auto found = values.find(hand.joint_names()[static_cast<std::size_t>(j)]);
      if (found == values.end()) fail("joint " + hand.joint_names()[static_cast<std::size_t>(j)] + " is missing");
      q[j] = found->second;
    }
    return q;
  }

  Numbers named(const std::vector<std::string>& names, const std::vector<double>& values, const char* key) const {
    if (names.size() != values.size()) {
      fail(std::string("field '") + key + "': " + std::to_string(values.size()) + " numbers for " +
           std::to_string(names.size()) + " joints");
    }
    Numbers result;
    for (std::size_t i = 0; i < names.size(); ++i) result[names[i]] = values[i];
    return result;
  }

 private:
  std::string where_;
  std::string name_;
  const Json& json_;
};

Json parse(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw InputError(file.string() + ": cannot be read");
  try {
    return Json::parse(in);
  } catch (const Json::exception& error) {
    throw InputError(file.string() + ": is not JSON (" + error.what() + ")");
  }
}

std::vector<std::string> names_at(const Json& json, const char* key, const std::string& file) {
  const auto found = json.find(key);
  const bool good = found != json.end() && found->is_array() &&
                    std::all_of(found->begin(), found->end(), [](const Json& v) { return v.is_string(); });
  if (!good) throw InputError(file + ": field '" + key + "': expected a list of joint names");
  return found->get<std::vector<std::string>>();
}

/// For each link whether no joint moves it against the palm.
std::vector<bool> fixed_to_palm(const robot::RobotModel& robot) {
  const robot::RobotDescription& d = robot.description();
  const auto joint_of = [&d](std::size_t link) {
    const int joint = d.links[link].joint;
    return joint < 0 ? nullptr : &d.joints[static_cast<std::size_t>(joint)];
  };
  const auto is_fixed = [&](std::size_t link) {
    const robot::Joint* const joint = joint_of(link);
    return joint != nullptr && joint->type == robot::JointType::fixed;
  };
  auto root = static_cast<std::size_t>(robot.palm());
  while (is_fixed(root)) root = static_cast<std::size_t>(joint_of(root)->parent);
  std::vector<bool> fixed(d.links.size(), false);
  fixed[root] = true;
  for (std::size_t link = root + 1; link < d.links.size(); ++link) {  // parents come first
    fixed[link] = is_fixed(link) && fixed[static_cast<std::size_t>(joint_of(link)->parent)];
  }
  return fixed;
}

/// X_BH: the palm H in the frame of the link that a file calls the hand's base. It has to be fixed to the palm.
Eigen::Isometry3d palm_in_base(const std::string& base, const std::string& file, const NamedWorld& world) {
  const robot::RobotModel& robot = world.robot;
  const auto& links = robot.links();
  const std::vector<bool> fixed = fixed_to_palm(robot);
  bool known = false;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].name != base && !links[i].name.ends_with("/" + base)) continue;
    known = true;
    if (!fixed[i]) continue;
    const auto X_RL = robot.link_poses(robot.rest());
    return X_RL[i].inverse() * X_RL[static_cast<std::size_t>(robot.palm())];
  }
  if (!known) throw InputError(file + ": the hand's base is '" + base + "', and the robot has no link of that name");
  throw InputError(file + ": the hand's base '" + base + "' moves against the palm " +
                   links[static_cast<std::size_t>(robot.palm())].name + ", so it does not tell where the hand is");
}

/// "palm_link of allegro_right_hand.urdf".
std::string base_link(const Json& json, const std::string& file) {
  const auto found = json.find("handbase_frame");
  if (found == json.end() || !found->is_string() || found->get<std::string>().empty()) {
    throw InputError(file + ": field 'handbase_frame': expected the name of the hand's base link");
  }
  const std::string text = *found;
  return text.substr(0, text.find(' '));
}

std::string numbered(std::size_t index) { return std::string("grasp ").append(std::to_string(index)); }

/// The object that a grasp, or else its file, names.
std::optional<std::string> object_of(const Json& one, const Json& file) {
  for (const Json* const json : {&one, &file}) {
    const auto found = json->find("object");
    if (found != json->end() && found->is_string() && !found->get<std::string>().empty()) return *found;
  }
  return std::nullopt;
}

ImportedPostures from_frogger(const Json& json, const std::string& file, const NamedWorld& world) {
  ImportedPostures result{"frogger", {}};
  const std::vector<std::string> names = names_at(json, "hand_joint_order", file);
  const Eigen::Isometry3d X_BH = palm_in_base(base_link(json, file), file, world);
  for (const Json& one : json.at("grasps")) {
    const Entry entry(file, numbered(result.postures.size()), one);
    const Eigen::Isometry3d X_OB = entry.pose(entry.field("X_object_handbase"), "X_object_handbase");
    const Eigen::VectorXd q = entry.joints(entry.named(names, entry.numbers("hand_q"), "hand_q"), world.hand());
    result.postures.push_back({entry.name(), {X_OB * X_BH, q}, object_of(one, json)});
  }
  return result;
}

ImportedPostures from_document(const Json& json, const std::string& file, const NamedWorld& world) {
  ImportedPostures result{"grasp", {}};
  for (const Json& one : json.at("grasps")) {
    const Entry entry(file, numbered(result.postures.size()), one);
    const Json& joints = entry.field("joints");
    const bool good = joints.is_object() &&
                      std::all_of(joints.begin(), joints.end(), [](const Json& value) { return value.is_number(); });
    if (!good) entry.fail("field 'joints': expected {name: rad}");
    result.postures.push_back(
        {entry.name(),
         {entry.pose(entry.field("X_OH"), "X_OH"), entry.joints(joints.get<Numbers>(), world.hand())},
         object_of(one, json)});
  }
  return result;
}

/// Joint names of the synergy sets in an export, by id.
std::map<std::string, std::vector<std::string>> exported_joints(const Json& objects) {
  std::map<std::string, std::vector<std::string>> names;
  for (const Json& one : objects) {
    if (one.value("kind", "") != kSynergySet) continue;
    names[one.at("id")] = one.at("fields").at("joint_names").get<std::vector<std::string>>();
  }
  return names;
}

ImportedPostures from_export(const Json& json, const std::string& file, const NamedWorld& world) {
  ImportedPostures result{"export", {}};
  const auto known = exported_joints(json.at("objects"));
  for (const Json& one : json.at("objects")) {
    if (one.value("kind", "") != kGrasp) continue;
    const Entry entry(file, std::string("grasp ").append(short_id(one.at("id"))), one);
    const Json& fields = entry.field("fields");
    const Json& origin = entry.field("provenance");
    const Json& made_for = origin.at("parameters").at("world");
    const auto set = known.find(origin.at("inputs").at(0).get<std::string>());
    std::vector<std::string> names = world.hand().joint_names();
    if (set != known.end()) {
      names = set->second;
    } else if (made_for.at("robot") != world.parameters.at("robot")) {
      entry.fail("nothing names its joints, and it was made for another robot (" +
                 made_for.at("robot").get<std::string>() + "); export it together with its synergy_set");
    }
    const std::vector<double> q = entry.numbers(fields.at("q_grasp"), "q_grasp");
    result.postures.push_back(
        {entry.name(),
         {entry.pose(fields.at("X_OH"), "X_OH"), entry.joints(entry.named(names, q, "q_grasp"), world.hand())},
         object_of(made_for, json)});
  }
  return result;
}

}  // namespace

ImportedPostures import_grasps(const std::filesystem::path& file, const NamedWorld& world) {
  const Json json = parse(file);
  const auto has_list = [&](const char* key) {
    return json.is_object() && json.contains(key) && json.at(key).is_array();
  };
  ImportedPostures result;
  try {
    if (has_list("grasps") && json.contains("hand_joint_order")) {
      result = from_frogger(json, file.string(), world);
    } else if (has_list("grasps")) {
      result = from_document(json, file.string(), world);
    } else if (has_list("objects")) {
      result = from_export(json, file.string(), world);
    } else {
      throw InputError(file.string() +
                       ": holds no list 'grasps' (FRoGGeR's form, or opponens grasp --json) and no list 'objects' "
                       "(opponens export --format json)");
    }
  } catch (const Json::exception& error) {
    throw InputError(file.string() + ": has not the form it seems to have (" + error.what() + ")");
  }
  if (result.postures.empty()) throw InputError(file.string() + ": holds no grasps");
  return result;
}

}  // namespace opponens::cli
