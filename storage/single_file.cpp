// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/single_file.hpp"

#include <optional>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/require.hpp"
#include "storage/batch_file.hpp"
#include "storage/contents.hpp"
#include "storage/hdf5_wrappers.hpp"
#include "storage/posix_file.hpp"

namespace opponens::storage {
namespace {

constexpr std::size_t kCommitBytes = 16U << 20U;  // payload that is in memory between two commits

/// Commits records that the store does not hold in runs of a few MB.
class Copier {
 public:
  explicit Copier(Store& target) : target_(target) {
    for (const auto& entry : target.list()) present_.insert(entry.id);
  }
  /// Throws StorageError when the target holds it, but damaged.
  bool wants(const std::string& id) const {
    if (present_.contains(id)) target_.require_intact(id);
    return !present_.contains(id) && !added_.contains(id);
  }
  void add(Record record, const std::string& id) {
    bytes_ += payload_bytes(record);
    records_.push_back(std::move(record));
    added_.insert(id);
    if (bytes_ >= kCommitBytes) commit();
  }
  void commit() {
    if (!records_.empty()) target_.commit(records_);
    records_.clear();
    bytes_ = 0;
  }

 private:
  Store& target_;
  std::unordered_set<std::string> present_;  // from the start
  std::unordered_set<std::string> added_;
  std::vector<Record> records_;
  std::size_t bytes_ = 0;
};

/// What this program would not have written; the file may come from anybody.
void require_storable(const Record& record, const std::filesystem::path& file, const std::string& id) {
  try {
    check_storable(record);
  } catch (const std::invalid_argument& error) {
    throw InputError(file.string() + ": object " + id + ": " + error.what());
  }
}

}  // namespace

Closure closure_of(const Store& store, const std::vector<std::string>& ids) {
  std::vector<IndexEntry> all = store.list_as_produced();
  std::unordered_map<std::string, std::size_t> position;
  for (std::size_t i = 0; i < all.size(); ++i) position.emplace(all[i].id, i);
  std::vector<bool> wanted(all.size(), false);
  std::vector<std::size_t> open;
  for (const auto& id : ids) open.push_back(position.at(store.find(id).id));
  Closure closure;
  std::unordered_set<std::string> missing;
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    if (wanted[at]) continue;
    wanted[at] = true;
    for (const auto& input : all[at].inputs) {
      const auto found = position.find(input);
      if (found != position.end()) {
        open.push_back(found->second);
      } else if (missing.insert(input).second) {
        closure.missing.push_back(input);
      }
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (wanted[i]) closure.objects.push_back(std::move(all[i]));
  }
  return closure;
}

void export_single_file(const Store& store, const std::vector<IndexEntry>& objects, const std::filesystem::path& out,
                        const Step& step) {
  const Draft draft(out);
  std::optional<BatchFileWriter> writer;
  hdf5::write_to(out, [&] { writer.emplace(draft.path()); });
  for (std::size_t i = 0; i < objects.size(); ++i) {
    step(i, objects.size());
    const Record record = store.read(objects[i].id);
    hdf5::write_to(out, [&] { writer->add(record, objects[i].id); });
  }
  hdf5::write_to(out, [&] { writer->finish(); });
  draft.complete();
}

bool is_single_file(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  const ReadOnlyFile open(file);
  return ContentsReader::open(open).has_value();
}

std::vector<std::string> import_single_file(const std::filesystem::path& file, Store& store, const Step& step) {
  const ReadOnlyFile open(file);
  const auto contents = ContentsReader::open(open);
  if (!contents) {
    throw InputError(file.string() + ": not a file that opponens export --single-file wrote, or cut off");
  }
  Copier copier(store);
  std::vector<std::string> ids;
  for (std::size_t i = 0; i < contents->size(); ++i) {
    step(i, contents->size());
    ids.push_back(contents->head(i).id);
    Record record = contents->read(i, ids.back());
    require_storable(record, file, ids.back());
    if (copier.wants(ids.back())) copier.add(std::move(record), ids.back());
  }
  copier.commit();
  return ids;
}

std::vector<std::string> merge_store(const Store& from, Store& target, const Step& step) {
  Copier copier(target);
  std::vector<std::string> copied;
  const std::vector<IndexEntry> entries = from.list_as_produced();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    step(i, entries.size());
    if (!copier.wants(entries[i].id)) continue;
    copier.add(from.read(entries[i].id), entries[i].id);
    copied.push_back(entries[i].id);
  }
  copier.commit();
  return copied;
}

}  // namespace opponens::storage
