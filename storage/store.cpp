// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/store.hpp"

#include <unistd.h>

#include <algorithm>
#include <exception>
#include <unordered_set>
#include <utility>

#include "core/require.hpp"
#include "storage/batch_file.hpp"
#include "storage/catalog.hpp"
#include "storage/posix_file.hpp"
#include "storage/production_order.hpp"
#include "storage/store_files.hpp"

namespace opponens::storage {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBatchBytes = 16U << 20U;  // payload of one file; two of them are in memory while it is made
constexpr const char* kRunLog = "runs.jsonl";

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

struct Store::State {
  Catalog catalog;
  std::vector<std::string> missing;           // sentences, one per file that the index names and that is gone
  std::vector<std::string> unreadable;        // sentences, one per file that cannot be read
  mutable std::unique_ptr<BatchReader> last;  // the file read last

  /// After the catalog was loaded; files: the batch files of the directory, listed after that.
  void refresh(const fs::path& directory, const std::vector<std::string>& files);
  void require_undamaged() const;
  void write_batches(const fs::path& directory, std::size_t number, const std::vector<Record>& records,
                     const std::vector<std::string>& ids, const std::vector<std::size_t>& fresh);
  Catalog::Place find(const fs::path& directory, const std::string& id) const;
  Record read(const fs::path& directory, Catalog::Place place) const;
};

Store::Store(fs::path directory, bool create) : directory_(std::move(directory)), state_(std::make_unique<State>()) {
  if (create) create_store(directory_);
  state_->catalog.load(directory_);
  const std::vector<std::string> files = create ? batch_files(directory_) : require_store(directory_);
  state_->refresh(directory_, files);
  if (!create || fs::exists(directory_ / kIndexName)) return;
  // An index marks an empty store as one. Another process may make it first.
  if (state_->catalog.save(directory_) || fs::exists(directory_ / kIndexName)) return;
  throw InputError(directory_.string() + ": cannot write the store's index");
}

Store::~Store() = default;
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;

void Store::State::refresh(const fs::path& directory, const std::vector<std::string>& files) {
  missing.clear();
  unreadable.clear();
  const Catalog::Changes changes = catalog.arrange(files);
  for (const auto& file : changes.unknown) {
    try {
      catalog.append(file, BatchReader(directory / file).entries());
    } catch (const NewerSchemaError&) {
      throw;
    } catch (const std::runtime_error& error) {  // damaged, or the system does not let us read it
      unreadable.emplace_back(error.what());
    }
  }
  if (!changes.unknown.empty()) catalog.arrange(files);
  for (const auto& [file, entries] : changes.gone) {
    missing.push_back((directory / file).string() + ": the file is missing; the index says that it held " +
                      std::to_string(entries.size()) + " object(s)");
  }
  if (!missing.empty() || !unreadable.empty() || catalog.is_saved()) return;
  const DirectoryLock lock(directory, DirectoryLock::Wait::no);
  if (lock.held()) catalog.save(directory);
}

void Store::State::require_undamaged() const {
  const std::size_t count = unreadable.size() + missing.size();
  if (count == 0) return;
  const std::string more = count > 1 ? " (and " + std::to_string(count - 1) + " more)" : "";
  throw StorageError((unreadable.empty() ? missing : unreadable).front() + more);
}

std::vector<std::string> Store::commit(const std::vector<Record>& records) {
  std::vector<std::string> ids;
  ids.reserve(records.size());
  for (const auto& record : records) {
    check_storable(record);
    ids.push_back(content_hash(record));
  }
  const DirectoryLock lock(directory_, DirectoryLock::Wait::yes);
  state_->catalog.load(directory_);
  const std::vector<std::string> names = directory_entries(directory_);
  if (lock.held()) remove_leftovers(directory_, names);
  const std::vector<std::string> files = batch_files(names);
  state_->refresh(directory_, files);
  state_->require_undamaged();
  std::vector<std::size_t> fresh;
  std::unordered_set<std::string> seen;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (state_->catalog.contains(ids[i])) {
      require_intact(ids[i]);
    } else if (seen.insert(ids[i]).second) {
      fresh.push_back(i);
    }
  }
  if (seen.size() < std::unordered_set<std::string>(ids.begin(), ids.end()).size()) {
    // Before the files: should writing them fail, the line names what is not there and says nothing.
    log_run(production_line(ids, fresh.empty() ? state_->catalog.last_id() : ids[fresh.back()]));
  }
  if (fresh.empty()) return ids;
  const std::size_t number = files.empty() ? 0 : static_cast<std::size_t>(batch_number(files.back())) + 1;
  state_->write_batches(directory_, number, records, ids, fresh);
  state_->catalog.save(directory_);
  return ids;
}

void Store::State::write_batches(const fs::path& directory, std::size_t number, const std::vector<Record>& records,
                                 const std::vector<std::string>& ids, const std::vector<std::size_t>& fresh) {
  Cleanup cleanup(directory);
  std::vector<std::vector<IndexEntry>> entries;
  std::vector<std::pair<std::string, std::string>> renames;  // temporary -> final name
  for (const auto& batch : split(records, fresh)) {
    std::vector<const Record*> batch_records;
    std::vector<std::string> batch_ids;
    entries.emplace_back();
    for (const std::size_t i : batch) {
      const Record& record = records[i];
      batch_records.push_back(&record);
      batch_ids.push_back(ids[i]);
      entries.back().push_back({ids[i], record.kind, record.name, {}, record.provenance.inputs});
    }
    const std::vector<std::byte> bytes = encode_batch(batch_records, batch_ids);
    const std::string name = batch_file_name(number++, bytes);
    const std::string temporary = kTemporaryPrefix + std::to_string(::getpid()) + "-" + name;
    cleanup.names.push_back(temporary);
    write_new_file(directory / temporary, bytes, Durable::yes);
    renames.emplace_back(temporary, name);
  }
  for (const auto& [temporary, name] : renames) {
    std::error_code error;
    fs::rename(directory / temporary, directory / name, error);
    if (error) throw InputError((directory / name).string() + ": cannot rename into place: " + error.message());
    cleanup.names.push_back(name);
  }
  sync_directory(directory);
  cleanup.names.clear();
  for (std::size_t i = 0; i < renames.size(); ++i) catalog.append(renames[i].second, entries[i]);
}

Catalog::Place Store::State::find(const fs::path& directory, const std::string& id) const {
  require(!id.empty(), "Store::read: an id or a prefix of one is needed");
  const std::vector<Catalog::Place> found = catalog.find(id);
  if (found.empty()) {
    require_undamaged();  // the object may have been in what is lost
    throw InputError(directory.string() + ": no object with id '" + id + "'");
  }
  if (found.size() == 1) return found.front();
  throw InputError(directory.string() + ": id '" + id + "' is ambiguous: it begins " + catalog.entry(found[0]).id +
                   " and " + catalog.entry(found[1]).id);
}

Record Store::State::read(const fs::path& directory, Catalog::Place place) const {
  const IndexEntry entry = catalog.entry(place);
  if (last == nullptr || last->file_name() != entry.file) {
    last.reset();  // before the next one is opened: a file of another maker is kept in memory
    last = std::make_unique<BatchReader>(directory / entry.file);
  }
  return last->read(place.position, entry.id);
}

IndexEntry Store::find(const std::string& id) const { return state_->catalog.entry(state_->find(directory_, id)); }

Record Store::read(const std::string& id) const {
  std::exception_ptr first;  // what is wrong with the earliest copy
  for (const Catalog::Place place : state_->catalog.copies(state_->find(directory_, id))) {
    try {
      return state_->read(directory_, place);
    } catch (const std::runtime_error&) {
      if (!first) first = std::current_exception();
    }
  }
  std::rethrow_exception(first);
}

void Store::require_intact(const std::string& id) const {
  try {
    read(id);
  } catch (const StorageError& error) {
    throw StorageError(std::string(error.what()) + "; run opponens repair first");
  }
}

std::vector<IndexEntry> Store::list(const std::string& kind) const {
  state_->require_undamaged();
  return state_->catalog.list(kind);
}

std::vector<IndexEntry> Store::list_as_produced(const std::string& kind) const {
  const fs::path log = directory_ / kRunLog;
  std::vector<IndexEntry> entries = in_order_of_production(list(), fs::exists(log) ? read_file(log) : std::string());
  if (!kind.empty()) std::erase_if(entries, [&](const IndexEntry& entry) { return entry.kind != kind; });
  return entries;
}

std::vector<std::string> Store::check() const {
  std::vector<std::string> sentences = state_->missing;  // what cannot be read is read again below
  for (const auto& name : directory_entries(directory_)) {
    if (!name.ends_with(".h5") || name.starts_with(kTemporaryPrefix)) continue;
    const std::string path = (directory_ / name).string();
    if (batch_number(name) < 0) {
      sentences.push_back(path + ": not named like a batch file, so not read");
      continue;
    }
    try {
      for (auto& sentence : BatchReader(path).check()) sentences.push_back(std::move(sentence));
    } catch (const std::runtime_error& error) {
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
