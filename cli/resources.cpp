// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/resources.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

#include "core/require.hpp"
#include "storage/sha256.hpp"

namespace opponens::cli {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> data_folders() {
  std::vector<fs::path> folders;
  if (const char* folder = std::getenv("OPPONENS_DATA")) folders.emplace_back(folder);
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) folders.push_back(program.parent_path().parent_path() / "share" / "opponens");
  folders.emplace_back(OPPONENS_SOURCE_DIR);
  return folders;
}

}  // namespace

std::optional<fs::path> look_up(const std::string& name) {
  if (name.empty()) return std::nullopt;
  if (fs::exists(name)) return name;
  if (fs::path(name).is_relative()) {
    for (const fs::path& folder : data_folders()) {
      if (fs::exists(folder / name)) return folder / name;
    }
  }
  return std::nullopt;
}

fs::path find_file(const std::string& name) {
  if (name.empty()) throw InputError("an empty file name was given");
  if (const auto file = look_up(name)) return *file;
  throw InputError(name + ": no such file, neither here nor in the data folder");
}

NamedRobot named_robot(const std::string& text) {
  const std::size_t hash = text.rfind('#');
  if (hash == std::string::npos || look_up(text)) return {find_file(text), ""};
  if (hash + 1 == text.size()) throw InputError(text + ": names no arm after the #");
  return {find_file(text.substr(0, hash)), text.substr(hash + 1)};
}

std::string recorded_name(const fs::path& file) {
  const fs::path full = fs::weakly_canonical(file);
  for (const fs::path& folder : data_folders()) {
    const fs::path relative = full.lexically_relative(fs::weakly_canonical(folder));
    if (!relative.empty() && *relative.begin() != "..") return relative.generic_string();
  }
  return full.generic_string();
}

std::string portable_name(const fs::path& file) {
  const fs::path name = recorded_name(file);
  return (name.is_absolute() ? name.filename() : name).generic_string();
}

fs::path cover_folder() {
  if (const char* folder = std::getenv("OPPONENS_CACHE_DIR")) return folder;
  const char* const base = std::getenv("XDG_CACHE_HOME");
  if (base != nullptr && fs::path(base).is_absolute()) return fs::path(base) / "opponens";
  const char* const home = std::getenv("HOME");
  return home != nullptr && *home != '\0' ? fs::path(home) / ".cache" / "opponens" : fs::path();
}

std::string file_sha256(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file.string() + ": cannot read it");
  return storage::sha256(std::string(std::istreambuf_iterator<char>(stream), {}));
}

}  // namespace opponens::cli
