// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/readers/find_recordings.hpp"

#include <algorithm>
#include <optional>
#include <regex>

#include "core/require.hpp"
#include "storage/posix_file.hpp"
#include "storage/readers/csv.hpp"
#include "storage/sha256.hpp"
#include "storage/text.hpp"

namespace opponens::storage {
namespace {

namespace fs = std::filesystem;

std::vector<RecordingFile> read_index(const fs::path& root, const RecordingFiles& layout) {
  const fs::path path = root / layout.index;
  const std::string text = read_file(path);
  if (!is_utf8(text)) throw InputError(path.string() + ": not UTF-8 text: expected a CSV index in UTF-8");
  CsvReader csv(text, path);
  const std::size_t file_column = csv.column(layout.file_column, "file column");
  const std::string hash = sha256(text);
  std::vector<RecordingFile> found;
  while (csv.next()) {
    if (csv.cell(file_column).empty()) csv.fail(file_column, "the name of a recording's file");
    RecordingFile row;
    row.file = root / layout.folder / fs::path(csv.cell(file_column));
    row.id = row.file.stem().string();
    std::error_code error;
    if (!fs::is_regular_file(row.file, error)) {
      csv.fail(file_column, "a file that exists (" + row.file.string() + " does not)");
    }
    for (std::size_t i = 0; i < csv.header().size(); ++i) row.facts[std::string(csv.header()[i])] = csv.cell(i);
    row.companions[path.filename().string()] = hash;
    row.index = path;
    row.line = csv.line();
    found.push_back(std::move(row));
  }
  if (found.empty()) throw InputError(path.string() + ": the index lists no recordings");
  return found;
}

/// The directory that a recording's description is relative to: its own, less the folder.
fs::path root_of(const fs::path& recording, const RecordingFiles& layout) {
  fs::path root = recording.parent_path();
  for (const auto& part : fs::path(layout.folder)) {
    if (!part.empty() && part != ".") root = root / "..";
  }
  return root.empty() ? "." : root;
}

std::vector<RecordingFile> indexed(const fs::path& path, bool directory, const RecordingFiles& layout) {
  if (directory) return read_index(path, layout);
  const fs::path root = root_of(path, layout);
  std::vector<RecordingFile> rows = read_index(root, layout);
  std::error_code error;
  std::erase_if(rows, [&](const RecordingFile& row) { return !fs::equivalent(row.file, path, error); });
  if (rows.empty()) throw InputError(path.string() + ": not listed in " + (root / layout.index).string());
  rows.resize(1);
  rows.front().file = path;
  return rows;
}

/// A file whose path ends in `name`; none when the expression does not match that.
std::optional<RecordingFile> match(const fs::path& file, const std::string& name, const std::regex& expression,
                                   const RecordingFiles& layout) {
  // The library's matcher needs stack in proportion to the text: names are short, others are not recordings.
  constexpr std::size_t kLongestName = 1000;
  std::smatch groups;
  if (name.size() > kLongestName || !is_utf8(name) || !std::regex_match(name, groups, expression)) return {};
  RecordingFile found;
  found.file = file;
  found.id = fs::path(name).replace_extension().generic_string();
  std::replace(found.id.begin(), found.id.end(), '/', '_');
  found.facts["folder"] = fs::absolute(file).parent_path().filename().string();
  for (std::size_t i = 0; i < layout.parts.size(); ++i) found.facts[layout.parts[i]] = groups.str(i + 1);
  return found;
}

/// What a file is does not depend on the PATH that led to it: the shortest end of its path that matches.
std::optional<RecordingFile> shortest_match(const fs::path& file, const std::regex& expression,
                                            const RecordingFiles& layout) {
  fs::path name;
  const fs::path whole = fs::absolute(file).lexically_normal().relative_path();
  for (auto part = whole.end(); part != whole.begin();) {
    --part;
    name = name.empty() ? *part : *part / name;
    if (auto found = match(file, name.generic_string(), expression, layout)) return found;
  }
  return {};
}

std::vector<RecordingFile> named(const fs::path& path, bool directory, const RecordingFiles& layout) {
  const std::regex expression(layout.expression);
  std::vector<fs::path> files;
  if (directory) {
    for (const auto& entry : fs::recursive_directory_iterator(path)) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end(),
              [](const auto& a, const auto& b) { return a.generic_string() < b.generic_string(); });
  } else {
    files.push_back(path);
  }
  std::vector<RecordingFile> found;
  for (const auto& file : files) {
    if (auto recording = shortest_match(file, expression, layout)) found.push_back(std::move(*recording));
  }
  if (found.empty()) {
    throw_input(path, 0, directory ? "number of recordings in the folder" : "the file's name",
                directory ? "0" : path.filename().string(), "names that match " + layout.expression);
  }
  return found;
}

}  // namespace

std::vector<RecordingFile> find_recordings(const fs::path& path, const SourceDescription& source) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw InputError(path.string() + ": no such file or directory");
  const bool directory = fs::is_directory(status);
  return source.recordings.expression.empty() ? indexed(path, directory, source.recordings)
                                              : named(path, directory, source.recordings);
}

}  // namespace opponens::storage
