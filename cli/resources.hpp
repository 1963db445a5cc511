// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace opponens::cli {

/// The file a user named: as given when it exists, else below the data folder ($OPPONENS_DATA, the installed
/// share/opponens beside this program, or the source tree it was built from). Throws InputError when nowhere.
std::filesystem::path find_file(const std::string& name);

/// The same; nothing when it is nowhere.
std::optional<std::filesystem::path> look_up(const std::string& name);

/// A robot.yaml, and the arm of it that is meant.
struct NamedRobot {
  std::filesystem::path file;
  std::string arm;  ///< empty: the file's only or default arm
};
/// What --robot names: FILE, or FILE#ARM of a robot with several arms (unless a file has that whole name). Throws
/// InputError when there is no such file.
NamedRobot named_robot(const std::string& text);

/// The name under which a found file is recorded and found again: relative to the data folder when it lies inside, so
/// that equal runs on two machines store equal bytes; else absolute, so that it is found from any working directory.
std::string recorded_name(const std::filesystem::path& file);

/// The name under which a file is recorded that is never looked for again: as above, but outside the data folder the
/// file's name alone, so that the same recording is the same object whatever path led to it.
std::string portable_name(const std::filesystem::path& file);

/// Where what saves time the next time is kept (robot/cover_file.hpp): $OPPONENS_CACHE_DIR, $XDG_CACHE_HOME/opponens
/// when that is absolute, or ~/.cache/opponens. Empty, for nowhere, when $OPPONENS_CACHE_DIR is set but empty, or none
/// is set.
std::filesystem::path cover_folder();

/// SHA-256 (hex) of a file's bytes. Throws InputError when it cannot be read.
std::string file_sha256(const std::filesystem::path& file);

}  // namespace opponens::cli
