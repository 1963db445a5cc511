// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iterator>
#include <optional>
#include <unordered_map>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/records.hpp"
#include "cli/resources.hpp"
#include "cli/stored.hpp"
#include "core/require.hpp"

namespace opponens::cli {
namespace {

namespace fs = std::filesystem;

/// Outside files as they are now. One recorded with a folder is looked for there (or in the data folder); one recorded
/// by its name alone in the folders given and below them.
class OutsideFiles {
 public:
  explicit OutsideFiles(const std::vector<fs::path>& folders) {
    for (const auto& folder : folders) {
      if (!fs::is_directory(folder)) throw InputError(folder.string() + ": no such folder (--files)");
      for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) by_name_[entry.path().filename().string()].push_back(entry.path());
      }
    }
  }

  /// ambiguous: some of the files of that name have the hash, some have not.
  enum class Finding { not_there, unchanged, changed, ambiguous };
  Finding compare(const std::string& name, const std::string& hash) {
    const std::vector<fs::path> places = places_of(name);
    const auto same =
        std::count_if(places.begin(), places.end(), [&](const fs::path& place) { return hash_of(place) == hash; });
    if (places.empty()) return Finding::not_there;
    if (same == 0) return Finding::changed;
    return same == std::ssize(places) ? Finding::unchanged : Finding::ambiguous;
  }

 private:
  std::vector<fs::path> places_of(const std::string& name) const {
    if (fs::path(name).has_parent_path()) {
      try {
        return {find_file(name)};
      } catch (const InputError&) {
        return {};
      }
    }
    const auto found = by_name_.find(name);
    return found == by_name_.end() ? std::vector<fs::path>() : found->second;
  }
  const std::string& hash_of(const fs::path& place) {
    const auto [found, first] = hashes_.try_emplace(place.string());
    if (first) found->second = file_sha256(place);
    return found->second;
  }

  std::unordered_map<std::string, std::vector<fs::path>> by_name_;
  std::unordered_map<std::string, std::string> hashes_;
};

/// What makes a later object take an earlier one's place: a motion's kind, source and name; of synergies, being some
/// (of that order: those of joint velocities do not take the place of the others).
std::optional<std::string> role_of(const storage::Record& record) {
  if (record.kind == kSynergySet || record.kind == kFirstOrderSynergies) return record.kind;
  if (record.kind != kRecording && record.kind != kHandMotion) return std::nullopt;
  return Json{record.kind, text_field(record, "label.source"), record.name}.dump();
}

struct Finding {
  storage::IndexEntry object;
  std::string reason;
  Json because;
};

class Staleness {
 public:
  Staleness(const storage::Store& store, const std::vector<fs::path>& folders)
      : produced_(store.list_as_produced()), outside_(folders) {
    for (const auto& entry : produced_) present_.emplace(entry.id, &entry);
    for (const auto& entry : store.list()) look_at(entry.id, store.read(entry.id));
    for (const auto& entry : produced_) {
      const auto role = roles_.find(entry.id);
      if (role != roles_.end()) newest_[role->second] = entry.id;  // the last one stays
    }
    for (const auto& entry : produced_) visit(entry.id);
  }

  const std::vector<Finding>& findings() const { return findings_; }
  const std::vector<Finding>& superseded() const { return superseded_; }
  std::size_t unseen_files() const { return unseen_.size(); }
  const std::set<std::string>& ambiguous_files() const { return ambiguous_; }

 private:
  void look_at(const std::string& id, const storage::Record& record) {
    if (const auto role = role_of(record)) roles_[id] = *role;
    for (const auto& [name, hash] : record.provenance.files) {
      const OutsideFiles::Finding found = outside_.compare(name, hash);
      if (found == OutsideFiles::Finding::not_there) unseen_.insert(name);
      if (found == OutsideFiles::Finding::ambiguous) ambiguous_.insert(name);
      if (found == OutsideFiles::Finding::changed) changed_file_.emplace(id, name);
    }
  }

  const std::string* newer_than(const std::string& id) const {
    const auto role = roles_.find(id);
    if (role == roles_.end()) return nullptr;
    const std::string& newest = newest_.at(role->second);
    return newest == id ? nullptr : &newest;
  }

  /// Inputs before what was made from them; hashes make a cycle impossible.
  void visit(const std::string& first) {
    std::vector<std::pair<std::string, bool>> open{{first, false}};
    while (!open.empty()) {
      const auto [id, inputs_done] = open.back();
      open.pop_back();
      if (stale_.contains(id) || !present_.contains(id)) continue;
      const storage::IndexEntry& entry = *present_.at(id);
      if (!inputs_done) {
        open.emplace_back(id, true);
        for (const auto& input : entry.inputs) open.emplace_back(input, false);
        continue;
      }
      if (const std::string* newer = newer_than(id)) {
        superseded_.push_back({entry, "superseded by " + short_id(*newer), {{"superseded_by", *newer}}});
      }
      judge(entry);
    }
  }

  void judge(const storage::IndexEntry& entry) {
    const auto found = [&](const std::string& reason, const Json& because) {
      stale_[entry.id] = true;
      findings_.push_back({entry, reason, because});
    };
    stale_[entry.id] = false;
    const auto file = changed_file_.find(entry.id);
    if (file != changed_file_.end()) return found(file->second + " has changed since", {{"file", file->second}});
    for (const auto& input : entry.inputs) {
      if (!present_.contains(input)) {
        return found("made from " + short_id(input) + ", which is not in the store", {{"missing", input}});
      }
      if (const std::string* newer = newer_than(input)) {
        return found("made from " + short_id(input) + ", which " + short_id(*newer) + " supersedes",
                     {{"input", input}, {"superseded_by", *newer}});
      }
      if (stale_.at(input)) return found("made from " + short_id(input) + ", which is stale", {{"input", input}});
    }
  }

  std::vector<storage::IndexEntry> produced_;
  OutsideFiles outside_;
  std::unordered_map<std::string, const storage::IndexEntry*> present_;
  std::unordered_map<std::string, std::string> roles_;         // id -> role
  std::unordered_map<std::string, std::string> newest_;        // role -> id
  std::unordered_map<std::string, std::string> changed_file_;  // id -> outside file
  std::unordered_map<std::string, bool> stale_;
  std::set<std::string> unseen_;
  std::set<std::string> ambiguous_;
  std::vector<Finding> findings_;
  std::vector<Finding> superseded_;
};

Json say_findings(const std::vector<Finding>& findings, const Console& console) {
  Json list = Json::array();
  for (const auto& finding : findings) {
    console.say(short_id(finding.object.id) + "  " + finding.object.kind + "  " + finding.object.name + ": " +
                finding.reason);
    Json item = entry_json(finding.object);
    item["reason"] = finding.reason;
    item.update(finding.because);
    list.push_back(std::move(item));
  }
  return list;
}

}  // namespace

int stale(const StaleOptions& options, const Console& console) {
  const storage::Store store(options.common.store, false);
  const Staleness staleness(store, options.files);
  Json result = document("stale");
  result["superseded"] = say_findings(staleness.superseded(), console);
  result["stale"] = say_findings(staleness.findings(), console);
  result["files_not_found"] = staleness.unseen_files();
  result["files_ambiguous"] = staleness.ambiguous_files();
  for (const auto& name : staleness.ambiguous_files()) {
    console.say(name +
                ": several files have this name, and only some are as they were; name their folder with --files");
  }
  console.say(std::to_string(staleness.findings().size()) + " objects are stale, " +
              std::to_string(staleness.superseded().size()) + " superseded; " +
              std::to_string(staleness.unseen_files()) + " outside files were not found, so not compared");
  console.document(result.dump());
  return kDone;
}

}  // namespace opponens::cli
