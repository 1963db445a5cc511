// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Scenes and requests of other programs, written by a test, and what reading them complains about.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/require.hpp"
#include "robot/scene.hpp"

namespace opponens::robot {

/// A folder of one test, removed with it, for files of MoveIt.
class ForeignScenes : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("opponens_foreign_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_ / "package");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& text, const std::string& name) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  template <typename Load>
  std::string error_of(const Load& load, const std::string& text, const std::string& name) const {
    try {
      load(write(text, name));
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos);
      EXPECT_NE(message.find(name), std::string::npos) << message;
      return message;
    }
    ADD_FAILURE() << "accepted:\n" << text;
    return {};
  }

  std::string scene_error(const std::string& text, const std::string& name = "moveit.yaml") const {
    return error_of([](const std::filesystem::path& file) { load_scene(file); }, text, name);
  }

  std::filesystem::path folder_;
};

inline bool has_note(const std::vector<std::string>& notes, const std::string& part) {
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

}  // namespace opponens::robot
