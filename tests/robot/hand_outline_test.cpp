// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/hand_outline.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "robot/load_robot.hpp"
#include "robot/propose_contacts.hpp"
#include "robot/propose_mapping.hpp"
#include "robot_test.hpp"

namespace opponens::robot {
namespace {

TEST(HandOutline, PalmIsWhereTheFingersBranch) {
  const RobotDescription robot = load_robot(ours("ur5_allegro/ur5_allegro_right.yaml"));
  EXPECT_EQ(find_palm(robot), RobotModel(robot).palm());
  EXPECT_EQ(fingers_of(robot, *find_palm(robot)).size(), 4u);
  const RobotDescription arm = load_urdf(ours("ur5_allegro/ur5.urdf"), {});
  EXPECT_FALSE(find_palm(arm).has_value());
  EXPECT_EQ(arm.arm_joints.size(), 6u);
  EXPECT_TRUE(arm.hand_joints.empty());
  const RobotDescription hand = load_urdf(ours("ur5_allegro/allegro_right.urdf"), {});
  EXPECT_EQ(hand.palm_link, "palm_link");
  EXPECT_EQ(hand.hand_joints.size(), 16u);
}

TEST(HandOutline, FingersAreNamedByTipsByWordsOrByPlace) {
  const auto names = [](const RobotDescription& hand) {
    std::set<std::string> result;
    for (const SurfacePoint& tip : propose_contacts(RobotModel(hand)).tips) result.insert(tip.finger);
    return result;
  };
  const std::set<std::string> four = {"index", "middle", "ring", "thumb"};
  EXPECT_EQ(names(load_hand(ours("ur5_allegro/allegro_right.yaml"))), four);
  const RobotDescription unnamed = load_urdf(ours("ur5_allegro/allegro_right.urdf"), {});
  EXPECT_EQ(names(unnamed), four) << "by place";
  const RobotModel model(unnamed);
  for (const SurfacePoint& tip : propose_contacts(model).tips) {
    const std::map<std::string, std::string> links = {
        {"index", "link_3.0_tip"}, {"middle", "link_7.0_tip"}, {"ring", "link_11.0_tip"}, {"thumb", "link_15.0_tip"}};
    EXPECT_EQ(model.links()[static_cast<std::size_t>(tip.link)].name, links.at(tip.finger));
  }
  RobotDescription human = load_hand(ours("human_hand/human_hand.yaml"));
  const std::set<std::string> five = {"index", "little", "middle", "ring", "thumb"};
  EXPECT_EQ(names(human), five) << "the forearm hangs on the palm too, but has no tip";
  human.tips.clear();
  const std::set<std::string> found = names(human);
  EXPECT_TRUE(std::includes(found.begin(), found.end(), five.begin(), five.end())) << "by their links";
}

TEST(ProposeMapping, IsThatOfOurAllegro) {
  const auto yaml = ours("ur5_allegro/allegro_right.yaml");
  const auto proposed = propose_mapping(RobotModel(load_hand(yaml)));
  ASSERT_TRUE(proposed.has_value());
  const HandMapping given = load_hand_mapping(yaml);
  const auto copies = [](const HandMapping& mapping) {
    std::map<std::string, std::pair<std::string, double>> result;
    for (const JointMapping& copy : mapping.copied) result[copy.joint] = {copy.channel, copy.gain};
    return result;
  };
  EXPECT_EQ(copies(*proposed), copies(given));
  EXPECT_EQ(proposed->fitted, given.fitted);
  EXPECT_EQ(proposed->fingertips, given.fingertips);
  EXPECT_EQ(proposed->measured_from, given.measured_from);
  EXPECT_NEAR((proposed->R_robot_human - given.R_robot_human).norm(), 0.0, 1e-9);
}

TEST(ProposeMapping, RealHands) {
  const std::string hands = OPPONENS_SHARED_DATA "/data/robots/dex-urdf/robots/hands/";
  if (!std::filesystem::exists(hands)) GTEST_SKIP() << "no " << hands;
  setenv("DEX_URDF", OPPONENS_SHARED_DATA "/data/robots/dex-urdf", 1);
  const RobotDescription shadow = load_hand(ours("shadow_hand/shadow_right.yaml"));
  const auto mapping = propose_mapping(RobotModel(shadow));
  ASSERT_TRUE(mapping.has_value());
  const HandMapping given = load_hand_mapping(ours("shadow_hand/shadow_right.yaml"));
  EXPECT_LT((mapping->R_robot_human - given.R_robot_human).norm(), 0.05);

  const auto unmapped = [&](const std::string& file) {
    return !propose_mapping(RobotModel(load_urdf(hands + file, {}))).has_value();
  };
  EXPECT_TRUE(unmapped("allegro_hand/allegro_hand_left.urdf")) << "the human hand is a right one";
  EXPECT_TRUE(unmapped("shadow_hand/shadow_hand_left.urdf"));
  EXPECT_FALSE(unmapped("allegro_hand/allegro_hand_right.urdf"));
  EXPECT_FALSE(unmapped("shadow_hand/shadow_hand_right.urdf"));
}

}  // namespace
}  // namespace opponens::robot
