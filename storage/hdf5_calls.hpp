// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: what the two files of wrappers share. The only header that shows libhdf5's types.

#include <hdf5.h>

#include <string>
#include <vector>

#include "storage/hdf5_wrappers.hpp"

namespace opponens::storage::hdf5 {

/// The first libhdf5 reason for a failure, e.g. "object 'x' doesn't exist".
std::string reason();

/// Throws StorageError. near: an object whose file and path name the place.
[[noreturn]] void fail(hid_t near, const std::string& name, const std::string& what, const std::string& why);

/// Passes a libhdf5 result on, or throws when it is negative.
template <typename T>
T checked(T result, hid_t near, const std::string& name, const std::string& what) {
  if (result < 0) fail(near, name, what, reason());
  return result;
}

Handle properties(hid_t kind);  ///< an empty property list

/// Keeps all attributes in the object header, where they are cheap to read and their order is that of writing.
void configure_object(const Handle& creation);

Handle string_type();  ///< variable-length UTF-8
bool is_text(hid_t type);
std::vector<hsize_t> shape_of(const Handle& space, hid_t near, const std::string& name);

/// Copies what libhdf5 allocated for variable-length strings, and gives it back.
std::vector<std::string> take_strings(std::vector<char*>& raw, const Handle& type, const Handle& space);

}  // namespace opponens::storage::hdf5
