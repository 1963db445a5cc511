// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/index.hpp"

#include <unistd.h>

#include <nlohmann/json.hpp>

#include "core/require.hpp"
#include "storage/posix_file.hpp"
#include "storage/sha256.hpp"

namespace opponens::storage {
namespace {

using nlohmann::json;

json to_json(const std::vector<IndexEntry>& entries) {
  json list = json::array();
  for (const auto& entry : entries) {
    list.push_back(
        {{"id", entry.id}, {"kind", entry.kind}, {"name", entry.name}, {"file", entry.file}, {"inputs", entry.inputs}});
  }
  return list;
}

std::vector<IndexEntry> from_json(const json& list) {
  std::vector<IndexEntry> entries;
  entries.reserve(list.size());
  for (const auto& item : list) {
    entries.push_back({item.at("id"), item.at("kind"), item.at("name"), item.at("file"), item.at("inputs")});
  }
  return entries;
}

}  // namespace

std::optional<std::vector<IndexEntry>> load_index(const std::filesystem::path& directory) {
  try {
    const json document = json::parse(read_file(directory / kIndexName));
    const json& list = document.at("entries");
    if (document.at("schema_version") != kSchemaVersion || document.at("sha256") != sha256(list.dump())) {
      return std::nullopt;
    }
    return from_json(list);
  } catch (const json::exception&) {
    return std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

bool save_index(const std::filesystem::path& directory, const std::vector<IndexEntry>& entries) {
  const json list = to_json(entries);
  const json document = {{"schema_version", kSchemaVersion}, {"entries", list}, {"sha256", sha256(list.dump())}};
  // Not flushed to disk: after a power cut it may be empty or old, which its hash and list of files show.
  const std::string text = document.dump(1) + "\n";
  const std::filesystem::path temporary = directory / (".tmp-index-" + std::to_string(::getpid()));
  std::error_code error;
  std::filesystem::remove(temporary, error);
  try {
    write_new_file(temporary, std::as_bytes(std::span(text)), Durable::no);
  } catch (const InputError&) {
    std::filesystem::remove(temporary, error);
    return false;
  }
  std::filesystem::rename(temporary, directory / kIndexName, error);
  return !error;
}

}  // namespace opponens::storage
