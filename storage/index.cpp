// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/index.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>
#include <unordered_map>

namespace opponens::storage {
namespace {

constexpr std::string_view kMagic = "OPINDEX1";
constexpr std::size_t kHeader = 48;  // magic, size, sum, then six numbers of 32 bits
constexpr std::size_t kSummedFrom = 24;
constexpr std::size_t kIdBytes = 32;
constexpr std::size_t kEntryBytes = 16;
constexpr std::uint64_t kPrime = 0x9E3779B97F4A7C15;

std::uint64_t load64(std::string_view bytes, std::size_t offset) {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// Four interleaved lanes of multiply and rotate: every step is one-to-one in the lane and in the word, so a changed
/// word changes its lane for good. bytes: a multiple of 8 of them. Not against an adversary: ids and content hashes
/// are.
std::uint64_t sum_of(std::string_view bytes) {
  std::array<std::uint64_t, 4> lanes{1, 2, 3, bytes.size()};
  for (std::size_t at = 0; at < bytes.size(); at += 8) {
    std::uint64_t& lane = lanes[(at / 8) % 4];
    lane = std::rotl(lane ^ load64(bytes, at), 29) * kPrime;
  }
  std::uint64_t sum = 0;
  for (const std::uint64_t lane : lanes) sum = std::rotl(sum ^ lane, 31) * kPrime;
  return sum;
}

int digit_value(char digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  return digit >= 'a' && digit <= 'f' ? digit - 'a' + 10 : -1;
}

std::string raw_id(const std::string& id) {
  std::string raw;
  for (std::size_t i = 0; i + 1 < id.size(); i += 2) {
    const int high = digit_value(id[i]);
    const int low = digit_value(id[i + 1]);
    if (high < 0 || low < 0) break;
    raw += static_cast<char>(high * 16 + low);
  }
  if (raw.size() != kIdBytes || id.size() != 2 * kIdBytes) {
    throw StorageError("'" + id + "' is not an id: 64 hex digits are expected");
  }
  return raw;
}

/// Numbers of 32 bits, and texts of which each is kept once.
class BlockWriter {
 public:
  std::uint32_t text(const std::string& value) {
    const auto [place, added] = numbers_.try_emplace(value, static_cast<std::uint32_t>(ends_.size()));
    if (added) {
      texts_ += value;
      ends_.push_back(narrow(texts_.size()));
    }
    return place->second;
  }
  static std::uint32_t narrow(std::size_t value) {
    if (value > std::numeric_limits<std::uint32_t>::max()) throw StorageError("a batch is too large for the index");
    return static_cast<std::uint32_t>(value);
  }
  const std::vector<std::uint32_t>& ends() const { return ends_; }
  const std::string& texts() const { return texts_; }

 private:
  std::unordered_map<std::string, std::uint32_t> numbers_;
  std::vector<std::uint32_t> ends_;
  std::string texts_;
};

void append(std::string& bytes, const std::vector<std::uint32_t>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(std::uint32_t));
}

}  // namespace

/// Tries to read a block at the front of bytes.
struct BlockParser {
  std::string_view bytes;

  std::optional<IndexBlock> block() const {
    if (bytes.size() < kHeader || !bytes.starts_with(kMagic)) return std::nullopt;
    const std::uint64_t size = load64(bytes, 8);
    if (size < kHeader || size % 8 != 0 || size > bytes.size()) return std::nullopt;
    IndexBlock block;
    block.bytes_ = bytes.substr(0, static_cast<std::size_t>(size));
    if (load64(bytes, 16) != sum_of(block.bytes_.substr(kSummedFrom))) return std::nullopt;
    return holds_together(block) ? std::optional(block) : std::nullopt;
  }

 private:
  static bool holds_together(IndexBlock& block) {
    block.count_ = block.load(24);
    block.file_ = block.load(28);
    const std::uint64_t inputs = block.load(32);
    const std::uint64_t texts = block.load(36);
    const std::uint64_t text_bytes = block.load(40);
    const std::uint64_t count = block.count_;
    // None of these sums of products of 32-bit numbers can overflow.
    const std::uint64_t entries_at = kHeader + count * kIdBytes;
    const std::uint64_t inputs_at = entries_at + count * kEntryBytes;
    const std::uint64_t ends_at = inputs_at + inputs * 4;
    const std::uint64_t texts_at = ends_at + texts * 4;
    const std::uint64_t end = texts_at + text_bytes;
    if (end > block.bytes_.size() || block.bytes_.size() - end >= 8) return false;
    block.entries_ = static_cast<std::size_t>(entries_at);
    block.inputs_ = static_cast<std::size_t>(inputs_at);
    block.text_ends_ = static_cast<std::size_t>(ends_at);
    block.texts_ = static_cast<std::size_t>(texts_at);
    std::uint32_t last = 0;
    for (std::size_t i = 0; i < texts; ++i) {
      const std::uint32_t text_end = block.load(block.text_ends_ + 4 * i);
      if (text_end < last || text_end > text_bytes) return false;
      last = text_end;
    }
    for (std::size_t i = 0; i < inputs; ++i) {
      if (block.load(block.inputs_ + 4 * i) >= texts) return false;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (block.number(i, 0) >= texts || block.number(i, 1) >= texts) return false;
      if (std::uint64_t{block.number(i, 2)} + block.number(i, 3) > inputs) return false;
    }
    return block.file_ < texts;
  }
};

std::uint32_t IndexBlock::load(std::size_t offset) const {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes_.data() + offset, sizeof value);
  return value;
}

std::uint32_t IndexBlock::number(std::size_t position, std::size_t which) const {
  return load(entries_ + position * kEntryBytes + 4 * which);
}

std::string_view IndexBlock::text(std::uint32_t which) const {
  const std::size_t begin = which == 0 ? 0 : load(text_ends_ + 4 * (std::size_t{which} - 1));
  return bytes_.substr(texts_ + begin, load(text_ends_ + 4 * std::size_t{which}) - begin);
}

std::string_view IndexBlock::raw_id(std::size_t position) const {
  return bytes_.substr(kHeader + position * kIdBytes, kIdBytes);
}

IndexEntry IndexBlock::entry(std::size_t position) const {
  IndexEntry entry{id_text(raw_id(position)),
                   std::string(kind(position)),
                   std::string(text(number(position, 1))),
                   std::string(file()),
                   {}};
  const std::size_t first = number(position, 2);
  for (std::size_t i = 0; i < number(position, 3); ++i) {
    entry.inputs.emplace_back(text(load(inputs_ + 4 * (first + i))));
  }
  return entry;
}

ParsedIndex parse_index(std::string_view bytes) {
  ParsedIndex parsed;
  while (const auto block = BlockParser{bytes.substr(parsed.valid_bytes)}.block()) {
    parsed.blocks.push_back(*block);
    parsed.valid_bytes += block->bytes().size();
  }
  return parsed;
}

std::string encode_index_block(const std::string& file, const std::vector<IndexEntry>& entries) {
  BlockWriter writer;
  std::string ids;
  std::vector<std::uint32_t> numbers;
  std::vector<std::uint32_t> inputs;
  const std::uint32_t file_text = writer.text(file);
  for (const auto& entry : entries) {
    ids += raw_id(entry.id);
    numbers.insert(numbers.end(), {writer.text(entry.kind), writer.text(entry.name), BlockWriter::narrow(inputs.size()),
                                   BlockWriter::narrow(entry.inputs.size())});
    for (const auto& input : entry.inputs) inputs.push_back(writer.text(input));
  }
  std::string bytes(kSummedFrom, '\0');
  append(bytes, {BlockWriter::narrow(entries.size()), file_text, BlockWriter::narrow(inputs.size()),
                 BlockWriter::narrow(writer.ends().size()), BlockWriter::narrow(writer.texts().size()), 0});
  bytes += ids;
  append(bytes, numbers);
  append(bytes, inputs);
  append(bytes, writer.ends());
  bytes += writer.texts();
  seal_index_block(bytes);
  return bytes;
}

void seal_index_block(std::string& bytes) {
  bytes.resize(std::max(kHeader, (bytes.size() + 7) / 8 * 8), '\0');
  const std::uint64_t size = bytes.size();
  const std::uint64_t sum = sum_of(std::string_view(bytes).substr(kSummedFrom));
  std::memcpy(bytes.data(), kMagic.data(), kMagic.size());
  std::memcpy(bytes.data() + 8, &size, sizeof size);
  std::memcpy(bytes.data() + 16, &sum, sizeof sum);
}

std::string id_text(std::string_view raw_id) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  text.reserve(2 * raw_id.size());
  for (const char byte : raw_id) {
    text += kDigits[static_cast<unsigned char>(byte) >> 4U];
    text += kDigits[static_cast<unsigned char>(byte) & 15U];
  }
  return text;
}

}  // namespace opponens::storage
