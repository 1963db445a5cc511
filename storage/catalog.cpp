// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/catalog.hpp"

#include <unistd.h>

#include <algorithm>
#include <set>
#include <unordered_map>

#include "core/require.hpp"

namespace opponens::storage {
namespace {

namespace fs = std::filesystem;

std::vector<IndexEntry> entries_of(const IndexBlock& block) {
  std::vector<IndexEntry> entries;
  for (std::size_t i = 0; i < block.size(); ++i) entries.push_back(block.entry(i));
  return entries;
}

/// The first eight bytes as a number of the same order.
std::uint64_t begin_of(std::string_view raw_id) {
  std::uint64_t value = 0;
  for (const char byte : raw_id.substr(0, 8)) value = value << 8U | static_cast<unsigned char>(byte);
  return value;
}

bool replace_file(const fs::path& path, const std::list<std::string_view>& pieces) {
  std::string bytes;
  for (const auto piece : pieces) bytes += piece;
  // Not flushed to disk: after a power cut it may be empty or old, which its sums and its list of files show.
  const fs::path temporary = path.parent_path() / (".tmp-index-" + std::to_string(::getpid()));
  std::error_code error;
  fs::remove(temporary, error);
  try {
    write_new_file(temporary, std::as_bytes(std::span(bytes)), Durable::no);
  } catch (const InputError&) {
    fs::remove(temporary, error);
    return false;
  }
  fs::rename(temporary, path, error);
  return !error;
}

bool append_to_file(const fs::path& path, const std::list<std::string_view>& pieces) {
  std::string bytes;
  for (const auto piece : pieces) bytes += piece;
  try {
    append_bytes(path, bytes);
  } catch (const InputError&) {
    return false;
  }
  return true;
}

}  // namespace

void Catalog::load(const fs::path& directory) {
  const std::optional<FileState> state = file_state(directory / kIndexName);
  if (state && state == state_) return;
  blocks_.clear();
  bytes_.clear();
  saved_.reset();
  keys_.clear();
  keyed_ = 0;
  state_ = state;
  if (!state) return;
  try {
    bytes_.push_back(read_file(directory / kIndexName));
  } catch (const InputError&) {
    return;  // it is rebuilt
  }
  ParsedIndex parsed = parse_index(bytes_.front());
  blocks_ = std::move(parsed.blocks);
  if (parsed.valid_bytes == state->size && bytes_.front().size() == state->size) saved_ = blocks_.size();
}

void Catalog::append(const std::string& file, const std::vector<IndexEntry>& entries) {
  bytes_.push_back(encode_index_block(file, entries));
  blocks_.push_back(parse_index(bytes_.back()).blocks.at(0));
}

Catalog::Changes Catalog::arrange(const std::vector<std::string>& files) {
  std::unordered_map<std::string_view, std::size_t> known;
  for (std::size_t i = 0; i < blocks_.size(); ++i) known.emplace(blocks_[i].file(), i);
  Changes changes;
  std::vector<IndexBlock> arranged;
  std::vector<bool> kept(blocks_.size(), false);
  bool same = true;
  for (const auto& file : files) {
    const auto found = known.find(file);
    if (found == known.end()) {
      changes.unknown.push_back(file);
      continue;
    }
    same = same && found->second == arranged.size();
    kept[found->second] = true;
    arranged.push_back(blocks_[found->second]);
  }
  if (same && arranged.size() == blocks_.size()) return changes;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const bool second = known.at(blocks_[i].file()) != i;
    if (!kept[i] && !second) changes.gone.push_back({std::string(blocks_[i].file()), entries_of(blocks_[i])});
  }
  blocks_ = std::move(arranged);
  saved_.reset();
  keys_.clear();
  keyed_ = 0;
  return changes;
}

bool Catalog::save(const fs::path& directory) {
  const fs::path path = directory / kIndexName;
  if (file_state(path) != state_) return false;
  if (saved_ == blocks_.size()) return true;
  std::list<std::string_view> pieces;
  for (std::size_t i = saved_.value_or(0); i < blocks_.size(); ++i) pieces.push_back(blocks_[i].bytes());
  const bool appending = saved_.has_value() && state_.has_value();
  saved_.reset();
  if (!(appending ? append_to_file(path, pieces) : replace_file(path, pieces))) return false;
  saved_ = blocks_.size();
  state_ = file_state(path);
  return true;
}

bool Catalog::before(const Key& a, const Key& b) const {
  if (a.begin != b.begin) return a.begin < b.begin;
  const int order = raw_id(a.place).compare(raw_id(b.place));
  return order != 0 ? order < 0 : a.place < b.place;
}

const std::vector<Catalog::Key>& Catalog::keys() const {
  if (keyed_ == blocks_.size()) return keys_;
  const auto sorted = static_cast<std::ptrdiff_t>(keys_.size());
  for (; keyed_ < blocks_.size(); ++keyed_) {
    for (std::size_t i = 0; i < blocks_[keyed_].size(); ++i) {
      keys_.push_back(
          {begin_of(blocks_[keyed_].raw_id(i)), {static_cast<std::uint32_t>(keyed_), static_cast<std::uint32_t>(i)}});
    }
  }
  const auto order = [this](const Key& a, const Key& b) { return before(a, b); };
  std::sort(keys_.begin() + sorted, keys_.end(), order);
  std::inplace_merge(keys_.begin(), keys_.begin() + sorted, keys_.end(), order);
  return keys_;
}

std::vector<IndexEntry> Catalog::list(const std::string& kind) const {
  std::set<Place> again;  // objects that an earlier file holds too
  const std::vector<Key>& sorted = keys();
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (raw_id(sorted[i].place) == raw_id(sorted[i - 1].place)) again.insert(sorted[i].place);
  }
  std::vector<IndexEntry> entries;
  for (std::uint32_t block = 0; block < blocks_.size(); ++block) {
    for (std::uint32_t position = 0; position < blocks_[block].size(); ++position) {
      if (!kind.empty() && blocks_[block].kind(position) != kind) continue;
      if (again.empty() || !again.contains({block, position})) entries.push_back(entry({block, position}));
    }
  }
  return entries;
}

std::vector<Catalog::Place> Catalog::find(const std::string& prefix) const {
  const std::vector<Key>& sorted = keys();
  auto key = std::lower_bound(sorted.begin(), sorted.end(), prefix, [this](const Key& a, const std::string& text) {
    return id_text(raw_id(a.place)) < text;
  });
  std::vector<Place> places;
  for (; key != sorted.end() && places.size() < 2 && id_text(raw_id(key->place)).starts_with(prefix); ++key) {
    if (places.empty() || raw_id(places.back()) != raw_id(key->place)) places.push_back(key->place);
  }
  return places;
}

std::vector<Catalog::Place> Catalog::copies(Place place) const {
  const std::string_view id = raw_id(place);
  const std::vector<Key>& sorted = keys();
  auto key = std::lower_bound(sorted.begin(), sorted.end(), id,
                              [this](const Key& a, std::string_view raw) { return raw_id(a.place) < raw; });
  std::vector<Place> places;
  for (; key != sorted.end() && raw_id(key->place) == id; ++key) places.push_back(key->place);
  return places;
}

std::optional<std::vector<IndexEntry>> Catalog::entries(const std::string& file) const {
  const auto block =
      std::find_if(blocks_.begin(), blocks_.end(), [&](const IndexBlock& known) { return known.file() == file; });
  return block == blocks_.end() ? std::nullopt : std::optional(entries_of(*block));
}

std::string Catalog::last_id() const {
  for (std::size_t block = blocks_.size(); block-- > 0;) {
    const std::size_t size = blocks_[block].size();
    if (size > 0) return id_text(blocks_[block].raw_id(size - 1));
  }
  return {};
}

}  // namespace opponens::storage
