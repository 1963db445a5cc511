// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "storage/store.hpp"

namespace opponens::storage {

using Bytes = std::span<const std::byte>;

/// Takes values off the front of untrusted bytes.
class Cursor {
 public:
  explicit Cursor(Bytes bytes) : bytes_(bytes) {}
  std::size_t position() const { return position_; }
  bool at_end() const { return position_ == bytes_.size(); }
  Bytes take(std::uint64_t count) {
    if (count > bytes_.size() - position_) throw StorageError("its part of the contents ends too early");
    const Bytes taken = bytes_.subspan(position_, static_cast<std::size_t>(count));
    position_ += taken.size();
    return taken;
  }
  std::uint64_t number() {
    std::uint64_t value = 0;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::string text() {
    const Bytes bytes = take(number());
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  /// A count of things that take eight bytes each at least.
  std::uint64_t count() {
    const std::uint64_t value = number();
    if (value > (bytes_.size() - position_) / 8) throw StorageError("its part of the contents has an impossible count");
    return value;
  }
  std::vector<std::string> texts() {
    std::vector<std::string> values(static_cast<std::size_t>(count()));
    for (auto& value : values) value = text();
    return values;
  }

 private:
  Bytes bytes_;
  std::size_t position_ = 0;
};

}  // namespace opponens::storage
