// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// robot.yaml with the key `arms`: what it means, and what is refused in one line.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "core/require.hpp"
#include "robot/load_robot.hpp"
#include "robot/robot_arms.hpp"

namespace opponens::robot {
namespace {

namespace fs = std::filesystem;

std::string joint_element(const std::string& name, const std::string& parent, const std::string& child,
                          const std::string& more = "") {
  return "<joint name='" + name + "' type='revolute'><parent link='" + parent + "'/><child link='" + child +
         "'/><limit lower='-1' upper='2' effort='1' velocity='1'/>" + more + "</joint>";
}

/// Two equal arms of one joint, each with a gripper of two, one of which mimics the other, in a folder of the test's
/// own.
class ArmsFile : public ::testing::Test {
 protected:
  ArmsFile()
      : folder_(fs::temp_directory_path() / (std::string("opponens_arms_file_") +
                                             ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::create_directories(folder_);
    write("arm.urdf", "<robot name='r'><link name='p'/><link name='q'/>" + joint_element("s", "p", "q") + "</robot>");
    write("hand.urdf", "<robot name='h'><link name='a'/><link name='b'/><link name='c'/>" +
                           joint_element("j", "a", "b") +
                           joint_element("k", "a", "c", "<mimic joint='j' multiplier='0.5'/>") + "</robot>");
    write("hand.yaml", "urdf: hand.urdf\npalm_link: a\njoints: [j]\n");
    write("stand.urdf", "<robot name='t'><link name='q'/></robot>");
  }
  ~ArmsFile() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  /// The two arms' entries, the text `more` at the left one's end, then the file's other keys.
  fs::path robot(const std::string& more, const std::string& keys = "", const std::string& left = "left") const {
    const std::string arm = "    arm: {urdf: arm.urdf, joints: [s]}\n    hand: hand.yaml\n    mount: {parent: q}\n";
    return write("r.yaml", "arms:\n  right:\n" + arm + "  " + left + ":\n" + arm + more + keys);
  }

  static void refuse(const fs::path& yaml, const std::vector<std::string>& words, const std::string& group = "") {
    try {
      load_robot(yaml, group);
      ADD_FAILURE() << "was loaded; expected a message with " << words.back();
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << word << ": " << message;
    }
  }

  fs::path folder_;
};

TEST_F(ArmsFile, NamesRestDefaultAndStand) {
  const fs::path yaml =
      robot("    base: {parent: stand/q, xyz: [0, 0, 1]}\n    rest: {s: 1.5, j: 0.5}\n    weights: {s: 3, j: 4}\n",
            "stand: {urdf: stand.urdf, xyz: [0, 2, 0]}\ndefault: left\nallowed_collisions: [[right/c, left/c]]\n");
  const RobotDescription left = load_robot(yaml);
  EXPECT_EQ(left.driven_arms, (std::vector<std::string>{"left"}));
  EXPECT_EQ(left.links[0].name, "root");
  EXPECT_EQ(left.links[1].name, "stand/q");
  EXPECT_EQ(left.arm_joints, (std::vector<std::string>{"left/s"}));
  EXPECT_EQ(left.hand_joints, (std::vector<std::string>{"left/j"}));
  EXPECT_EQ(left.palm_link, "left/a");
  EXPECT_EQ(left.arm_tip_link, "left/q");
  EXPECT_EQ(left.weights, Eigen::Vector2d(3, 4));
  const RobotModel model(left);
  const std::pair<int, int> pair = std::minmax(model.link_index("left/c"), model.link_index("right/c"));
  EXPECT_TRUE(left.allowed_collisions.contains(pair));
  EXPECT_TRUE(left.allowed_collisions.contains({1, model.link_index("right/p")})) << "both are fixed to the root";
  EXPECT_EQ(model.link_poses(Eigen::Vector2d(0, 0))[static_cast<std::size_t>(model.link_index("left/p"))].translation(),
            Eigen::Vector3d(0, 2, 1));

  // The other arm driven: left rests where the file says, and what mimics a resting joint follows it.
  const RobotModel right(load_robot(yaml, "right"));
  const RobotModel both(load_robot(yaml, "both"));
  EXPECT_EQ(both.weights(), Eigen::Vector4d(1, 3, 1, 4));
  for (const char* link : {"left/q", "left/b", "left/c"}) {
    const auto index = static_cast<std::size_t>(right.link_index(link));
    const Eigen::Matrix4d rests = right.link_poses(Eigen::Vector2d(0.3, 0.4))[index].matrix();
    EXPECT_TRUE(rests.isApprox(both.link_poses(Eigen::Vector4d(0.3, 1.5, 0.4, 0.5))[index].matrix(), 1e-15)) << link;
    EXPECT_FALSE(rests.isApprox(both.link_poses(Eigen::Vector4d(0.3, 0, 0.4, 0))[index].matrix(), 1e-3)) << link;
  }
  EXPECT_EQ(load_robot(robot("")).driven_arms, (std::vector<std::string>{"right"})) << "the first without a default";
}

TEST_F(ArmsFile, FilesAreNamedOnce) {
  std::vector<fs::path> files = load_robot(robot("")).files;
  ASSERT_EQ(files.size(), 4u);
  std::sort(files.begin(), files.end());
  EXPECT_EQ(std::unique(files.begin(), files.end()), files.end());
}

TEST_F(ArmsFile, ChoiceOfArm) {
  refuse(robot(""), {"r.yaml", "'middle'", "right, left, both"}, "middle");
  refuse(robot("", "default: middle\n"), {"r.yaml:10", "default", "'middle'", "right, left, both"});
  write("one.yaml", "arm: {urdf: arm.urdf, joints: [s]}\nhand: hand.yaml\nmount: {parent: q}\n");
  refuse(folder_ / "one.yaml", {"one.yaml", "'arms'", "'right'"}, "right");
  EXPECT_EQ(load_robot(folder_ / "one.yaml").arm_joints, (std::vector<std::string>{"s"})) << "one arm has no prefix";
  const RobotDescription lone = load_robot(write(
      "lone.yaml", "arms:\n  right: {arm: {urdf: arm.urdf, joints: [s]}, hand: hand.yaml, mount: {parent: q}}\n"));
  EXPECT_EQ(arm_choices(lone), (std::vector<std::string>{"right"})) << "both needs two";
}

TEST_F(ArmsFile, BadNames) {
  for (const std::string name : {"stand", "root", "both"}) {
    refuse(robot("", "", name), {"r.yaml", "arms." + name, "cannot be called"});
  }
  refuse(robot("", "", "a/b"), {"r.yaml", "a/b", "neither / nor #"});
  refuse(robot("", "", "'a#b'"), {"r.yaml", "a#b", "neither / nor #"});
  refuse(robot("", "", "''"), {"r.yaml", "must not be empty"});
  refuse(robot("", "", "right"), {"r.yaml", "arms.right", "occurs twice"});
  refuse(write("r.yaml", "arms: {}\n"), {"r.yaml", "arms", "names no arm"});
  refuse(write("r.yaml", "arms: [a, b]\n"), {"r.yaml", "arms", "a map"});
}

TEST_F(ArmsFile, BadArms) {
  refuse(robot("    rest: {z: 0}\n"), {"r.yaml:10", "arms.left.rest.z", "no such arm or hand joint"});
  refuse(robot("    rest: {left/s: 0}\n"), {"r.yaml:10", "arms.left.rest.left/s", "no such"});
  refuse(robot("    rest: {k: 0}\n"), {"r.yaml:10", "arms.left.rest.k", "no such"});
  refuse(robot("    rest: {s: 2.5}\n"), {"r.yaml:10", "arms.left.rest.s", "from -1", "to 2", "'2.5'"});
  refuse(robot("    rest: {s: .nan}\n"), {"r.yaml:10", "arms.left.rest.s", "finite"});
  refuse(robot("    base: {parent: q}\n"), {"r.yaml:10", "arms.left.base.parent", "'q'", "stand/LINK"});
  refuse(robot("    base: {xyz: [0, 0]}\n"), {"r.yaml:10", "arms.left.base.xyz", "3 numbers"});
  refuse(robot("    base: {at: [0, 0, 0]}\n"), {"r.yaml:10", "arms.left.base.at", "unknown key"});
  refuse(robot("    collision: visual\n"), {"r.yaml:10", "arms.left.collision", "unknown key"});
  refuse(robot("", "arm: {}\n"), {"r.yaml:10", "arm", "unknown key"});
  refuse(robot("", "stand: {urdf: gone.urdf}\n"), {"gone.urdf", "cannot be opened"});
  refuse(robot("", "allowed_collisions: [[a, right/a]]\n"), {"r.yaml:10", "'a'", "ARM/LINK"});
  write("hand.yaml", "urdf: hand.urdf\npalm_link: a\njoints: []\n");
  refuse(robot(""), {"hand.yaml:3", "names no joint"});
  write("hand.yaml", "urdf: hand.urdf\npalm_link: a\njoints: [j]\n");
  const std::string rest = "    hand: hand.yaml\n    mount: {parent: q}\n";
  refuse(write("r.yaml", "arms:\n  one:\n    arm: {urdf: arm.urdf, joints: []}\n" + rest),
         {"r.yaml:3", "arms.one.arm.joints", "names no joint"});
  refuse(write("r.yaml", "arms:\n  one:\n    base: {}\n" + rest), {"r.yaml:3", "arms.one", "no key 'arm'"});
}

}  // namespace
}  // namespace opponens::robot
