// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/readers/mat_layout.hpp"

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include "core/require.hpp"

namespace opponens::storage {
namespace {

// Data types and array classes of the format.
enum Type : std::uint32_t { miINT8 = 1, miINT32 = 5, miUINT32 = 6, miMATRIX = 14, miCOMPRESSED = 15 };
constexpr std::uint32_t kCell = 1;
constexpr std::uint32_t kFirstNumeric = 6;  // double, single, int8 ... uint64
constexpr std::uint32_t kLastNumeric = 15;
constexpr std::uint32_t kComplex = 0x0800;
constexpr std::size_t kFileHeader = 128;
constexpr std::size_t kMostInflated = std::size_t{1} << 30;
constexpr int kDeepest = 4;  // cells in cells

/// B per value of a data type; 0 for what is not a number.
std::uint64_t size_of(std::uint32_t type) {
  switch (type) {
    case 1:  // int8
    case 2:
      return 1;
    case 3:  // int16
    case 4:
      return 2;
    case 5:  // int32
    case 6:
    case 7:  // single
      return 4;
    case 9:   // double
    case 12:  // int64
    case 13:
      return 8;
    default:
      return 0;
  }
}

struct Element {
  std::uint32_t type = 0;
  std::string_view data;
};

/// Takes element after element off a piece of the file.
class Walker {
 public:
  Walker(std::string_view bytes, const std::filesystem::path& file, std::size_t begin)
      : bytes_(bytes), file_(file), begin_(begin) {}

  bool empty() const { return at_ == bytes_.size(); }

  Element next() {
    expect(bytes_.size() - at_ >= 8, "the file ends inside an element");
    std::uint32_t type = word(at_);
    std::uint64_t size = word(at_ + 4);
    std::size_t data = at_ + 8;
    if (type >> 16 != 0) {  // up to four bytes, packed into the tag
      size = type >> 16;
      type &= 0xFFFF;
      data = at_ + 4;
      expect(size <= 4, "a small element of more than 4 bytes");
    }
    expect(size <= bytes_.size() - data, "an element is longer than what holds it");
    const Element element{type, bytes_.substr(data, size)};
    std::uint64_t end = data + size;
    if (data != at_ + 8) {
      end = at_ + 8;
    } else if (type != miCOMPRESSED) {
      end = std::min<std::uint64_t>((end + 7) / 8 * 8, bytes_.size());
    }
    at_ = end;
    return element;
  }

  void expect(bool condition, const std::string& complaint) const {
    if (condition) return;
    throw InputError(file_.string() + ": not an intact MATLAB v5 file: " + complaint + ", near byte " +
                     std::to_string(begin_ + at_));
  }
  Walker inside(const Element& element) const { return {element.data, file_, begin_ + at_ - element.data.size()}; }

 private:
  std::uint32_t word(std::size_t at) const {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes_.data() + at, sizeof value);
    return value;
  }

  std::string_view bytes_;
  const std::filesystem::path& file_;
  std::size_t begin_;
  std::size_t at_ = 0;
};

struct ArrayHead {
  std::uint32_t flags = 0;
  std::uint64_t count = 1;  // product of the dimensions
  std::string name;
};

ArrayHead read_head(Walker& walker) {
  ArrayHead head;
  const Element flags = walker.next();
  walker.expect(flags.type == miUINT32 && flags.data.size() == 8, "no flags at the start of an array");
  std::memcpy(&head.flags, flags.data.data(), sizeof head.flags);
  const Element dimensions = walker.next();
  const std::size_t rank = dimensions.data.size() / 4;
  walker.expect(dimensions.type == miINT32 && dimensions.data.size() % 4 == 0 && rank >= 2 && rank <= 8,
                "no dimensions of an array");
  for (std::size_t i = 0; i < rank; ++i) {
    std::int32_t size = 0;
    std::memcpy(&size, dimensions.data.data() + 4 * i, sizeof size);
    walker.expect(size >= 0 && size <= (1 << 30) && head.count <= (std::uint64_t{1} << 31), "an impossible dimension");
    head.count *= static_cast<std::uint64_t>(size);
  }
  const Element name = walker.next();
  walker.expect(name.type == miINT8, "no name of an array");
  head.name = std::string(name.data);
  return head;
}

void check_values(Walker& walker, const ArrayHead& head, int depth) {
  const std::uint32_t kind = head.flags & 0xFF;
  walker.expect((head.flags & kComplex) == 0, "complex numbers (expected real ones)");
  if (kind == kCell) {
    walker.expect(depth < kDeepest, "cells in cells in cells");
    for (std::uint64_t i = 0; i < head.count; ++i) {
      const Element cell = walker.next();
      walker.expect(cell.type == miMATRIX, "a cell that is not an array");
      Walker inner = walker.inside(cell);
      const ArrayHead inner_head = read_head(inner);
      check_values(inner, inner_head, depth + 1);
    }
  } else {
    walker.expect(kind >= kFirstNumeric && kind <= kLastNumeric, "an array that is neither numbers nor cells");
    const Element values = walker.next();
    walker.expect(size_of(values.type) > 0 && values.data.size() == head.count * size_of(values.type),
                  "an array of another size than its dimensions say");
  }
  walker.expect(walker.empty(), "more data than an array needs");
}

std::string inflated(const Walker& walker, std::string_view data) {
  z_stream stream{};
  walker.expect(inflateInit(&stream) == Z_OK, "cannot start zlib");
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
  stream.avail_in = static_cast<uInt>(data.size());
  std::string bytes;
  std::vector<char> chunk(1 << 18);
  int state = Z_OK;
  while (state == Z_OK && bytes.size() <= kMostInflated) {
    stream.next_out = reinterpret_cast<Bytef*>(chunk.data());
    stream.avail_out = static_cast<uInt>(chunk.size());
    state = inflate(&stream, Z_NO_FLUSH);
    bytes.append(chunk.data(), chunk.size() - stream.avail_out);
  }
  const bool all = stream.avail_in == 0;
  inflateEnd(&stream);
  walker.expect(bytes.size() <= kMostInflated, "more than 1 GB of compressed data");
  walker.expect(state == Z_STREAM_END && all, "damaged compressed data");
  return bytes;
}

/// Whether this is the variable; if so, checks it.
bool check_array(Walker& walker, const Element& element, const std::string& variable) {
  walker.expect(element.type == miMATRIX, "an element that is not an array");
  Walker inner = walker.inside(element);
  const ArrayHead head = read_head(inner);
  if (head.name != variable) return false;
  check_values(inner, head, 0);
  return true;
}

}  // namespace

void check_mat_layout(std::string_view bytes, const std::string& variable, const std::filesystem::path& file) {
  Walker walker(bytes.substr(std::min(kFileHeader, bytes.size())), file, kFileHeader);
  walker.expect(bytes.size() > kFileHeader, "it has no header of 128 bytes");
  walker.expect(bytes.substr(124, 4) == std::string_view("\x00\x01IM", 4),
                "the header does not say version 1, little-endian (version 7.3 is HDF5; save with -v7)");
  int found = 0;
  while (!walker.empty()) {
    const Element element = walker.next();
    if (element.type != miCOMPRESSED) {
      found += check_array(walker, element, variable) ? 1 : 0;
      continue;
    }
    const std::string plain = inflated(walker, element.data);
    Walker inner(plain, file, kFileHeader);
    const Element array = inner.next();
    found += check_array(inner, array, variable) ? 1 : 0;
    inner.expect(inner.empty(), "more than one array in a compressed element");
  }
  walker.expect(found == 1, "variable '" + variable + "' is there " + std::to_string(found) + " times (expected once)");
}

}  // namespace opponens::storage
