// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "robot/hand_mapping.hpp"
#include "robot/load_robot.hpp"
#include "tests/robot/swinging_hand.hpp"

namespace opponens::robot {
namespace {

TEST(CalibrateRange, MapsPercentilesToTheJointRange) {
  const RobotModel human(load_hand(kHuman));
  Demonstration recording;
  recording.id = "r";
  recording.joint_names = {"I_MCP", "I_PIP", "unknown", "M_MCP"};
  recording.time = Eigen::VectorXd::LinSpaced(101, 0, 1);
  recording.q_h.resize(101, 4);
  for (int t = 0; t <= 100; ++t) recording.q_h.row(t) << 0.01 * t, -0.02 * t, t, 0.7;
  const ChannelCalibration calibration = calibrate_range({&recording}, human);
  ASSERT_EQ(calibration.channels, (std::vector<std::string>{"I_MCP", "I_PIP", "M_MCP"}));
  const auto joint = [&](const std::string& name) {
    const auto& names = human.joint_names();
    return std::find(names.begin(), names.end(), name) - names.begin();
  };
  const Eigen::Index mcp = joint("I_MCP");
  EXPECT_NEAR(calibration.gain[0] * 0.01 + calibration.offset[0], human.lower()[mcp], 1e-12);
  EXPECT_NEAR(calibration.gain[0] * 0.99 + calibration.offset[0], human.upper()[mcp], 1e-12);
  const Eigen::Index pip = joint("I_PIP");
  EXPECT_NEAR(calibration.gain[1] * -1.98 + calibration.offset[1], human.lower()[pip], 1e-12);
  EXPECT_NEAR(calibration.gain[1] * -0.02 + calibration.offset[1], human.upper()[pip], 1e-12);
  EXPECT_EQ(calibration.gain[2], 0.0) << "a channel that does not move";
  EXPECT_EQ(calibration.offset[2], 0.0);
  EXPECT_EQ(calibration.still, std::vector<std::string>{"M_MCP"});
  recording.q_h(3, 0) = std::nan("");
  EXPECT_THROW(calibrate_range({&recording}, human), std::invalid_argument);
  EXPECT_THROW(calibrate_range({}, human), std::invalid_argument);
}

/// A CyberGlove counts in steps of about half a degree; a resting finger flickers by one.
TEST(CalibrateRange, FlickerOfOneStepIsNotAMovement) {
  const RobotModel human(load_hand(kHuman));
  const auto still = [&](double step) {
    Demonstration recording;
    recording.id = "r";
    recording.joint_names = {"I_MCP"};
    recording.time = Eigen::VectorXd::LinSpaced(100, 0, 1);
    recording.q_h.resize(100, 1);
    for (int t = 0; t < 100; ++t) recording.q_h(t, 0) = 0.3 + step * (t % 3 - 1);
    const ChannelCalibration calibration = calibrate_range({&recording}, human);
    EXPECT_EQ(calibration.gain[0] == 0.0, !calibration.still.empty());
    return !calibration.still.empty();
  };
  EXPECT_TRUE(still(0.5 * std::numbers::pi / 180));
  EXPECT_FALSE(still(1.5 * std::numbers::pi / 180)) << "that is a movement";
}

}  // namespace
}  // namespace opponens::robot
