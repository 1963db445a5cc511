// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/srdf.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "robot_files.hpp"

namespace opponens::robot {
namespace {

class SrdfTest : public RobotFiles {
 protected:
  std::string srdf_error(const std::string& text) const {
    try {
      read_srdf(write("r.srdf", text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  static bool noted(const RobotDescription& description, const std::string& part) {
    return std::any_of(description.notes.begin(), description.notes.end(),
                       [&](const std::string& note) { return note.find(part) != std::string::npos; });
  }
};

const std::string kSrdf = robot(
    "<group name='arm'><chain base_link='p' tip_link='q'/><joint name='s'/></group>"
    "<group name='both'><group name='arm'/><link name='a'/></group>"
    "<group_state name='home' group='arm'><joint name='s' value='0.5 -1e-1'/></group_state>"
    "<end_effector name='hand' parent_link='q' group='arm'/>"
    "<virtual_joint name='v' type='fixed' parent_frame='world' child_link='p'/>"
    "<disable_collisions link1='c' link2='p' reason='Never'/>"
    "<disable_collisions link1='c' link2='elsewhere' reason='Never'/>");

TEST_F(SrdfTest, ReadsGroupsStatesEndEffectorsAndPairs) {
  const Srdf srdf = read_srdf(write("r.srdf", kSrdf));
  ASSERT_EQ(srdf.groups.size(), 2u);
  EXPECT_EQ(srdf.groups[0].chains, (std::vector<std::pair<std::string, std::string>>{{"p", "q"}}));
  EXPECT_EQ(srdf.groups[0].joints, std::vector<std::string>{"s"});
  EXPECT_EQ(srdf.groups[1].groups, std::vector<std::string>{"arm"});
  EXPECT_EQ(srdf.groups[1].links, std::vector<std::string>{"a"});
  ASSERT_EQ(srdf.group_states.size(), 1u);
  EXPECT_EQ(srdf.group_states[0].joints.at("s"), (std::vector<double>{0.5, -0.1}));
  ASSERT_EQ(srdf.end_effectors.size(), 1u);
  EXPECT_EQ(srdf.end_effectors[0].parent_link, "q");
  ASSERT_EQ(srdf.disabled.size(), 2u);
  EXPECT_EQ(srdf.disabled[0].reason, "Never");
  EXPECT_EQ(srdf.ignored, (std::map<std::string, int>{{"virtual_joint", 1}}));
}

TEST_F(SrdfTest, DisabledPairsAreAllowedAndTheRestIsNoted) {
  write("hand.urdf", robot(links("abc") + joint("j", "a", "b") + joint("k", "b", "c")));
  write("arm.urdf", robot(links("pq") + joint("s", "p", "q")));
  write("r.srdf", kSrdf);
  write("hand.srdf", robot("<disable_collisions link1='a' link2='c'/>"));
  write("hand.yaml", "urdf: hand.urdf\npalm_link: a\njoints: [j, k]\nsrdf: hand.srdf\n");
  const auto yaml = write("r.yaml",
                          "arm: {urdf: arm.urdf, joints: [s]}\nhand: hand.yaml\nmount: {parent: q}\n"
                          "srdf: r.srdf\n");
  const RobotDescription loaded = load_robot(yaml);  // links p q a b c
  EXPECT_EQ(loaded.allowed_collisions, (std::set<std::pair<int, int>>{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {2, 4}, {0, 4}}));
  EXPECT_EQ(loaded.semantics.size(), 2u);
  EXPECT_TRUE(noted(loaded, "1 disabled pair left out, of links that the robot does not have: elsewhere"));
  EXPECT_TRUE(noted(loaded, "<virtual_joint> ignored (1)"));
  EXPECT_TRUE(noted(loaded, "2 groups, 1 end effector and 1 group state"));
  const auto file = std::find(loaded.files.begin(), loaded.files.end(), folder_ / "r.srdf");
  EXPECT_NE(file, loaded.files.end()) << "provenance hashes what was read";
  EXPECT_EQ(hand_of(loaded).allowed_collisions, (std::set<std::pair<int, int>>{{0, 1}, {1, 2}, {0, 2}}));
}

TEST_F(SrdfTest, ErrorsNameFileAndLine) {
  expect_contains(srdf_error("<robot name='r'>\n<group"), {"r.srdf", "line 2", "not XML"});
  expect_contains(srdf_error("<model/>"), {"r.srdf", "<robot>"});
  expect_contains(srdf_error("<robot>\n<disable_collisions link1='a'/></robot>"),
                  {"r.srdf", "line 2", "<disable_collisions>", "'link2'"});
  expect_contains(srdf_error("<robot>\n<group/></robot>"), {"r.srdf", "line 2", "<group>", "'name'"});
  for (const char* value : {"one", "1 x", "nan", "", "1e999"}) {
    expect_contains(srdf_error("<robot>\n<group_state name='h' group='g'>\n<joint name='s' value='" +
                               std::string(value) + "'/></group_state></robot>"),
                    {"r.srdf", "line 3", "<joint>"});
  }
  write("hand.urdf", robot(links("ab") + joint("j", "a", "b")));
  expect_contains(error_of(write("hand.yaml", "urdf: hand.urdf\npalm_link: a\njoints: [j]\nsrdf: gone.srdf\n")),
                  {"gone.srdf", "cannot be opened"});
}

}  // namespace
}  // namespace opponens::robot
