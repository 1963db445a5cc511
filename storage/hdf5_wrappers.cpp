// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/hdf5_wrappers.hpp"

#include <hdf5.h>

#include <algorithm>
#include <type_traits>
#include <utility>

#include "core/require.hpp"
#include "storage/hdf5_calls.hpp"
#include "storage/store.hpp"

namespace opponens::storage::hdf5 {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t> && std::is_same_v<herr_t, int>);
static_assert(std::is_same_v<hsize_t, unsigned long long>);

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::size_t kConversionBytes = 4096;
constexpr unsigned kCompactLinks = 64;  // a group with more of them is indexed
// libhdf5 refuses to open an image under the name of a file that exists; names in messages are shown without this.
constexpr const char* kInMemory = " (in memory)";
constexpr std::size_t kMemoryStep = 1U << 20U;  // bytes by which a file in memory grows

template <ssize_t (*get_name)(hid_t, char*, std::size_t)>
std::string name_of(hid_t id) {
  const ssize_t length = id < 0 ? 0 : get_name(id, nullptr, 0);
  if (length <= 0) return {};
  std::string name(static_cast<std::size_t>(length), '\0');
  get_name(id, name.data(), name.size() + 1);
  return name;
}

/// libhdf5 prints its error stack to stderr unless told not to, and closes at exit what could not be closed, which
/// crashes after a failed write (1.10.8). Before any other call.
void prepare() {
  static const bool done = H5dont_atexit() >= 0 && H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  (void)done;
}

Handle file_access() {
  Handle access = properties(H5P_FILE_ACCESS);
  // The oldest form that holds what is written, readable by every libhdf5. Newer superblocks carry a checksum that
  // H5Fget_file_image of libhdf5 1.10.8 leaves wrong; integrity is the SHA-256's business anyway.
  checked(H5Pset_libver_bounds(access.id(), H5F_LIBVER_EARLIEST, H5F_LIBVER_V18), -1, "", "choose the file format");
  return access;
}

Handle memory_access() {
  Handle access = file_access();
  checked(H5Pset_fapl_core(access.id(), kMemoryStep, false), -1, "", "choose the in-memory driver");
  return access;
}

Handle create(const std::string& name, const Handle& access) {
  const Handle creation = properties(H5P_FILE_CREATE);
  checked(H5Pset_obj_track_times(creation.id(), false), -1, "", "switch off time stamps");
  const hid_t file = H5Fcreate(name.c_str(), H5F_ACC_TRUNC, creation.id(), access.id());
  if (file < 0) throw InputError(name + ": cannot create: " + reason());
  return {file, H5Fclose};
}

Handle space_of(std::span<const hsize_t> shape) {
  const int rank = static_cast<int>(shape.size());
  return {checked(H5Screate_simple(rank, shape.data(), nullptr), -1, "", "make a dataspace"), H5Sclose};
}

std::vector<const char*> pointers(const std::vector<std::string>& values) {
  std::vector<const char*> result;
  result.reserve(values.size());
  for (const auto& value : values) result.push_back(value.c_str());
  return result;
}

/// Tracking the order makes libhdf5 choose the compact form of groups, a third of the size of the old one and faster.
Handle group_properties() {
  Handle creation = object_properties(H5P_GROUP_CREATE);
  checked(H5Pset_link_creation_order(creation.id(), H5P_CRT_ORDER_TRACKED), -1, "", "choose the form of groups");
  checked(H5Pset_link_phase_change(creation.id(), kCompactLinks, 0), -1, "", "choose the form of groups");
  return creation;
}

/// Strings are converted through buffers that libhdf5 clears for every dataset: 1 MB unless told otherwise, which would
/// take longer than all the rest of writing.
Handle transfer_properties() {
  Handle transfer = properties(H5P_DATASET_XFER);
  checked(H5Pset_buffer(transfer.id(), kConversionBytes, nullptr, nullptr), -1, "", "choose a buffer");
  return transfer;
}

/// Returns the place of contiguous values in the file, 0 where there are none.
std::uint64_t write_raw_dataset(const Handle& group, const std::string& name, hid_t stored_type, hid_t memory_type,
                                std::span<const hsize_t> shape, const void* data) {
  static const Handle creation = object_properties(H5P_DATASET_CREATE);
  static const Handle linking = utf8_names(H5P_LINK_CREATE);
  static const Handle transfer = transfer_properties();
  const Handle space = space_of(shape);
  Handle dataset(
      checked(H5Dcreate2(group.id(), name.c_str(), stored_type, space.id(), linking.id(), creation.id(), H5P_DEFAULT),
              group.id(), name, "create the dataset"),
      H5Dclose);
  const bool empty = std::find(shape.begin(), shape.end(), hsize_t{0}) != shape.end();
  if (empty) {
    dataset.finish();
    return 0;
  }
  checked(H5Dwrite(dataset.id(), memory_type, H5S_ALL, H5S_ALL, transfer.id(), data), group.id(), name,
          "write the dataset");
  const haddr_t place = H5Dget_offset(dataset.id());
  if (place == HADDR_UNDEF) fail(group.id(), name, "write the dataset", "its values have no place in the file");
  dataset.finish();  // writes what is left of them
  return place;
}

}  // namespace

std::string reason() {
  std::string text;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned, const H5E_error2_t* error, void* out) -> herr_t {
        auto& first = *static_cast<std::string*>(out);
        if (first.empty() && error->desc != nullptr) first = error->desc;
        return 0;
      },
      &text);
  return text.empty() ? "no reason given" : text;
}

void fail(hid_t near, const std::string& name, const std::string& what, const std::string& why) {
  std::string file = name_of<H5Fget_name>(near);
  if (file.ends_with(kInMemory)) file.resize(file.size() - std::string(kInMemory).size());
  const std::string path = name_of<H5Iget_name>(near);
  throw StorageError(file + ": " + path + (path.ends_with('/') || name.empty() ? "" : "/") + name + ": cannot " + what +
                     ": " + why);
}

Handle properties(hid_t kind) {
  Handle list(checked(H5Pcreate(kind), -1, "", "make a property list"), H5Pclose);
  return list;
}

Handle object_properties(hid_t kind) {
  Handle creation = properties(kind);
  checked(H5Pset_obj_track_times(creation.id(), false), -1, "", "switch off time stamps");
  checked(H5Pset_attr_phase_change(creation.id(), 65535, 65535), -1, "", "choose attribute storage");
  return creation;
}

Handle utf8_names(hid_t kind) {
  Handle list = properties(kind);
  checked(H5Pset_char_encoding(list.id(), H5T_CSET_UTF8), -1, "", "choose UTF-8 names");
  return list;
}

Handle string_type() {
  Handle type(checked(H5Tcopy(H5T_C_S1), -1, "", "make a string type"), H5Tclose);
  checked(H5Tset_size(type.id(), H5T_VARIABLE), -1, "", "make a string type");
  checked(H5Tset_cset(type.id(), H5T_CSET_UTF8), -1, "", "make a string type");
  return type;
}

std::vector<hsize_t> shape_of(const Handle& space, hid_t near, const std::string& name) {
  const int rank = checked(H5Sget_simple_extent_ndims(space.id()), near, name, "read the shape");
  std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
  checked(H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr), near, name, "read the shape");
  return shape;
}

bool is_text(hid_t type) { return H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) > 0; }

std::vector<std::string> take_strings(std::vector<char*>& raw, const Handle& type, const Handle& space) {
  std::vector<std::string> values;
  values.reserve(raw.size());
  for (const char* text : raw) values.emplace_back(text == nullptr ? "" : text);
  if (!raw.empty()) H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, raw.data());
  return values;
}

std::unique_lock<std::recursive_mutex> lock_library() {
  static std::recursive_mutex library;
  std::unique_lock lock(library);
  prepare();
  return lock;
}

Handle::~Handle() {
  if (id_ >= 0) close_(id_);
}
void Handle::finish() { checked(close_(std::exchange(id_, -1)), -1, "", "close"); }
Handle::Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
Handle& Handle::operator=(Handle&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(close_, other.close_);
  return *this;
}

Handle create_in_memory() { return create("batch", memory_access()); }

Handle create_on_disk(const std::string& path) { return create(path, file_access()); }

void flush(const Handle& file) { checked(H5Fflush(file.id(), H5F_SCOPE_GLOBAL), file.id(), "", "finish the file"); }

std::vector<std::byte> image(const Handle& file) {
  flush(file);
  const ssize_t size = checked(H5Fget_file_image(file.id(), nullptr, 0), file.id(), "", "size the file");
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  checked(H5Fget_file_image(file.id(), bytes.data(), bytes.size()), file.id(), "", "copy the file");
  return bytes;
}

Handle open_in_memory(std::span<const std::byte> bytes, const std::string& name) {
  const Handle access = memory_access();
  // libhdf5 copies the buffer; the parameter is not const for historical reasons only.
  void* data = const_cast<std::byte*>(bytes.data());  // NOLINT
  checked(H5Pset_file_image(access.id(), data, bytes.size()), -1, "", "hand over the bytes of " + name);
  const hid_t file = H5Fopen((name + kInMemory).c_str(), H5F_ACC_RDONLY, access.id());
  if (file < 0) throw StorageError(name + ": cannot open: " + reason());
  return {file, H5Fclose};
}

Handle create_group(const Handle& parent, const std::string& name) {
  static const Handle creation = group_properties();
  return {checked(H5Gcreate2(parent.id(), name.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), parent.id(), name,
                  "create the group"),
          H5Gclose};
}

Handle open_group(const Handle& parent, const std::string& name) {
  return {checked(H5Gopen2(parent.id(), name.c_str(), H5P_DEFAULT), parent.id(), name, "open the group"), H5Gclose};
}

std::vector<std::string> links(const Handle& group) {
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  checked(H5Literate(group.id(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, collect, &names), group.id(), "",
          "list the group");
  std::sort(names.begin(), names.end());
  return names;
}

std::uint64_t write_dataset(const Handle& group, const std::string& name, const Eigen::VectorXd& values) {
  const hsize_t shape[] = {static_cast<hsize_t>(values.size())};
  return write_raw_dataset(group, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, shape, values.data());
}
std::uint64_t write_dataset(const Handle& group, const std::string& name, const Eigen::MatrixXd& values) {
  const hsize_t shape[] = {static_cast<hsize_t>(values.rows()), static_cast<hsize_t>(values.cols())};
  const RowMajor rows = values.size() == 0 ? RowMajor() : RowMajor(values);  // Eigen would go through empty rows
  return write_raw_dataset(group, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, shape, rows.data());
}
void write_dataset(const Handle& group, const std::string& name, const std::vector<std::string>& values) {
  const hsize_t shape[] = {values.size()};
  const Handle type = string_type();
  write_raw_dataset(group, name, type.id(), type.id(), shape, static_cast<const void*>(pointers(values).data()));
}

Field read_dataset(const Handle& group, const std::string& name) {
  const Handle dataset(checked(H5Dopen2(group.id(), name.c_str(), H5P_DEFAULT), group.id(), name, "open the dataset"),
                       H5Dclose);
  const Handle stored(checked(H5Dget_type(dataset.id()), group.id(), name, "read the type"), H5Tclose);
  const Handle space(checked(H5Dget_space(dataset.id()), group.id(), name, "read the shape"), H5Sclose);
  const std::vector<hsize_t> shape = shape_of(space, group.id(), name);
  const auto read = [&](hid_t type, void* out) {
    checked(H5Dread(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, out), group.id(), name, "read the dataset");
  };
  if (is_text(stored.id()) && shape.size() == 1) {
    const Handle type = string_type();
    std::vector<char*> raw(shape[0], nullptr);
    if (!raw.empty()) read(type.id(), static_cast<void*>(raw.data()));
    return take_strings(raw, type, space);
  }
  if (H5Tget_class(stored.id()) == H5T_FLOAT && shape.size() == 1) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(shape[0]));
    if (values.size() > 0) read(H5T_NATIVE_DOUBLE, values.data());
    return values;
  }
  if (H5Tget_class(stored.id()) == H5T_FLOAT && shape.size() == 2) {
    RowMajor values(static_cast<Eigen::Index>(shape[0]), static_cast<Eigen::Index>(shape[1]));
    if (values.size() > 0) read(H5T_NATIVE_DOUBLE, values.data());
    return Eigen::MatrixXd(values);
  }
  fail(group.id(), name, "read the dataset", "it is neither numbers of rank 1 or 2 nor a list of strings");
}

}  // namespace opponens::storage::hdf5
