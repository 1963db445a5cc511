// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: every libhdf5 call that storage makes, wrapped once and checked there. A failed call throws
// StorageError with the file, the object and libhdf5's own reason.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "core/require.hpp"
#include "storage/record.hpp"
#include "storage/store.hpp"

namespace opponens::storage::hdf5 {

/// libhdf5 is built without thread safety: whoever calls anything here holds this lock, and all handles that it made
/// are closed before it is given back.
[[nodiscard]] std::unique_lock<std::recursive_mutex> lock_library();

/// Owns one HDF5 identifier (hid_t) and closes it.
class Handle {
 public:
  using Close = int (*)(std::int64_t);
  Handle(std::int64_t id, Close close) : id_(id), close_(close) {}
  ~Handle();
  Handle(Handle&& other) noexcept;
  Handle& operator=(Handle&& other) noexcept;
  std::int64_t id() const { return id_; }
  void finish();  ///< closes; tells what the destructor cannot: that the last bytes do not fit on the disk

 private:
  std::int64_t id_;
  Close close_;
};

/// A file that lives in memory only: libhdf5 never touches the disk, so a full disk or a kill meets only our own
/// write, fsync and rename. No time stamps: equal content gives equal bytes.
Handle create_in_memory();
std::vector<std::byte> image(const Handle& file);

/// A file of any size on the disk, of the same form; an existing one is replaced.
Handle create_on_disk(const std::string& path);
void flush(const Handle& file);

/// Runs what writes a file on the disk. That libhdf5 cannot is the fault of out's disk, not of a store.
template <typename Action>
void write_to(const std::filesystem::path& out, const Action& action) {
  try {
    action();
  } catch (const StorageError&) {
    throw InputError(out.string() + ": cannot write: disk full?");
  }
}

/// Opens the bytes of a file, read-only. name is for messages.
Handle open_in_memory(std::span<const std::byte> bytes, const std::string& name);

Handle create_group(const Handle& parent, const std::string& name);
Handle open_group(const Handle& parent, const std::string& name);

/// Names of the links of a group and of the attributes of an object, sorted by their bytes.
std::vector<std::string> links(const Handle& group);
std::vector<std::string> attributes(const Handle& object);

// Attributes: scalars of float64, int64, uint64 or UTF-8 text. Lists are datasets: an attribute ends at 64 kB.
void write_attribute(const Handle& object, const std::string& name, double value);
void write_attribute(const Handle& object, const std::string& name, std::int64_t value);
void write_attribute(const Handle& object, const std::string& name, std::uint64_t value);
void write_attribute(const Handle& object, const std::string& name, const std::string& value);
Field read_attribute(const Handle& object, const std::string& name);  ///< one of the scalars that a Field can be
std::int64_t read_integer(const Handle& object, const std::string& name);
std::uint64_t read_unsigned(const Handle& object, const std::string& name);
std::string read_string(const Handle& object, const std::string& name);

// Datasets: [n] or [rows x cols] of float64 in row-major order, contiguous (reading also knows chunked and compressed
// ones), [n] UTF-8 strings. Those of numbers return where the values begin in the file; 0 when there are none.
std::uint64_t write_dataset(const Handle& group, const std::string& name, const Eigen::VectorXd& values);
std::uint64_t write_dataset(const Handle& group, const std::string& name, const Eigen::MatrixXd& values);
void write_dataset(const Handle& group, const std::string& name, const std::vector<std::string>& values);
Field read_dataset(const Handle& group, const std::string& name);

}  // namespace opponens::storage::hdf5
