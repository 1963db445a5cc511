// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Robot files written by a test, and what loading them complains about.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/require.hpp"
#include "robot/load_robot.hpp"

namespace opponens::robot {

/// A folder of one test, removed with it.
class RobotFiles : public ::testing::Test {
 protected:
  RobotFiles()
      : folder_(
            std::filesystem::temp_directory_path() /
            (std::string("opponens_robot_files_") + ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(folder_);
  }
  ~RobotFiles() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  /// The message of the InputError that loading this URDF as a hand gives.
  std::string urdf_error(const std::string& urdf, const std::string& joints = "j") const {
    write("hand.urdf", urdf);
    return error_of(write("hand.yaml", "urdf: hand.urdf\npalm_link: a\njoints: [" + joints + "]\n"));
  }

  static std::string error_of(const std::filesystem::path& yaml,
                              RobotDescription (*load)(const std::filesystem::path&) = load_hand) {
    try {
      load(yaml);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path folder_;
};

inline void expect_contains(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << " is not in: " << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << "one line is wanted: " << text;
}

inline const std::string kLimit = "<limit lower='-1' upper='1' effort='1' velocity='1'/>";

inline std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                         const std::string& type = "revolute", const std::string& inside = kLimit) {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent + "'/><child link='" + child + "'/>" +
         inside + "</joint>";
}

inline std::string links(const std::string& names) {
  std::string text;
  for (const char name : names) text += std::string("<link name='") + name + "'/>";
  return text;
}

inline std::string robot(const std::string& inside) { return "<robot name='r'>" + inside + "</robot>"; }

}  // namespace opponens::robot
