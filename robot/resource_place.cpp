// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/resource_place.hpp"

#include <optional>

namespace opponens::robot {

namespace {

/// A folder called `package` above the file, or beside one that is above it.
std::optional<std::filesystem::path> package_above(const std::filesystem::path& file, const std::string& package) {
  std::error_code error;
  std::filesystem::path folder = std::filesystem::absolute(file, error).parent_path();
  for (; !folder.empty() && folder != folder.root_path(); folder = folder.parent_path()) {
    if (folder.filename() == package) return folder;
    if (std::filesystem::is_directory(folder / package, error)) return folder / package;
  }
  return std::nullopt;
}

std::optional<std::filesystem::path> package_folder(const std::string& package, const std::filesystem::path& file,
                                                    const PackagePaths& packages) {
  if (const auto found = packages.directories.find(package); found != packages.directories.end()) return found->second;
  std::error_code error;
  for (const std::filesystem::path& root : packages.roots) {
    if (std::filesystem::is_directory(root / package, error)) return root / package;
  }
  return package_above(file, package);
}

/// Whether `inner` lies in `folder` once links are followed; what does not exist is judged by its names, and what
/// cannot be followed (links in a circle) is left to the check that it is a file.
bool lies_in(const std::filesystem::path& inner, const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::path full = std::filesystem::weakly_canonical(inner, error);
  if (error) return true;
  const std::filesystem::path root = std::filesystem::weakly_canonical(folder, error);
  if (error) return true;
  const std::filesystem::path relative = full.lexically_relative(root);
  return !relative.empty() && *relative.begin() != "..";
}

ResourcePlace checked_file(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error)) return {path, ""};
  if (std::filesystem::is_directory(path, error)) return {path, "is a directory: " + path.string()};
  const bool exists = std::filesystem::exists(path, error);
  return {path, (exists ? "is not a regular file: " : "does not exist: ") + path.string()};
}

}  // namespace

ResourcePlace find_resource(const std::string& name, const std::filesystem::path& file, const PackagePaths& packages) {
  static const std::string kPackage = "package://";
  static const std::string kFile = "file://";
  if (name.starts_with(kFile)) return checked_file(name.substr(kFile.size()));
  if (!name.starts_with(kPackage)) {
    const std::filesystem::path path = name;
    return checked_file(path.is_absolute() ? path : file.parent_path() / path);
  }
  const std::size_t slash = name.find('/', kPackage.size());
  const std::string package = name.substr(kPackage.size(), slash - kPackage.size());
  const std::filesystem::path rest = slash == std::string::npos ? "" : name.substr(slash + 1);
  const std::filesystem::path plain = rest.lexically_normal();
  if (package.empty() || package == "." || package == ".." || rest.is_absolute() ||
      (!plain.empty() && *plain.begin() == "..")) {
    return {{}, "leaves its package", true};
  }
  const std::optional<std::filesystem::path> folder = package_folder(package, file, packages);
  if (!folder) return {{}, "package '" + package + "' has no path (key packages of the YAML file that names this one)"};
  if (!lies_in(*folder / rest, *folder)) return {{}, "leaves its package, " + folder->string(), true};
  return checked_file(*folder / rest);
}

}  // namespace opponens::robot
