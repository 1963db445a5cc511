// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <set>

#include "core/require.hpp"
#include "storage/hdf5_calls.hpp"
#include "storage/hdf5_wrappers.hpp"
#include "storage/readers/csv.hpp"
#include "storage/readers/table.hpp"

namespace opponens::storage {
namespace {

namespace fs = std::filesystem;
using hdf5::Handle;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// "obs/q:3" is column 3 of the dataset obs/q; without a number, its only column.
struct ColumnPath {
  std::string dataset;
  std::size_t column = 1;
  bool numbered = false;
};

ColumnPath parse_path(const std::string& name, const fs::path& file) {
  const std::size_t colon = name.rfind(':');
  if (colon == std::string::npos) return {name, 1, false};
  ColumnPath path{name.substr(0, colon), 0, true};
  const char* const end = name.data() + name.size();
  const auto [rest, error] = std::from_chars(name.data() + colon + 1, end, path.column);
  if (error != std::errc{} || rest != end || path.column == 0) {
    throw_input(file, 0, "column", name, "dataset:number, numbers from 1");
  }
  return path;
}

/// Whether numbers are stored as machines have them. HDF5 can describe others, and one flipped bit of a description
/// (the bias of an exponent, say) makes other numbers of the same bytes.
bool is_standard(hid_t type) {
  for (const hid_t standard :
       {H5T_IEEE_F64LE, H5T_IEEE_F64BE, H5T_IEEE_F32LE, H5T_IEEE_F32BE, H5T_STD_I8LE,  H5T_STD_U8LE,  H5T_STD_I8BE,
        H5T_STD_U8BE,   H5T_STD_I16LE,  H5T_STD_U16LE,  H5T_STD_I16BE,  H5T_STD_U16BE, H5T_STD_I32LE, H5T_STD_U32LE,
        H5T_STD_I32BE,  H5T_STD_U32BE,  H5T_STD_I64LE,  H5T_STD_U64LE,  H5T_STD_I64BE, H5T_STD_U64BE}) {
    if (H5Tequal(type, standard) > 0) return true;
  }
  return false;
}

/// Refuses a dataset of which the file does not hold every value: libhdf5 would give zeros for them, or the values of
/// another file.
class HeldValues {
 public:
  HeldValues(const Handle& group, const std::string& name, const Handle& dataset, std::size_t value_bytes)
      : group_(group),
        name_(name),
        dataset_(dataset),
        creation_(checked(H5Dget_create_plist(dataset.id())), H5Pclose),
        value_bytes_(value_bytes) {
    const Handle file(checked(H5Iget_file_id(dataset.id())), H5Fclose);
    const Handle file_creation(checked(H5Fget_create_plist(file.id())), H5Pclose);
    checked(H5Fget_filesize(file.id(), &file_bytes_));
    checked(H5Pget_userblock(file_creation.id(), &user_block_));
  }

  void require_all(const std::vector<hsize_t>& shape) const {
    if (checked(H5Pget_external_count(creation_.id())) > 0) refuse("its values are in other files");
    switch (H5Pget_layout(creation_.id())) {
      case H5D_COMPACT:
        return;
      case H5D_CONTIGUOUS:  // counts its address from the start of the file, chunks from behind the user block
        return require_inside(H5Dget_offset(dataset_.id()), H5Dget_storage_size(dataset_.id()), 0);
      case H5D_CHUNKED:
        return require_chunks(shape);
      default:
        refuse("its values are in other datasets");
    }
  }

 private:
  template <typename T>
  T checked(T result) const {
    return hdf5::checked(result, group_.id(), name_, "read the layout");
  }
  [[noreturn]] void refuse(const std::string& why) const { hdf5::fail(group_.id(), name_, "read the dataset", why); }

  void require_inside(haddr_t address, hsize_t size, hsize_t base) const {
    if (address == HADDR_UNDEF) refuse("values were never written");
    if (size > file_bytes_ || base > file_bytes_ - size || address > file_bytes_ - size - base) {
      refuse("values lie beyond the end of the file");
    }
  }

  void require_chunks(const std::vector<hsize_t>& shape) const {
    std::vector<hsize_t> chunk(shape.size());
    checked(H5Pget_chunk(creation_.id(), static_cast<int>(chunk.size()), chunk.data()));
    const std::vector<hsize_t> all{shape[0], shape.size() == 2 ? shape[1] : 1};
    const std::vector<hsize_t> step{chunk[0], shape.size() == 2 ? chunk[1] : 1};
    // libhdf5 1.10 looks through all chunks to find one.
    constexpr hsize_t kMostChunks = 10000;
    if (((all[0] - 1) / step[0] + 1) * ((all[1] - 1) / step[1] + 1) > kMostChunks) {
      refuse("it has more than 10000 chunks (h5repack makes larger ones)");
    }
    for (hsize_t row = 0; row < all[0]; row += step[0]) {
      for (hsize_t column = 0; column < all[1]; column += step[1]) {
        const std::array<hsize_t, 2> place{row, column};
        unsigned skipped = 0;
        haddr_t address = HADDR_UNDEF;
        hsize_t size = 0;
        checked(H5Dget_chunk_info_by_coord(dataset_.id(), place.data(), &skipped, &address, &size));
        require_inside(address, size, user_block_);
        require_filters(skipped, size >= step[0] * step[1] * value_bytes_);
      }
    }
  }

  /// What a chunk says it went without: compression, when that would not have made it smaller; no check sum.
  void require_filters(unsigned skipped, bool full_size) const {
    for (unsigned i = 0; skipped >> i != 0; ++i) {
      if ((skipped >> i & 1U) == 0) continue;
      unsigned flags = 0;
      std::size_t parameters = 0;
      const H5Z_filter_t filter = H5Pget_filter2(creation_.id(), i, &flags, &parameters, nullptr, 0, nullptr, nullptr);
      if (filter != H5Z_FILTER_DEFLATE || !full_size) refuse("values were stored without one of its filters");
    }
  }

  const Handle& group_;
  const std::string& name_;
  const Handle& dataset_;
  Handle creation_;
  std::size_t value_bytes_;
  hsize_t file_bytes_ = 0;
  hsize_t user_block_ = 0;
};

/// A dataset of numbers of rank 1 or 2 as doubles.
RowMajor read_numbers(const Handle& group, const std::string& name) {
  const Handle dataset(
      hdf5::checked(H5Dopen2(group.id(), name.c_str(), H5P_DEFAULT), group.id(), name, "open the dataset"), H5Dclose);
  const Handle type(hdf5::checked(H5Dget_type(dataset.id()), group.id(), name, "read the type"), H5Tclose);
  const Handle space(hdf5::checked(H5Dget_space(dataset.id()), group.id(), name, "read the shape"), H5Sclose);
  const auto shape = hdf5::shape_of(space, group.id(), name);
  if (!is_standard(type.id()) || shape.empty() || shape.size() > 2) {
    hdf5::fail(group.id(), name, "read the dataset", "it is not IEEE floats or integers of rank 1 or 2");
  }
  const std::uint64_t columns = shape.size() == 2 ? shape[1] : 1;
  constexpr std::uint64_t kMost = std::uint64_t{1} << 28;
  if (shape[0] > kMost || columns > kMost || shape[0] * columns > kMost) {
    hdf5::fail(group.id(), name, "read the dataset", "it has more than 268 million numbers");
  }
  RowMajor values = RowMajor::Constant(static_cast<Eigen::Index>(shape[0]), static_cast<Eigen::Index>(columns),
                                       std::numeric_limits<double>::quiet_NaN());
  if (values.size() == 0) return values;
  HeldValues(group, name, dataset, H5Tget_size(type.id())).require_all(shape);
  hdf5::checked(H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), group.id(),
                name, "read the dataset");
  return values;
}

Table read_group(const Handle& group, const fs::path& file, const SourceDescription& source) {
  std::map<std::string, RowMajor> datasets;
  std::vector<std::string> names = source.time.columns;
  for (const auto& channel : source.channels) names.push_back(channel.column);
  std::vector<Eigen::VectorXd> columns;
  for (const auto& name : names) {
    const ColumnPath path = parse_path(name, file);
    auto found = datasets.find(path.dataset);
    if (found == datasets.end()) found = datasets.emplace(path.dataset, read_numbers(group, path.dataset)).first;
    const RowMajor& values = found->second;
    const auto width = static_cast<std::size_t>(values.cols());
    if (path.column > width || (!path.numbered && width != 1)) {
      throw_input(file, 0, "column", name, "one of the " + std::to_string(width) + " columns of the dataset");
    }
    columns.emplace_back(values.col(static_cast<Eigen::Index>(path.column - 1)));
    if (columns.back().size() != columns.front().size()) {
      throw_input(file, 0, "number of rows of '" + name + "'", std::to_string(columns.back().size()),
                  std::to_string(columns.front().size()) + " as in '" + names.front() + "'");
    }
  }
  Table table;
  table.width = columns.size();
  for (Eigen::Index row = 0; row < columns.front().size(); ++row) {
    for (const auto& column : columns) table.values.push_back(column(row));
  }
  return table;
}

std::string as_text(const Field& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* number = std::get_if<std::int64_t>(&value)) return std::to_string(*number);
  return {};
}

/// Attributes that labels ask for; others may be of any kind.
void add_attributes(const Handle& group, const SourceDescription& source, Table& table) {
  const std::vector<std::string> there = hdf5::attributes(group);
  for (const auto& [label, fact] : source.labels) {
    if (!std::binary_search(there.begin(), there.end(), fact)) continue;
    const std::string text = as_text(hdf5::read_attribute(group, fact));
    if (!text.empty()) table.facts[fact] = text;
  }
}

}  // namespace

std::vector<Table> read_hdf5_tables(const fs::path& file, const SourceDescription& source) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  // A recording is what its own file holds. This process ends with the reading, so nobody else misses such links.
  H5Lunregister(H5L_TYPE_EXTERNAL);
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (opened < 0) throw InputError(file.string() + ": not an intact HDF5 file: " + hdf5::reason());
  const Handle root(opened, H5Fclose);
  std::vector<Table> tables;
  if (source.table.group.empty()) {
    tables.push_back(read_group(root, file, source));
    add_attributes(root, source, tables.back());
    return tables;
  }
  const Handle parent = hdf5::open_group(root, source.table.group);
  for (const auto& name : hdf5::links(parent)) {
    const Handle group = hdf5::open_group(parent, name);
    tables.push_back(read_group(group, file, source));
    tables.back().part = name;
    tables.back().facts["group"] = name;
    add_attributes(group, source, tables.back());
  }
  if (tables.empty()) throw_input(file, 0, "number of groups in " + source.table.group, "0", "one per recording");
  return tables;
}

}  // namespace opponens::storage
