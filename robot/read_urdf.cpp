// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/read_urdf.hpp"

#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>

#include <console_bridge/console.h>
#include <tinyxml.h>
#include <urdf_parser/urdf_parser.h>

#include "core/require.hpp"
#include "robot/text_file.hpp"
#include "robot/urdf_check.hpp"
#include "robot/urdf_geometry.hpp"

namespace opponens::robot {

namespace {

/// Keeps what urdfdom would print: its first complaint is the reason that the caller is told.
class CapturedLog : public console_bridge::OutputHandler {
 public:
  CapturedLog() { console_bridge::useOutputHandler(this); }
  ~CapturedLog() override { console_bridge::restorePreviousOutputHandler(); }
  CapturedLog(const CapturedLog&) = delete;
  CapturedLog& operator=(const CapturedLog&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_error_.empty()) first_error_ = text;
  }
  const std::string& first_error() const { return first_error_; }

 private:
  std::string first_error_;
};

urdf::ModelInterfaceSharedPtr parse(const std::filesystem::path& file, const std::string& text) {
  static std::mutex mutex;  // console_bridge's handler is one per process
  const std::lock_guard lock(mutex);
  const CapturedLog log;
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(text);
  } catch (const std::exception& error) {  // urdfdom lets some number conversions escape
    fail_urdf(file, std::string("not a valid URDF: ") + error.what());
  }
  if (!model)
    fail_urdf(file, "not a valid URDF: " + (log.first_error().empty() ? "no reason given" : log.first_error()));
  return model;
}

/// What only the text shows: the order of the joints, links that two joints claim, and tags nobody reads.
struct Outline {
  std::vector<std::string> joints;     ///< in the file's order
  std::map<std::string, int> ignored;  ///< tag -> how often
  std::vector<std::string> notes;      ///< shapes left out
  std::string text;                    ///< the file without them
};

void count_ignored(const TiXmlElement& element, Outline& outline) {
  static const std::map<std::string, std::set<std::string>> kRead = {
      {"robot", {"link", "joint"}},
      {"link", {"visual", "collision"}},
      {"joint", {"parent", "child", "origin", "axis", "limit", "mimic"}}};
  const std::set<std::string>& read = kRead.at(element.ValueStr());
  for (const TiXmlElement* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
    const std::string& tag = child->ValueStr();
    if (!read.contains(tag)) {
      ++outline.ignored[tag];
    } else if (tag == "link" || tag == "joint") {
      count_ignored(*child, outline);
    }
  }
}

std::string link_of(const TiXmlElement& joint, const char* side) {
  const TiXmlElement* element = joint.FirstChildElement(side);
  const char* link = element ? element->Attribute("link") : nullptr;
  return link ? link : "";
}

/// Loops are found here: urdfdom would tie its shared pointers into them and never free them.
void check_loops(const std::map<std::string, std::string>& parent_of, const std::filesystem::path& file) {
  for (const auto& [start, parent] : parent_of) {
    auto link = parent_of.find(start);
    for (std::size_t steps = 0; link != parent_of.end(); ++steps) {
      if (steps > parent_of.size()) fail_urdf(file, "link '" + start + "' hangs on a loop: a tree is needed");
      link = parent_of.find(link->second);
    }
  }
}

/// No robot has as many links: the walks over the tree here and in urdfdom cost their square, or recurse.
void check_size(const TiXmlElement& robot, const std::filesystem::path& file) {
  constexpr int kMaxJoints = 2000;
  int joints = 0;
  for (const TiXmlElement* joint = robot.FirstChildElement("joint"); joint;
       joint = joint->NextSiblingElement("joint")) {
    if (++joints <= kMaxJoints) continue;
    fail_urdf(file, "line " + std::to_string(joint->Row()) + ": more than " + std::to_string(kMaxJoints) + " joints");
  }
}

std::string printed(const TiXmlDocument& document) {
  TiXmlPrinter printer;
  document.Accept(&printer);
  return printer.Str();
}

Outline outline_of(const std::filesystem::path& file, const std::string& text) {
  TiXmlDocument document;
  parse_xml(file, text, document);
  TiXmlElement* const robot = document.FirstChildElement("robot");
  if (!robot) fail_urdf(file, "has no <robot> element");
  check_size(*robot, file);
  check_urdf_numbers(file, *robot);
  Outline outline;
  outline.notes = drop_unknown_shapes(file, *robot);
  outline.text = outline.notes.empty() ? text : printed(document);
  std::map<std::string, std::string> joint_of_child;
  std::map<std::string, std::string> parent_of;
  for (const TiXmlElement* joint = robot->FirstChildElement("joint"); joint;
       joint = joint->NextSiblingElement("joint")) {
    const char* name = joint->Attribute("name");
    const std::string parent = link_of(*joint, "parent");
    const std::string child = link_of(*joint, "child");
    if (!name || parent.empty() || child.empty()) {
      fail_urdf(file, "line " + std::to_string(joint->Row()) + ": joint '" + (name ? name : "") +
                          "' needs a name, a parent link and a child link");
    }
    const auto [other, is_new] = joint_of_child.emplace(child, name);
    if (!is_new) {
      fail_urdf(file, "line " + std::to_string(joint->Row()) + ": link '" + child + "' is the child of two joints, '" +
                          other->second + "' and '" + name + "': a tree is needed");
    }
    parent_of[child] = parent;
    outline.joints.emplace_back(name);
  }
  check_loops(parent_of, file);
  count_ignored(*robot, outline);
  return outline;
}

Joint joint_of(const urdf::Joint& source, const std::filesystem::path& file, std::vector<std::string>& notes) {
  const std::string element = "joint '" + source.name + "'";
  Joint joint;
  joint.name = source.name;
  joint.X_PJ = urdf_pose(source.parent_to_joint_origin_transform, file, element);
  if (source.type == urdf::Joint::FIXED) return joint;
  const bool continuous = source.type == urdf::Joint::CONTINUOUS;
  if (source.type != urdf::Joint::REVOLUTE && source.type != urdf::Joint::PRISMATIC && !continuous) {
    fail_urdf(file,
              element + ": type planar or floating is not supported (fixed, revolute, continuous, prismatic are)");
  }
  joint.type = source.type == urdf::Joint::PRISMATIC ? JointType::prismatic : JointType::revolute;
  const double length = vector_of(source.axis).norm();
  if (!(std::isfinite(length) && length > 0.0))
    fail_urdf(file, element + ": axis must be a finite vector that is not zero");
  joint.axis = vector_of(source.axis) / length;
  if (source.limits) {
    joint.velocity = source.limits->velocity;
    joint.lower = source.limits->lower;
    joint.upper = source.limits->upper;
  }
  if (continuous) {
    joint.lower = -2.0 * std::numbers::pi;
    joint.upper = 2.0 * std::numbers::pi;
    notes.push_back(element + " is continuous: its position is limited to two turns, -2 pi to 2 pi");
  } else if (!source.limits) {
    fail_urdf(file, element + ": has no <limit>");
  }
  if (!std::isfinite(joint.lower) || !std::isfinite(joint.upper) || !std::isfinite(joint.velocity)) {
    fail_urdf(file, element + ": limit is not finite");
  }
  if (continuous && !source.limits) {
    joint.velocity = std::numbers::pi;
    notes.push_back(element + " is continuous and has no <limit>: its velocity is taken to be at most pi rad/s");
  }
  if (!(joint.velocity > 0.0)) {
    fail_urdf(file, element + ": velocity limit " + std::to_string(joint.velocity) + " must be positive");
  }
  if (joint.lower > joint.upper) fail_urdf(file, element + ": lower limit is above the upper limit");
  if (source.mimic) {
    joint.mimic = Mimic{source.mimic->joint_name, source.mimic->multiplier, source.mimic->offset};
    if (!std::isfinite(joint.mimic->multiplier) || !std::isfinite(joint.mimic->offset)) {
      fail_urdf(file, element + ": mimic is not finite");
    }
    if (continuous) joint.lower = joint.upper = 0.0;  // none that could restrict the driver
  }
  return joint;
}

/// Depth-first from the root, siblings in the file's order.
void append_tree(const urdf::ModelInterface& model, const std::map<std::string, std::vector<std::string>>& children,
                 const std::filesystem::path& file, RobotDescription& description, const std::string& root) {
  std::vector<std::pair<std::string, int>> open = {{root, -1}};  // joint name (or root link), parent link
  while (!open.empty()) {
    const auto [name, parent] = open.back();
    open.pop_back();
    Link link;
    if (parent < 0) {
      link.name = name;
    } else {
      Joint joint = joint_of(*model.joints_.at(name), file, description.notes);
      link.name = model.joints_.at(name)->child_link_name;
      link.joint = static_cast<int>(description.joints.size());
      joint.parent = parent;
      joint.child = static_cast<int>(description.links.size());
      description.joints.push_back(std::move(joint));
    }
    const int index = static_cast<int>(description.links.size());
    if (const auto found = children.find(link.name); found != children.end()) {
      for (auto joint = found->second.rbegin(); joint != found->second.rend(); ++joint)
        open.emplace_back(*joint, index);
    }
    description.links.push_back(std::move(link));
  }
}

void check_mimics(const RobotDescription& description, const std::filesystem::path& file) {
  std::map<std::string, const Joint*> by_name;
  for (const Joint& joint : description.joints) by_name[joint.name] = &joint;
  for (const Joint& joint : description.joints) {
    const Joint* driver = &joint;
    for (std::size_t steps = 0; driver->mimic; ++steps) {
      const auto found = by_name.find(driver->mimic->joint);
      if (found == by_name.end() || found->second->type == JointType::fixed) {
        fail_urdf(file,
                  "joint '" + driver->name + "': mimics '" + driver->mimic->joint + "', which is not a moving joint");
      }
      if (steps > description.joints.size()) fail_urdf(file, "joint '" + joint.name + "': mimics itself");
      driver = found->second;
    }
  }
}

}  // namespace

RobotDescription read_urdf(const std::filesystem::path& file, const UrdfSettings& settings) {
  const std::string text = read_text_file(file, "a URDF file");
  const Outline outline = outline_of(file, text);
  const urdf::ModelInterfaceSharedPtr model = parse(file, outline.text);

  RobotDescription description;
  description.name = model->getName();
  std::map<std::string, std::vector<std::string>> children;
  for (const std::string& joint : outline.joints) children[model->joints_.at(joint)->parent_link_name].push_back(joint);
  append_tree(*model, children, file, description, model->getRoot()->name);
  check_mimics(description, file);

  ShapeReader shapes(file, settings);
  for (Link& link : description.links) {
    if (settings.without_geometry.contains(link.name)) continue;
    link.collision = shapes.shapes_of(*model->links_.at(link.name));
  }
  description.missing_meshes = shapes.missing();
  description.notes.insert(description.notes.end(), outline.notes.begin(), outline.notes.end());
  for (const auto& [tag, count] : outline.ignored) {
    description.notes.push_back(file.filename().string() + ": <" + tag + "> ignored (" + std::to_string(count) + ")");
  }
  return description;
}

}  // namespace opponens::robot
