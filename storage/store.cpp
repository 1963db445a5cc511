// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/store.hpp"

#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "core/require.hpp"
#include "storage/batch_file.hpp"
#include "storage/index.hpp"
#include "storage/posix_file.hpp"
#include "storage/production_order.hpp"

namespace opponens::storage {
namespace {

namespace fs = std::filesystem;

/// Payload of one file. A whole file is read and hashed to read one object, so it is kept to tens of milliseconds.
constexpr std::size_t kBatchBytes = 16U << 20U;
constexpr const char* kTemporaryPrefix = ".tmp-";
constexpr const char* kRunLog = "runs.jsonl";

/// Batch files in order of commit: by number, then by name (two writers without a lock may take the same number).
std::vector<std::string> batch_files(const fs::path& directory) {
  std::vector<std::string> files;
  for (auto& name : directory_entries(directory)) {
    if (batch_number(name) >= 0) files.push_back(std::move(name));
  }
  std::stable_sort(files.begin(), files.end(),
                   [](const auto& a, const auto& b) { return batch_number(a) < batch_number(b); });
  return files;
}

void create_store(const fs::path& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) throw InputError(directory.string() + ": cannot make the store: " + error.message());
  if (::access(directory.c_str(), W_OK | X_OK) != 0) throw_errno("cannot write in the store", directory);
}

void require_store(const fs::path& directory) {
  std::error_code error;
  const fs::file_status status = fs::status(directory, error);
  if (!fs::exists(status)) throw InputError(directory.string() + ": no such store: " + error.message());
  if (!fs::is_directory(status)) throw InputError(directory.string() + ": not a directory, so not a store");
  if (fs::exists(directory / kIndexName) || !batch_files(directory).empty()) return;
  throw InputError(directory.string() + ": not a store: it holds neither " + kIndexName + " nor any batch file");
}

/// What a writer left that died between creating and renaming. Only to be called under the lock.
void remove_leftovers(const fs::path& directory) {
  for (const auto& name : directory_entries(directory)) {
    std::error_code ignored;
    if (name.starts_with(kTemporaryPrefix)) fs::remove(directory / name, ignored);
  }
}

/// Consecutive runs of fresh records, each of at most kBatchBytes of payload (or one record).
std::vector<std::vector<std::size_t>> split(const std::vector<Record>& records, const std::vector<std::size_t>& fresh) {
  std::vector<std::vector<std::size_t>> batches;
  std::size_t filled = kBatchBytes;
  for (const std::size_t i : fresh) {
    const std::size_t size = payload_bytes(records[i]);
    if (filled + size > kBatchBytes) {
      batches.emplace_back();
      filled = 0;
    }
    batches.back().push_back(i);
    filled += size;
  }
  return batches;
}

/// Removes the listed files unless told to keep them: the store is as it was when a commit fails half-way.
class Cleanup {
 public:
  explicit Cleanup(const fs::path& directory) : directory_(directory) {}
  ~Cleanup() {
    std::error_code ignored;
    for (const auto& name : names) fs::remove(directory_ / name, ignored);
  }
  Cleanup(const Cleanup&) = delete;
  Cleanup& operator=(const Cleanup&) = delete;
  std::vector<std::string> names;

 private:
  const fs::path& directory_;
};

}  // namespace

Store::Store(fs::path directory, bool create) : directory_(std::move(directory)) {
  if (create) create_store(directory_);
  if (!create) require_store(directory_);
  refresh();
  if (!create || fs::exists(directory_ / kIndexName)) return;
  // An index marks an empty store as one.
  if (!save_index(directory_, index_)) throw InputError(directory_.string() + ": cannot write the store's index");
}

Store::~Store() = default;
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;

void Store::adopt(std::vector<IndexEntry> entries) {
  for (auto& entry : entries) {
    if (by_id_.emplace(entry.id, index_.size()).second) index_.push_back(std::move(entry));
  }
}

void Store::refresh() {
  const std::optional<std::vector<IndexEntry>> stored = load_index(directory_);
  const std::vector<std::string> files = batch_files(directory_);
  std::map<std::string, std::vector<IndexEntry>> known;
  if (stored) {
    for (const auto& entry : *stored) known[entry.file].push_back(entry);
  }
  index_.clear();
  by_id_.clear();
  missing_.clear();
  unreadable_.clear();
  bool stale = !stored;
  for (const auto& file : files) {
    const auto found = known.find(file);
    if (found != known.end()) {
      adopt(std::move(found->second));
      known.erase(found);
      continue;
    }
    stale = true;
    try {
      adopt(BatchReader(directory_ / file).entries());
    } catch (const NewerSchemaError&) {
      throw;
    } catch (const StorageError& error) {
      unreadable_.emplace_back(error.what());
    }
  }
  for (const auto& [file, entries] : known) {
    missing_.push_back((directory_ / file).string() + ": the file is missing; the index says that it held " +
                       std::to_string(entries.size()) + " object(s)");
  }
  if (!stale || !missing_.empty() || !unreadable_.empty()) return;
  const DirectoryLock lock(directory_, DirectoryLock::Wait::no);
  if (lock.held()) save_index(directory_, index_);
}

void Store::require_undamaged() const {
  const std::size_t count = unreadable_.size() + missing_.size();
  if (count == 0) return;
  const std::string more = count > 1 ? " (and " + std::to_string(count - 1) + " more)" : "";
  throw StorageError((unreadable_.empty() ? missing_ : unreadable_).front() + more);
}

std::vector<std::string> Store::commit(const std::vector<Record>& records) {
  std::vector<std::string> ids;
  ids.reserve(records.size());
  for (const auto& record : records) {
    check_storable(record);
    ids.push_back(content_hash(record));
  }
  const DirectoryLock lock(directory_, DirectoryLock::Wait::yes);
  if (lock.held()) remove_leftovers(directory_);
  refresh();
  require_undamaged();
  std::vector<std::size_t> fresh;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (!by_id_.contains(ids[i]) && seen.insert(ids[i]).second) fresh.push_back(i);
  }
  if (std::any_of(ids.begin(), ids.end(), [&](const std::string& id) { return by_id_.contains(id); })) {
    // Before the files: should writing them fail, the line names what is not there and says nothing.
    log_run(production_line(ids, fresh.empty() ? index_.back().id : ids[fresh.back()]));
  }
  if (fresh.empty()) return ids;
  write_batches(records, ids, fresh);
  save_index(directory_, index_);
  return ids;
}

void Store::write_batches(const std::vector<Record>& records, const std::vector<std::string>& ids,
                          const std::vector<std::size_t>& fresh) {
  const std::vector<std::string> present = batch_files(directory_);
  std::size_t number = present.empty() ? 0 : static_cast<std::size_t>(batch_number(present.back())) + 1;
  Cleanup cleanup(directory_);
  std::vector<IndexEntry> entries;
  std::vector<std::pair<std::string, std::string>> renames;  // temporary -> final name
  for (const auto& batch : split(records, fresh)) {
    std::vector<const Record*> batch_records;
    std::vector<std::string> batch_ids;
    for (const std::size_t i : batch) {
      batch_records.push_back(&records[i]);
      batch_ids.push_back(ids[i]);
    }
    const std::vector<std::byte> bytes = encode_batch(batch_records, batch_ids);
    const std::string name = batch_file_name(number++, bytes);
    const std::string temporary = kTemporaryPrefix + std::to_string(::getpid()) + "-" + name;
    cleanup.names.push_back(temporary);
    write_new_file(directory_ / temporary, bytes, Durable::yes);
    renames.emplace_back(temporary, name);
    for (const std::size_t i : batch) {
      const Record& record = records[i];
      entries.push_back({ids[i], record.kind, record.name, name, record.provenance.inputs});
    }
  }
  for (const auto& [temporary, name] : renames) {
    std::error_code error;
    fs::rename(directory_ / temporary, directory_ / name, error);
    if (error) throw InputError((directory_ / name).string() + ": cannot rename into place: " + error.message());
    cleanup.names.push_back(name);
  }
  sync_directory(directory_);
  cleanup.names.clear();
  adopt(std::move(entries));
}

const IndexEntry& Store::find(const std::string& id) const {
  require(!id.empty(), "Store::read: an id or a prefix of one is needed");
  auto found = by_id_.lower_bound(id);
  if (found == by_id_.end() || !found->first.starts_with(id)) {
    require_undamaged();  // the object may have been in what is lost
    throw InputError(directory_.string() + ": no object with id '" + id + "'");
  }
  const auto next = std::next(found);
  if (found->first != id && next != by_id_.end() && next->first.starts_with(id)) {
    throw InputError(directory_.string() + ": id '" + id + "' is ambiguous: it begins " + found->first + " and " +
                     next->first);
  }
  return index_[found->second];
}

const BatchReader& Store::reader(const std::string& file) const {
  if (last_ == nullptr || last_->file_name() != file) {
    last_.reset();  // before the next one is read: never two files in memory
    last_ = std::make_unique<BatchReader>(directory_ / file);
  }
  return *last_;
}

Record Store::read(const std::string& id) const {
  const IndexEntry& entry = find(id);
  return reader(entry.file).read(entry.id);
}

std::vector<IndexEntry> Store::list(const std::string& kind) const {
  require_undamaged();
  std::vector<IndexEntry> entries;
  std::copy_if(index_.begin(), index_.end(), std::back_inserter(entries),
               [&](const IndexEntry& entry) { return kind.empty() || entry.kind == kind; });
  return entries;
}

std::vector<IndexEntry> Store::list_as_produced(const std::string& kind) const {
  const fs::path log = directory_ / kRunLog;
  std::vector<IndexEntry> entries = in_order_of_production(list(), fs::exists(log) ? read_file(log) : std::string());
  if (!kind.empty()) std::erase_if(entries, [&](const IndexEntry& entry) { return entry.kind != kind; });
  return entries;
}

std::vector<std::string> Store::check() const {
  std::vector<std::string> sentences = missing_;  // what cannot be read is read again below
  for (const auto& name : directory_entries(directory_)) {
    if (!name.ends_with(".h5") || name.starts_with(kTemporaryPrefix)) continue;
    const std::string path = (directory_ / name).string();
    if (batch_number(name) < 0) {
      sentences.push_back(path + ": not named like a batch file, so not read");
      continue;
    }
    try {
      for (auto& sentence : BatchReader(path).check()) sentences.push_back(std::move(sentence));
    } catch (const StorageError& error) {
      sentences.emplace_back(error.what());
    }
  }
  return sentences;
}

void Store::log_run(const std::string& json_line) const {
  require(json_line.find('\n') == std::string::npos, "Store::log_run: one line without a line break is needed");
  append_line(directory_ / kRunLog, json_line + "\n");
}

}  // namespace opponens::storage
