// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>
#include <utility>

#include "storage/posix_file.hpp"

namespace opponens::storage {

/// A file that is written under another name until it is complete; removed when it never is.
class Draft {
 public:
  explicit Draft(std::filesystem::path final_path)
      : final_(std::move(final_path)), path_(final_.string() + ".tmp-" + std::to_string(::getpid())) {}
  ~Draft() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  const std::filesystem::path& path() const { return path_; }
  void complete() const { rename_file(path_, final_); }

 private:
  std::filesystem::path final_;
  std::filesystem::path path_;
};

}  // namespace opponens::storage
