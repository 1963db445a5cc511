// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/robot_model.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <variant>

#include "core/require.hpp"

namespace opponens::robot {

namespace {

/// Where a joint stands that q does not drive.
double rest_position(const Joint& joint) { return joint.rest.value_or(std::clamp(0.0, joint.lower, joint.upper)); }

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Shape scaled_shape(const Shape& shape, double factor) {
  if (const auto* box = std::get_if<Box>(&shape)) return Box{box->size * factor};
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return Sphere{sphere->radius * factor};
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return Cylinder{cylinder->radius * factor, cylinder->length * factor};
  }
  TriangleMesh mesh = *std::get<std::shared_ptr<const TriangleMesh>>(shape);
  mesh.vertices *= factor;
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

void check_tree(const RobotDescription& description) {
  const int links = static_cast<int>(description.links.size());
  require(links > 0, "robot '" + description.name + "' has no links");
  require(static_cast<int>(description.joints.size()) == links - 1,
          "a tree of " + std::to_string(links) + " links has one joint fewer");
  for (int i = 0; i < links - 1; ++i) {
    const Joint& joint = description.joints[static_cast<std::size_t>(i)];
    require(joint.child == i + 1 && joint.parent >= 0 && joint.parent <= i,
            "joint '" + joint.name + "' is not in topological order");
    require(description.links[static_cast<std::size_t>(i) + 1].joint == i,
            "link '" + description.links[static_cast<std::size_t>(i) + 1].name + "' names another joint");
    require(joint.type == JointType::fixed || std::abs(joint.axis.norm() - 1.0) < 1e-9,
            "joint '" + joint.name + "' has an axis that is not of unit length");
    require(!joint.rest || (*joint.rest >= joint.lower && *joint.rest <= joint.upper),
            "joint '" + joint.name + "' rests outside its limits");
  }
}

}  // namespace

RobotDescription scaled(const RobotDescription& description, double factor) {
  require(std::isfinite(factor) && factor > 0.0, "scale factor must be positive, is " + std::to_string(factor));
  RobotDescription result = description;
  for (Joint& joint : result.joints) {
    joint.X_PJ.translation() *= factor;
    if (joint.type == JointType::prismatic) {
      joint.lower *= factor;
      joint.upper *= factor;
      joint.velocity *= factor;
      if (joint.acceleration) *joint.acceleration *= factor;
      if (joint.mimic) joint.mimic->offset *= factor;
      if (joint.rest) *joint.rest *= factor;
    }
  }
  for (Link& link : result.links) {
    for (Geometry& geometry : link.collision) {
      geometry.shape = scaled_shape(geometry.shape, factor);
      geometry.X_BG.translation() *= factor;
    }
  }
  for (SurfacePoint& point : result.tips) point.p_L *= factor;
  for (SurfacePoint& point : result.contact_points) point.p_L *= factor;
  for (ArmDescription& arm : result.arms) {
    for (SurfacePoint& point : arm.tips) point.p_L *= factor;
    for (SurfacePoint& point : arm.contact_points) point.p_L *= factor;
  }
  return result;
}

RobotModel::RobotModel(RobotDescription description) : description_(std::move(description)) {
  check_tree(description_);
  index_joints();
  resolve_drives();
  for (const Joint& joint : description_.joints) {
    const Eigen::Matrix3d fixed = joint.X_PJ.linear();
    const Eigen::Matrix3d axis = cross_matrix(joint.axis);
    turns_.push_back({fixed, fixed * axis, fixed * axis * axis});
  }
  palm_ = description_.palm_link.empty() ? 0 : link_index(description_.palm_link);
  index_arms();
}

void RobotModel::index_joints() {
  joint_names_ = description_.arm_joints;
  joint_names_.insert(joint_names_.end(), description_.hand_joints.begin(), description_.hand_joints.end());
  arm_ = {"arm", description_.arm_joints, 0, static_cast<int>(description_.arm_joints.size())};
  hand_ = {"hand", description_.hand_joints, arm_.count, static_cast<int>(description_.hand_joints.size())};
  const Eigen::Index d = dof();
  if (description_.weights.size() == 0) description_.weights = Eigen::VectorXd::Ones(d);
  require(description_.weights.size() == d && (description_.weights.array() > 0.0).all(),
          "weights must be one positive number for each of the " + std::to_string(d) + " joints");
  lower_.resize(d);
  upper_.resize(d);
  velocity_.resize(d);
  acceleration_.resize(d);
  rest_.resize(d);
  std::map<std::string, const Joint*> by_name;
  for (const Joint& joint : description_.joints) by_name[joint.name] = &joint;
  for (Eigen::Index i = 0; i < d; ++i) {
    const std::string& name = joint_names_[static_cast<std::size_t>(i)];
    const auto found = by_name.find(name);
    require(found != by_name.end(), "no joint '" + name + "' in robot '" + description_.name + "'");
    const Joint* const joint = found->second;
    require(joint != nullptr, "joint '" + name + "' is actuated twice");
    require(joint->type != JointType::fixed && !joint->mimic, "joint '" + name + "' cannot be actuated");
    lower_[i] = joint->lower;
    upper_[i] = joint->upper;
    velocity_[i] = joint->velocity;
    acceleration_[i] = joint->acceleration.value_or(kAccelerationRate * joint->velocity);
    rest_[i] = rest_position(*joint);
    found->second = nullptr;
  }
}

void RobotModel::index_arms() {
  const std::vector<std::string>& driven = description_.driven_arms;
  if (driven.empty()) arms_.push_back({"", arm_, hand_, palm_});
  int first_arm = 0;
  int first_hand = hand_.first;
  for (const std::string& name : driven) {
    const auto found = std::find_if(description_.arms.begin(), description_.arms.end(),
                                    [&](const ArmDescription& arm) { return arm.name == name; });
    require(found != description_.arms.end(), "no arm '" + name + "' in robot '" + description_.name + "'");
    arms_.push_back({name,
                     {name + "/arm", found->arm_joints, first_arm, static_cast<int>(found->arm_joints.size())},
                     {name + "/hand", found->hand_joints, first_hand, static_cast<int>(found->hand_joints.size())},
                     link_index(found->palm_link)});
    first_arm += arms_.back().arm.count;
    first_hand += arms_.back().hand.count;
  }
  for (const PlanningGroup& group : groups()) {
    require(group.first + group.count <= dof() &&
                std::equal(group.joint_names.begin(), group.joint_names.end(), joint_names_.begin() + group.first),
            "the joints of group '" + group.name + "' are not where q holds them");
  }
}

std::vector<PlanningGroup> RobotModel::groups() const {
  std::vector<PlanningGroup> groups;
  for (const DrivenArm& arm : arms_) groups.push_back(arm.arm);
  for (const DrivenArm& arm : arms_) groups.push_back(arm.hand);
  return groups;
}

/// A driven joint's own limits hold too. Equal ones (in a URDF: left out, both 0) state none.
void RobotModel::restrict_driver(const Joint& joint, const Drive& drive) {
  if (!joint.mimic || drive.index < 0 || drive.multiplier == 0.0 || !(joint.lower < joint.upper)) return;
  const double at_lower = (joint.lower - drive.offset) / drive.multiplier;
  const double at_upper = (joint.upper - drive.offset) / drive.multiplier;
  lower_[drive.index] = std::max(lower_[drive.index], std::min(at_lower, at_upper));
  upper_[drive.index] = std::min(upper_[drive.index], std::max(at_lower, at_upper));
  if (lower_[drive.index] <= upper_[drive.index]) return;
  throw InputError("robot '" + description_.name + "': no position of joint '" +
                   joint_names_[static_cast<std::size_t>(drive.index)] + "' keeps '" + joint.name +
                   "', which mimics it, and all other joints that do inside their limits");
}

void RobotModel::resolve_drives() {
  std::map<std::string, const Joint*> by_name;
  std::map<std::string, int> actuated;
  for (const Joint& joint : description_.joints) by_name[joint.name] = &joint;
  for (int i = 0; i < dof(); ++i) actuated[joint_names_[static_cast<std::size_t>(i)]] = i;
  for (const Joint& joint : description_.joints) {
    Drive drive;
    const Joint* source = &joint;
    for (std::size_t steps = 0; source->mimic; ++steps) {  // q = m1 (m2 q'' + o2) + o1
      const auto found = by_name.find(source->mimic->joint);
      require(found != by_name.end() && steps < by_name.size(), "joint '" + joint.name + "' mimics no moving joint");
      drive.offset += drive.multiplier * source->mimic->offset;
      drive.multiplier *= source->mimic->multiplier;
      source = found->second;
    }
    if (const auto found = actuated.find(source->name); found != actuated.end()) {
      drive.index = found->second;
    } else if (source->type != JointType::fixed) {  // not driven: rests
      drive.offset += drive.multiplier * rest_position(*source);
    }
    restrict_driver(joint, drive);
    drives_.push_back(drive);
  }
}

int RobotModel::link_index(const std::string& name) const {
  for (std::size_t i = 0; i < description_.links.size(); ++i) {
    if (description_.links[i].name == name) return static_cast<int>(i);
  }
  throw std::invalid_argument("no link '" + name + "' in robot '" + description_.name + "'");
}

Eigen::VectorXd RobotModel::joint_positions(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  require(q.size() == dof(), "joint_positions: configuration has " + std::to_string(q.size()) + " joints");
  Eigen::VectorXd positions(static_cast<Eigen::Index>(drives_.size()));
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const Drive& drive = drives_[i];
    positions[static_cast<Eigen::Index>(i)] =
        (drive.index < 0 ? 0.0 : drive.multiplier * q[drive.index]) + drive.offset;
  }
  return positions;
}

std::vector<Eigen::Isometry3d> RobotModel::link_poses(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  std::vector<Eigen::Isometry3d> X_RL;
  link_poses(q, X_RL);
  return X_RL;
}

void RobotModel::link_poses(const Eigen::Ref<const Eigen::VectorXd>& q, std::vector<Eigen::Isometry3d>& X_RL) const {
  require(q.size() == dof(), [&] {
    return "configuration has " + std::to_string(q.size()) + " joints, the robot " + std::to_string(dof());
  });
  X_RL.resize(description_.links.size());
  X_RL[0].setIdentity();
  for (std::size_t i = 0; i < description_.joints.size(); ++i) {
    place_child(i, q, X_RL[static_cast<std::size_t>(description_.joints[i].parent)], X_RL[i + 1]);
  }
}

void RobotModel::place_child(std::size_t index, const Eigen::Ref<const Eigen::VectorXd>& q,
                             const Eigen::Isometry3d& X_RP, Eigen::Isometry3d& X_RC) const {
  const Joint& joint = description_.joints[index];
  const Drive& drive = drives_[index];
  X_RC.makeAffine();
  const double position = (drive.index < 0 ? 0.0 : drive.multiplier * q[drive.index]) + drive.offset;
  if (joint.type == JointType::revolute) {
    const Turn& turn = turns_[index];
    const Eigen::Matrix3d R = turn.fixed + std::sin(position) * turn.odd + (1.0 - std::cos(position)) * turn.even;
    X_RC.linear().noalias() = X_RP.linear() * R;
  } else {
    X_RC.linear().noalias() = X_RP.linear() * turns_[index].fixed;
  }
  X_RC.translation() = X_RP.translation();
  X_RC.translation().noalias() += X_RP.linear() * joint.X_PJ.translation();
  if (joint.type == JointType::prismatic) X_RC.translation() += X_RC.linear() * (joint.axis * position);
}

Eigen::Matrix3Xd RobotModel::point_jacobian(const std::vector<Eigen::Isometry3d>& X_RL, int link,
                                            const Eigen::Vector3d& p_R) const {
  require(link >= 0 && static_cast<std::size_t>(link) < description_.links.size() &&
              X_RL.size() == description_.links.size(),
          "point_jacobian: link poses or link index do not belong to this robot");
  Eigen::Matrix3Xd jacobian = Eigen::Matrix3Xd::Zero(3, dof());
  for (int i = description_.links[static_cast<std::size_t>(link)].joint; i >= 0;) {
    const Joint& joint = description_.joints[static_cast<std::size_t>(i)];
    const Drive& drive = drives_[static_cast<std::size_t>(i)];
    if (joint.type != JointType::fixed && drive.index >= 0) {
      const Eigen::Isometry3d& X_RC = X_RL[static_cast<std::size_t>(joint.child)];
      const Eigen::Vector3d axis = drive.multiplier * (X_RC.linear() * joint.axis);
      jacobian.col(drive.index) +=
          joint.type == JointType::revolute ? axis.cross(p_R - X_RC.translation()).eval() : axis;
    }
    i = description_.links[static_cast<std::size_t>(joint.parent)].joint;
  }
  return jacobian;
}

Eigen::VectorXd RobotModel::clip(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  require(q.size() == dof(), "clip: configuration has " + std::to_string(q.size()) + " joints");
  return q.cwiseMax(lower_).cwiseMin(upper_);
}

bool RobotModel::within_limits(const Eigen::Ref<const Eigen::VectorXd>& q, double tolerance) const {
  require(q.size() == dof(), "within_limits: configuration has " + std::to_string(q.size()) + " joints");
  return ((q - lower_).array() >= -tolerance).all() && ((upper_ - q).array() >= -tolerance).all();
}

}  // namespace opponens::robot
