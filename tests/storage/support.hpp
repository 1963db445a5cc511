// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "core/rng.hpp"
#include "storage/store.hpp"

namespace opponens::storage::test {

namespace fs = std::filesystem;

/// A directory of its own, removed at the end.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name = (fs::temp_directory_path() / "opponens-test-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  fs::path operator/(const std::string& name) const { return path_ / name; }

 private:
  fs::path path_;
};

inline std::string slurp(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

inline void spill(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

/// Name -> bytes of every file of a store except the run log.
inline std::map<std::string, std::string> contents(const fs::path& directory) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(directory)) {
    const std::string name = entry.path().filename().string();
    if (name != "runs.jsonl") files[name] = slurp(entry.path());
  }
  return files;
}

inline std::string only_batch(const fs::path& directory) {
  std::string found;
  for (const auto& entry : fs::directory_iterator(directory)) {
    if (entry.path().extension() == ".h5") found = entry.path().filename().string();
  }
  return found;
}

/// Any double but NaN: ordinary, denormal, huge, infinite, -0.0.
inline double any_double(Rng& rng) {
  while (true) {
    const std::uint64_t choice = rng.index(8);
    if (choice == 0) return -0.0;
    if (choice == 1) return rng.index(2) == 0 ? 5e-324 : -1e308;
    if (choice == 2) return std::numeric_limits<double>::infinity();
    if (choice < 6) return rng.normal();
    const auto value = std::bit_cast<double>(rng());
    if (value == value) return value;
  }
}

inline std::string any_text(Rng& rng) {
  static const char* const kPieces[] = {"",  "a",  "label", "\xC3\xA9", "\xE2\x86\x92", "\xF0\x9F\xA4\x8F", "\n",
                                        " ", "\"", "/",     ".."};
  std::string text;
  for (std::uint64_t count = rng.index(5); count > 0; --count) text += kPieces[rng.index(std::size(kPieces))];
  return text;
}

inline Field any_field(Rng& rng) {
  const auto size = [&] { return static_cast<Eigen::Index>(rng.index(3) == 0 ? 0 : rng.index(60)); };
  switch (rng.index(6)) {
    case 0:
      return any_double(rng);
    case 1:
      return static_cast<std::int64_t>(rng());
    case 2:
      return any_text(rng);
    case 3: {
      std::vector<std::string> list(rng.index(5));
      for (auto& text : list) text = any_text(rng);
      return list;
    }
    case 4: {
      Eigen::VectorXd vector(size());
      for (auto& value : vector) value = any_double(rng);
      return vector;
    }
    default: {
      Eigen::MatrixXd matrix(size(), size());
      for (auto& value : matrix.reshaped()) value = any_double(rng);
      return matrix;
    }
  }
}

inline std::string any_name(Rng& rng, std::uint64_t number) {
  static const char* const kPieces[] = {"", "q_h", "label.", "\xC3\xA9", " ", "."};
  std::string name = kPieces[rng.index(std::size(kPieces))];
  return name.append(std::to_string(number));
}

inline Record any_record(Rng& rng) {
  Record record;
  record.kind = rng.index(2) == 0 ? "demonstration" : "document";
  record.name = any_text(rng);
  record.provenance.command = any_text(rng);
  record.provenance.parameters = any_text(rng);
  record.provenance.seed = rng();
  record.provenance.program_version = "0.1.0";
  for (std::uint64_t i = rng.index(3); i > 0; --i) record.provenance.inputs.push_back(any_text(rng));
  for (std::uint64_t i = rng.index(3); i > 0; --i) record.provenance.files[any_text(rng).append("f")] = any_text(rng);
  for (std::uint64_t i = rng.index(20); i > 0; --i) record.fields[any_name(rng, i)] = any_field(rng);
  return record;
}

inline Record small_record(int number) {
  Record record{"document", "record " + std::to_string(number), {}, {}};
  record.fields["number"] = std::int64_t{number};
  record.fields["values"] = Eigen::VectorXd(Eigen::VectorXd::LinSpaced(20, 0.0, number + 1.0));
  record.fields["words"] = std::vector<std::string>{"one", "", "three"};
  return record;
}

/// Bitwise equality, since the content hash is taken of the bits.
inline bool same(const Record& a, const Record& b) { return content_hash(a) == content_hash(b); }

/// Runs the statement and returns the message of the exception of that type.
template <typename Exception, typename Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const Exception& error) {
    return error.what();
  } catch (const std::exception& error) {
    return std::string("another kind of exception: ") + error.what();
  }
  return "no exception";
}

inline ::testing::AssertionResult contains(const std::string& text, const std::vector<std::string>& parts) {
  for (const auto& part : parts) {
    if (text.find(part) == std::string::npos)
      return ::testing::AssertionFailure() << "'" << part << "' is not in: " << text;
  }
  return ::testing::AssertionSuccess();
}

}  // namespace opponens::storage::test
