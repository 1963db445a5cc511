// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Forward kinematics of every URDF at hand against a second reading of the file: urdfdom's own transforms, chained as
// homogeneous 4x4 matrices by quaternions. It shares neither the reader nor a formula with RobotModel.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include "core/rng.hpp"
#include "robot/read_urdf.hpp"
#include "robot/robot_model.hpp"
#include "robot_test.hpp"

namespace opponens::robot {
namespace {

using Eigen::Matrix4d;
using Positions = std::map<std::string, double>;  ///< of every moving joint, rad or m

Matrix4d homogeneous(double x, double y, double z, double w, const urdf::Vector3& p) {
  Matrix4d T;
  T << 1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), p.x,  //
      2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), p.y,   //
      2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), p.z,   //
      0, 0, 0, 1;
  return T;
}

double position_of(const urdf::ModelInterface& model, const urdf::Joint& joint, const Positions& positions) {
  if (!joint.mimic) return positions.at(joint.name);
  const double other = position_of(model, *model.getJoint(joint.mimic->joint_name), positions);
  return joint.mimic->multiplier * other + joint.mimic->offset;
}

Matrix4d motion(const urdf::Joint& joint, double position) {
  const urdf::Vector3 axis = joint.axis;
  const double length = std::sqrt(axis.x * axis.x + axis.y * axis.y + axis.z * axis.z);
  if (joint.type == urdf::Joint::PRISMATIC) {
    const double d = position / length;
    return homogeneous(0, 0, 0, 1, urdf::Vector3(d * axis.x, d * axis.y, d * axis.z));
  }
  const double s = std::sin(0.5 * position) / length;
  return homogeneous(s * axis.x, s * axis.y, s * axis.z, std::cos(0.5 * position), urdf::Vector3(0, 0, 0));
}

Matrix4d pose_of(const urdf::ModelInterface& model, const std::string& link, const Positions& positions) {
  const auto& joint = model.getLink(link)->parent_joint;
  if (!joint) return Matrix4d::Identity();
  const urdf::Pose& origin = joint->parent_to_joint_origin_transform;
  Matrix4d T = pose_of(model, joint->parent_link_name, positions) *
               homogeneous(origin.rotation.x, origin.rotation.y, origin.rotation.z, origin.rotation.w, origin.position);
  if (joint->type != urdf::Joint::FIXED) T *= motion(*joint, position_of(model, *joint, positions));
  return T;
}

urdf::ModelInterfaceSharedPtr other_reading(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return urdf::parseURDF(text.str());
}

/// Every moving joint that mimics none is actuated.
RobotModel whole_model(const std::filesystem::path& file, const urdf::ModelInterface& model) {
  UrdfSettings settings;
  for (const auto& [name, link] : model.links_) settings.without_geometry.insert(name);
  RobotDescription description = read_urdf(file, settings);
  for (const Joint& joint : description.joints) {
    if (joint.type != JointType::fixed && !joint.mimic) description.arm_joints.push_back(joint.name);
  }
  return RobotModel(description);
}

/// Returns the number of moving joints compared.
int check_file(const std::filesystem::path& file) {
  SCOPED_TRACE(file.string());
  const auto model = other_reading(file);
  const RobotModel robot = whole_model(file, *model);
  Rng rng(51);
  for (int sample = 0; sample < 20; ++sample) {
    Eigen::VectorXd q(robot.dof());
    Positions positions;
    for (int i = 0; i < robot.dof(); ++i) {
      q[i] = rng.uniform(robot.lower()[i], robot.upper()[i]);
      positions[robot.joint_names()[static_cast<std::size_t>(i)]] = q[i];
    }
    const auto X_RL = robot.link_poses(q);
    for (std::size_t link = 0; link < X_RL.size(); ++link) {
      const Matrix4d other = pose_of(*model, robot.links()[link].name, positions);
      EXPECT_LT((X_RL[link].matrix() - other).cwiseAbs().maxCoeff(), 1e-12) << robot.links()[link].name;
    }
  }
  return robot.dof();
}

TEST(ForwardKinematics, OfOurFilesMatchAnotherReading) {
  EXPECT_EQ(check_file(ours("ur5_allegro/ur5.urdf")), 6);
  EXPECT_EQ(check_file(ours("ur5_allegro/allegro_right.urdf")), 16);
  EXPECT_EQ(check_file(ours("human_hand/human_hand.urdf")), 23);
  EXPECT_EQ(check_file(OPPONENS_SOURCE_DIR "/tests/data/robots/seven_joint_arm.urdf"), 7);
  EXPECT_EQ(check_file(OPPONENS_SOURCE_DIR "/tests/data/robots/gantry.urdf"), 6);
}

TEST(ForwardKinematics, OfMimicJointsMatchAnotherReading) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "mimic.urdf";
  std::ofstream(file) << R"(<robot name="mimic"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
    <joint name="first" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0.1 0.2 0.3" rpy="0.4 -0.5 0.6"/>
      <axis xyz="0 3 4"/><limit lower="-1" upper="1.2" effort="1" velocity="1"/></joint>
    <joint name="second" type="revolute"><parent link="b"/><child link="c"/><origin xyz="0 0 0.1" rpy="1 0 0"/>
      <axis xyz="1 0 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/>
      <mimic joint="first" multiplier="-1.5" offset="0.2"/></joint>
    <joint name="third" type="prismatic"><parent link="c"/><child link="d"/><origin xyz="0 0.1 0" rpy="0 1 0"/>
      <axis xyz="1 1 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/>
      <mimic joint="second" multiplier="0.5" offset="-0.1"/></joint></robot>)";
  EXPECT_EQ(check_file(file), 1);
}

TEST(ForwardKinematics, OfRealRobotsMatchAnotherReading) {
  const std::filesystem::path folder = OPPONENS_SHARED_DATA "/data/robots";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " OPPONENS_SHARED_DATA;
  const std::pair<const char*, int> files[] = {
      {"example-robot-data/robots/ur_description/urdf/ur5_robot.urdf", 6},
      {"example-robot-data/robots/ur_description/urdf/ur5_joint_limited_robot.urdf", 6},
      {"example-robot-data/robots/allegro_hand_description/urdf/allegro_right_hand.urdf", 16},
      {"example-robot-data/robots/allegro_hand_description/urdf/allegro_left_hand.urdf", 16},
      {"paper_lab_ur5_allegro/UR5_AllegroHandR_water.urdf", 22},
      {"paper_lab_ur5_allegro/UR5_AllegroHandL_water.urdf", 22},
      {"paper_lab_ur5_allegro/UR5_AllegroHandR_cylinder.urdf", 22},
      {"paper_lab_ur5_allegro/UR5_AllegroHandL_cylinder.urdf", 22},
      {"dex-urdf/robots/hands/allegro_hand/allegro_hand_right.urdf", 16},
      {"dex-urdf/robots/hands/allegro_hand/allegro_hand_left.urdf", 16},
      {"dex-urdf/robots/hands/shadow_hand/shadow_hand_right.urdf", 24},
      {"dex-urdf/robots/hands/shadow_hand/shadow_hand_left.urdf", 24},
      {"dex-urdf/robots/hands/barrett_hand/bhand_model.urdf", 8},
  };
  for (const auto& [file, joints] : files) EXPECT_EQ(check_file(folder / file), joints) << file;
}

}  // namespace
}  // namespace opponens::robot
