// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: what the two files of wrappers share. hid_t is std::int64_t and hsize_t unsigned long long (both
// asserted where hdf5.h is included), so that libhdf5's header stays in the .cpp files.

#include <cstdint>
#include <string>
#include <vector>

#include "storage/hdf5_wrappers.hpp"

namespace opponens::storage::hdf5 {

/// The first libhdf5 reason for a failure, e.g. "object 'x' doesn't exist".
std::string reason();

/// Throws StorageError. near: an object whose file and path name the place.
[[noreturn]] void fail(std::int64_t near, const std::string& name, const std::string& what, const std::string& why);

/// Passes a libhdf5 result on, or throws when it is negative.
template <typename T>
T checked(T result, std::int64_t near, const std::string& name, const std::string& what) {
  if (result < 0) fail(near, name, what, reason());
  return result;
}

Handle properties(std::int64_t kind);  ///< an empty property list

/// For making objects: no time stamps, and all attributes in the object header, where they are cheap to read and their
/// order is that of writing.
Handle object_properties(std::int64_t kind);

Handle utf8_names(std::int64_t kind);  ///< for making links or attributes with UTF-8 names

Handle string_type();  ///< variable-length UTF-8
bool is_text(std::int64_t type);
std::vector<unsigned long long> shape_of(const Handle& space, std::int64_t near, const std::string& name);

/// Copies what libhdf5 allocated for variable-length strings, and gives it back.
std::vector<std::string> take_strings(std::vector<char*>& raw, const Handle& type, const Handle& space);

}  // namespace opponens::storage::hdf5
