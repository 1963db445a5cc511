// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace opponens::fuzz {

/// Of this process and removed with it, in memory where the system has that.
struct ScratchFolder {
  ScratchFolder() {
    const std::filesystem::path memory = "/dev/shm";
    path = std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
    path /= "opponens_fuzz-" + std::to_string(::getpid());
    std::filesystem::create_directories(path);
  }
  ~ScratchFolder() {
    std::error_code error;
    std::filesystem::remove_all(path, error);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::filesystem::path path;
};

/// For readers that want a file.
inline const std::filesystem::path& scratch() {
  static const ScratchFolder folder;
  return folder.path;
}

inline std::filesystem::path spill(const std::string& name, std::string_view bytes) {
  const std::filesystem::path file = scratch() / name;
  std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
  return file;
}

}  // namespace opponens::fuzz
