// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/repair.hpp"

#include <unistd.h>

#include <algorithm>
#include <optional>
#include <system_error>
#include <unordered_set>
#include <utility>

#include "core/require.hpp"
#include "storage/batch_file.hpp"
#include "storage/catalog.hpp"
#include "storage/contents.hpp"
#include "storage/posix_file.hpp"
#include "storage/store_files.hpp"

namespace opponens::storage {
namespace {

namespace fs = std::filesystem;

struct Damage {
  std::string reason;
  bool unreadable = false;
};

/// The first thing wrong with a file.
std::optional<Damage> damage_of(const fs::path& path) {
  try {
    const std::vector<std::string> sentences = BatchReader(path).check();
    return sentences.empty() ? std::nullopt : std::optional(Damage{sentences.front(), false});
  } catch (const NewerSchemaError&) {
    throw;
  } catch (const StorageError& error) {
    return Damage{error.what(), false};
  } catch (const InputError& error) {
    return Damage{error.what(), true};
  }
}

std::vector<IndexEntry> entries_for(const std::vector<Record>& records) {
  std::vector<IndexEntry> entries;
  for (const auto& record : records) {
    entries.push_back({content_hash(record), record.kind, record.name, {}, record.provenance.inputs});
  }
  return entries;
}

/// A new file of the same number with these objects; its name.
std::string rewrite(const fs::path& directory, const std::string& damaged, const std::vector<Record>& records,
                    const std::vector<IndexEntry>& entries) {
  std::vector<const Record*> pointers;
  std::vector<std::string> ids;
  for (std::size_t i = 0; i < records.size(); ++i) {
    pointers.push_back(&records[i]);
    ids.push_back(entries[i].id);
  }
  const auto bytes = encode_batch(pointers, ids);
  const std::string name = batch_file_name(static_cast<std::size_t>(batch_number(damaged)), bytes);
  const fs::path temporary = directory / (kTemporaryPrefix + std::to_string(::getpid()) + "-" + name);
  write_new_file(temporary, bytes, Durable::yes);
  rename_file(temporary, directory / name);
  sync_directory(directory);
  return name;
}

/// The copy is on the disk before the original goes.
void copy_aside(const fs::path& file, const fs::path& place) {
  const Draft draft(place);
  std::error_code error;
  fs::copy_file(file, draft.path(), error);
  if (error) throw InputError(place.string() + ": cannot set the damaged file aside: " + error.message());
  sync_file(draft.path());
  draft.complete();
}

/// Gives the file a second name in damaged/; its first one stays until what is intact has been written.
void keep_aside(const fs::path& directory, const std::string& file) {
  const fs::path folder = directory / kDamagedFolder;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": cannot make the folder: " + error.message());
  fs::path place = folder / file;
  for (int i = 2; fs::exists(place); ++i) {
    if (fs::equivalent(directory / file, place, error)) return;  // by a run that was killed after it
    place = folder / (file + "." + std::to_string(i));
  }
  fs::create_hard_link(directory / file, place, error);
  if (error) copy_aside(directory / file, place);  // file systems without links
  sync_directory(folder);
  sync_directory(directory);  // the folder itself
}

class Repair {
 public:
  Repair(fs::path directory, bool dry_run) : directory_(std::move(directory)), dry_run_(dry_run) {
    const std::vector<std::string> names = directory_entries(directory_);
    if (!dry_run_) remove_leftovers(directory_, names);
    files_ = batch_files(names);
  }

  RepairReport run() {
    catalog_.load(directory_);
    const Catalog::Changes known = catalog_.arrange(files_);
    for (const auto& gone : known.gone) {
      report_.files.push_back({gone.file, "the file is missing", {}, gone.entries, true});
    }
    for (const auto& file : files_) look_at(file, catalog_.entries(file));
    after_.arrange(kept_);
    for (auto& file : report_.files) {
      std::erase_if(file.lost, [this](const IndexEntry& entry) { return after_.contains(entry.id); });
    }
    find_dangling();
    if (!dry_run_ && !report_.files.empty()) replace_index();
    return std::move(report_);
  }

 private:
  void look_at(const std::string& file, const std::optional<std::vector<IndexEntry>>& known) {
    const std::optional<Damage> damage = damage_of(directory_ / file);
    if (damage && damage->unreadable) {
      report_.files.push_back({file, damage->reason, {}, {}, known.has_value(), true});
      if (!known) return;
    }
    if (!damage || damage->unreadable) {
      after_.append(file, known ? *known : BatchReader(directory_ / file).entries());
      kept_.push_back(file);
      return;
    }
    const std::vector<Record> records = salvage(ReadOnlyFile(directory_ / file));
    DamagedFile damaged{file, damage->reason, entries_for(records), known.value_or(std::vector<IndexEntry>()),
                        known.has_value()};
    if (!dry_run_) keep_aside(directory_, file);
    std::string replacement = file;  // also its name when nothing but the end of the file was lost
    if (!records.empty() && !dry_run_) replacement = rewrite(directory_, file, records, damaged.saved);
    const bool listed = replacement != file && std::count(files_.begin(), files_.end(), replacement) > 0;
    if (!records.empty() && !listed) {  // listed: an earlier run was killed after it had written it
      after_.append(replacement, damaged.saved);
      kept_.push_back(replacement);
    }
    if (!dry_run_ && (records.empty() || replacement != file)) remove_name(file);
    report_.files.push_back(std::move(damaged));
  }

  void remove_name(const std::string& file) {
    std::error_code error;
    fs::remove(directory_ / file, error);
    if (error) throw InputError((directory_ / file).string() + ": cannot move to damaged/: " + error.message());
    sync_directory(directory_);
  }

  void find_dangling() {
    std::unordered_set<std::string> present;
    const std::vector<IndexEntry> entries = after_.list("");
    for (const auto& entry : entries) present.insert(entry.id);
    for (const auto& entry : entries) {
      for (const auto& input : entry.inputs) {
        if (!present.contains(input)) report_.dangling.push_back({entry, input});
      }
    }
  }

  void replace_index() {
    std::error_code ignored;
    fs::remove(directory_ / kIndexName, ignored);
    after_.save(directory_);
  }

  fs::path directory_;
  bool dry_run_;
  std::vector<std::string> files_;
  Catalog catalog_;                // as the index tells
  Catalog after_;                  // as it is (or would be) afterwards
  std::vector<std::string> kept_;  // files of after_
  RepairReport report_;
};

}  // namespace

RepairReport repair(const fs::path& directory, bool dry_run) {
  const DirectoryLock lock(directory, DirectoryLock::Wait::yes);
  return Repair(directory, dry_run).run();
}

}  // namespace opponens::storage
