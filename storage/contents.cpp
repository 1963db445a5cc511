// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/contents.hpp"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstring>
#include <map>
#include <string_view>

#include "storage/batch_file.hpp"
#include "storage/canonical.hpp"
#include "storage/cursor.hpp"
#include "storage/sha256.hpp"
#include "storage/store.hpp"

namespace opponens::storage {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::string_view kPartMarker = "opponens object\n";      // 16 bytes before each part
constexpr std::string_view kTrailerMarker = "opponens contents1";  // the last 18 bytes; the last one is the schema
constexpr std::size_t kTrailerBytes = 16 + kTrailerMarker.size();

Bytes bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

struct ContentsSink {
  std::vector<std::byte>& file;
  const ArrayOffsets& arrays;
  std::size_t next = 0;
  void bytes(Bytes bytes) { file.insert(file.end(), bytes.begin(), bytes.end()); }
  void place() { bytes(std::as_bytes(std::span(&arrays.at(next++), 1))); }
  void vector(const Eigen::VectorXd&) { place(); }
  void matrix(const Eigen::MatrixXd&) { place(); }
};

/// Made without going through rows that hold nothing, of which there may be very many.
Field empty_matrix(std::uint64_t rows, std::uint64_t columns) {
  return Eigen::MatrixXd(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
}

/// Decodes an object and takes its hash of the very bytes it decodes.
class Decoder {
 public:
  Decoder(const ReadOnlyFile& file, Bytes skeleton) : file_(file), skeleton_(skeleton), cursor_(skeleton) {}

  Record record() {
    Record record;
    if (cursor_.text() != "opponens record 1") throw StorageError("its part of the contents does not begin as one");
    record.kind = cursor_.text();
    record.name = cursor_.text();
    Provenance& origin = record.provenance;
    origin.command = cursor_.text();
    origin.inputs = cursor_.texts();
    for (std::uint64_t files = cursor_.count(); files > 0; --files) {
      std::string name = next_name(origin.files);
      origin.files.emplace_hint(origin.files.end(), std::move(name), cursor_.text());
    }
    origin.parameters = cursor_.text();
    origin.seed = cursor_.number();
    origin.program_version = cursor_.text();
    for (std::uint64_t fields = cursor_.count(); fields > 0; --fields) {
      std::string name = next_name(record.fields);
      record.fields.emplace_hint(record.fields.end(), std::move(name), field());
    }
    if (!cursor_.at_end()) throw StorageError("its part of the contents is too long");
    hash_up_to(cursor_.position());
    return record;
  }
  std::string hash() { return hash_.hex(); }

 private:
  void hash_up_to(std::size_t end) {
    hash_.update(skeleton_.subspan(hashed_, end - hashed_));
    hashed_ = end;
  }

  /// One form of bytes for one record: otherwise several ids would name what is read as the same.
  template <typename Value>
  std::string next_name(const std::map<std::string, Value>& before) {
    std::string name = cursor_.text();
    if (before.empty() || before.rbegin()->first < name) return name;
    throw StorageError("its part of the contents is not in order of name");
  }

  Field field() {
    switch (cursor_.number()) {
      case 0:
        return std::bit_cast<double>(cursor_.number());
      case 1:
        return static_cast<std::int64_t>(cursor_.number());
      case 2:
        return cursor_.text();
      case 3:
        return cursor_.texts();
      case kVectorType: {
        const std::uint64_t size = cursor_.number();
        const std::span<double> values = array(size, 1);
        return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(size)));
      }
      case kMatrixType: {
        const std::uint64_t rows = cursor_.number();
        const std::uint64_t columns = cursor_.number();
        const std::span<double> values = array(rows, columns);
        if (values.empty()) return empty_matrix(rows, columns);
        return Eigen::MatrixXd(Eigen::Map<const RowMajor>(values.data(), static_cast<Eigen::Index>(rows),
                                                          static_cast<Eigen::Index>(columns)));
      }
      default:
        throw StorageError("its part of the contents has a field of an unknown type");
    }
  }

  /// The values, whose place in the file comes next in the skeleton; valid until the next array is read.
  std::span<double> array(std::uint64_t rows, std::uint64_t columns) {
    const std::uint64_t most = file_.size() / sizeof(double);
    const bool fits = columns == 0 || rows == 0 || (rows <= most && columns <= most / rows);
    constexpr std::uint64_t kLargestIndex = 1ULL << 40U;  // also a side without values has to be an Eigen::Index
    if (!fits || rows > kLargestIndex || columns > kLargestIndex)
      throw StorageError("an array is larger than the file");
    taken_ += rows * columns;  // arrays do not overlap, so that a small file cannot ask for a large memory
    if (taken_ > most) throw StorageError("its arrays together are larger than the file");
    hash_up_to(cursor_.position());
    const std::uint64_t place = cursor_.number();
    hashed_ = cursor_.position();  // the place is not part of the hash
    values_.resize(static_cast<std::size_t>(rows * columns));
    const auto bytes = std::as_writable_bytes(std::span(values_));
    if (!bytes.empty() && !file_.read_at(place, bytes)) throw StorageError("an array lies beyond the end of the file");
    hash_.update(bytes);
    return values_;
  }

  const ReadOnlyFile& file_;
  Bytes skeleton_;
  Cursor cursor_;
  Sha256 hash_;
  std::size_t hashed_ = 0;
  std::uint64_t taken_ = 0;  // values of all arrays so far
  std::vector<double> values_;
};

/// The id that a part begins with, and what follows it.
std::pair<std::string, Bytes> open_part(Bytes part) {
  Cursor cursor(part);
  const Bytes marker = cursor.take(kPartMarker.size());
  if (std::memcmp(marker.data(), kPartMarker.data(), marker.size()) != 0) {
    throw StorageError("its part of the contents is damaged");
  }
  std::string id = cursor.text();
  const Bytes skeleton = cursor.take(cursor.number());
  if (!cursor.at_end()) throw StorageError("its part of the contents is too long");
  return {std::move(id), skeleton};
}

std::string place_of(const ReadOnlyFile& file, std::size_t position) {
  char slot[40];
  std::snprintf(slot, sizeof slot, ": /objects/%06zu", position);
  return file.path().string() + slot;
}

/// marker is not ours; it may be that of another schema.
void require_known_schema(const ReadOnlyFile& file, std::string_view marker) {
  const char digit = marker.back();
  if (marker.substr(0, marker.size() - 1) != kTrailerMarker.substr(0, marker.size() - 1)) return;
  if (digit < '0' || digit > '9') return;
  throw NewerSchemaError(file.path().string() + ": its contents are of schema version " + digit +
                         ", but this program knows version 1; use a newer opponens to read it");
}

}  // namespace

void ContentsBuilder::add(const Record& record, const std::string& id, const ArrayOffsets& arrays) {
  starts_.push_back(parts_.size());
  ContentsSink sink{parts_, arrays};
  Canonical<ContentsSink> canonical(sink);
  sink.bytes(bytes_of(kPartMarker));
  canonical.text(id);
  const std::size_t length_at = parts_.size();
  canonical.number(0);
  canonical.record(record);
  const std::uint64_t length = parts_.size() - length_at - sizeof(std::uint64_t);
  std::memcpy(parts_.data() + length_at, &length, sizeof length);
}

std::vector<std::byte> ContentsBuilder::finish(std::uint64_t hdf5_bytes) {
  const std::uint64_t count = starts_.size();
  starts_.push_back(parts_.size());
  for (auto& start : starts_) start += hdf5_bytes;
  const ArrayOffsets none;
  ContentsSink sink{parts_, none};
  sink.bytes(std::as_bytes(std::span(starts_)));
  Canonical<ContentsSink>(sink).number(count);
  Canonical<ContentsSink>(sink).number(starts_.back());
  sink.bytes(bytes_of(kTrailerMarker));
  return std::move(parts_);
}

std::optional<ContentsReader> ContentsReader::open(const ReadOnlyFile& file) {
  std::vector<std::byte> trailer(kTrailerBytes);
  if (file.size() < kTrailerBytes || !file.read_at(file.size() - kTrailerBytes, trailer)) return std::nullopt;
  const std::string_view marker(reinterpret_cast<const char*>(trailer.data()) + 16, kTrailerMarker.size());
  if (marker != kTrailerMarker) {
    require_known_schema(file, marker);
    return std::nullopt;
  }
  Cursor cursor(trailer);
  const std::uint64_t count = cursor.number();
  const std::uint64_t table = cursor.number();
  const std::uint64_t most = (file.size() - kTrailerBytes) / sizeof(std::uint64_t);
  if (count >= most || table != file.size() - kTrailerBytes - (count + 1) * sizeof(std::uint64_t)) return std::nullopt;
  std::vector<std::uint64_t> starts(static_cast<std::size_t>(count) + 1);
  if (!file.read_at(table, std::as_writable_bytes(std::span(starts)))) return std::nullopt;
  if (!std::is_sorted(starts.begin(), starts.end()) || starts.back() != table) return std::nullopt;
  return ContentsReader(file, std::move(starts));
}

std::vector<std::byte> ContentsReader::part(std::size_t position) const {
  if (position >= size()) throw StorageError(place_of(*file_, position) + ": the file holds no such object");
  std::vector<std::byte> bytes(static_cast<std::size_t>(starts_[position + 1] - starts_[position]));
  if (!file_->read_at(starts_[position], bytes)) throw StorageError(place_of(*file_, position) + ": cut off");
  return bytes;
}

ObjectHead ContentsReader::head(std::size_t position) const {
  const std::vector<std::byte> bytes = part(position);
  try {
    auto [id, skeleton] = open_part(bytes);
    Cursor cursor(skeleton);
    cursor.text();
    ObjectHead head{std::move(id), cursor.text(), cursor.text(), {}};
    cursor.text();
    head.inputs = cursor.texts();
    return head;
  } catch (const StorageError& error) {
    throw StorageError(place_of(*file_, position) + ": " + error.what());
  }
}

Record ContentsReader::read(std::size_t position, const std::string& id) const {
  const std::vector<std::byte> bytes = part(position);
  try {
    Decoder decoder(*file_, open_part(bytes).second);
    Record record = decoder.record();
    const std::string hash = decoder.hash();
    if (hash == id) return record;
    throw StorageError("(" + record.kind + " '" + record.name + "'): content hash is " + hash + ", expected " + id);
  } catch (const StorageError& error) {
    throw StorageError(place_of(*file_, position) + ": " + error.what());
  }
}

std::vector<Record> salvage(const ReadOnlyFile& file) {
  std::vector<std::byte> bytes(file.size());
  std::vector<Record> records;
  if (!file.read_at(0, bytes)) return records;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (std::size_t at = text.find(kPartMarker); at != std::string_view::npos; at = text.find(kPartMarker, at + 1)) {
    try {
      Cursor cursor(Bytes(bytes).subspan(at + kPartMarker.size()));
      const std::string id = cursor.text();
      Decoder decoder(file, cursor.take(cursor.number()));
      Record record = decoder.record();
      if (decoder.hash() == id) records.push_back(std::move(record));
    } catch (const StorageError&) {
      continue;  // this one is lost; the caller knows from the index what it was
    }
  }
  return records;
}

}  // namespace opponens::storage
