// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <hdf5.h>

#include <algorithm>

#include "storage/hdf5_calls.hpp"

namespace opponens::storage::hdf5 {
namespace {

void write_raw_attribute(const Handle& object, const std::string& name, hid_t type, const void* data) {
  static const Handle creation = utf8_names(H5P_ATTRIBUTE_CREATE);
  static const Handle space(checked(H5Screate(H5S_SCALAR), -1, "", "make a dataspace"), H5Sclose);
  const Handle attribute(checked(H5Acreate2(object.id(), name.c_str(), type, space.id(), creation.id(), H5P_DEFAULT),
                                 object.id(), name, "create the attribute"),
                         H5Aclose);
  checked(H5Awrite(attribute.id(), type, data), object.id(), name, "write the attribute");
}

Handle open_attribute(const Handle& object, const std::string& name) {
  return {checked(H5Aopen(object.id(), name.c_str(), H5P_DEFAULT), object.id(), name, "open the attribute"), H5Aclose};
}

template <typename T>
T attribute_number(const Handle& object, const std::string& name, H5T_class_t kind, hid_t type) {
  const Handle attribute = open_attribute(object, name);
  const Handle stored(checked(H5Aget_type(attribute.id()), object.id(), name, "read the type"), H5Tclose);
  const Handle space(checked(H5Aget_space(attribute.id()), object.id(), name, "read the shape"), H5Sclose);
  if (H5Tget_class(stored.id()) != kind || !shape_of(space, object.id(), name).empty()) {
    fail(object.id(), name, "read the attribute", "it is not a single number of the expected type");
  }
  T value{};
  checked(H5Aread(attribute.id(), type, &value), object.id(), name, "read the attribute");
  return value;
}

}  // namespace

std::vector<std::string> attributes(const Handle& object) {
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5A_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  checked(H5Aiterate2(object.id(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, collect, &names), object.id(), "",
          "list the attributes");
  std::sort(names.begin(), names.end());
  return names;
}

void write_attribute(const Handle& object, const std::string& name, double value) {
  write_raw_attribute(object, name, H5T_IEEE_F64LE, &value);
}
void write_attribute(const Handle& object, const std::string& name, std::int64_t value) {
  write_raw_attribute(object, name, H5T_STD_I64LE, &value);
}
void write_attribute(const Handle& object, const std::string& name, std::uint64_t value) {
  write_raw_attribute(object, name, H5T_STD_U64LE, &value);
}
void write_attribute(const Handle& object, const std::string& name, const std::string& value) {
  const char* text = value.c_str();
  static const Handle type = string_type();
  write_raw_attribute(object, name, type.id(), static_cast<const void*>(&text));
}

Field read_attribute(const Handle& object, const std::string& name) {
  const Handle attribute = open_attribute(object, name);
  const Handle type(checked(H5Aget_type(attribute.id()), object.id(), name, "read the type"), H5Tclose);
  switch (H5Tget_class(type.id())) {
    case H5T_FLOAT:
      return attribute_number<double>(object, name, H5T_FLOAT, H5T_NATIVE_DOUBLE);
    case H5T_INTEGER:
      return read_integer(object, name);
    default:
      return read_string(object, name);
  }
}

std::int64_t read_integer(const Handle& object, const std::string& name) {
  return attribute_number<std::int64_t>(object, name, H5T_INTEGER, H5T_NATIVE_INT64);
}
std::uint64_t read_unsigned(const Handle& object, const std::string& name) {
  return attribute_number<std::uint64_t>(object, name, H5T_INTEGER, H5T_NATIVE_UINT64);
}
std::string read_string(const Handle& object, const std::string& name) {
  const Handle attribute = open_attribute(object, name);
  const Handle stored(checked(H5Aget_type(attribute.id()), object.id(), name, "read the type"), H5Tclose);
  const Handle space(checked(H5Aget_space(attribute.id()), object.id(), name, "read the shape"), H5Sclose);
  if (!is_text(stored.id()) || !shape_of(space, object.id(), name).empty()) {
    fail(object.id(), name, "read the attribute", "it is not a text");
  }
  const Handle type = string_type();
  std::vector<char*> raw(1, nullptr);
  checked(H5Aread(attribute.id(), type.id(), raw.data()), object.id(), name, "read the attribute");
  return take_strings(raw, type, space).front();
}

}  // namespace opponens::storage::hdf5
