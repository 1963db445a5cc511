// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/contents.hpp"

#include <cstring>

#include "core/require.hpp"
#include "storage/sha256.hpp"
#include "storage/single_file.hpp"
#include "tests/storage/support.hpp"

namespace opponens::storage::test {
namespace {

/// Bytes of a file that has contents only, of one object; forged ones get the id that fits them.
class Forgery {
 public:
  explicit Forgery(const Record& record, const ArrayOffsets& arrays = {}) : arrays_(8 * arrays.size()) {
    ContentsBuilder builder;
    builder.add(record, std::string(64, '0'), arrays);
    const auto bytes = builder.finish(0);
    text_.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  void replace(const std::string& from, const std::string& to) {
    ASSERT_EQ(from.size(), to.size());
    const std::size_t at = text_.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text_.replace(at, from.size(), to);
  }
  std::string& text() { return text_; }
  /// Only for records without arrays, whose places are no part of the hash.
  void fit_id() {
    ASSERT_EQ(arrays_, 0U);
    constexpr std::size_t kSkeleton = 16 + 8 + 64 + 8;
    constexpr std::size_t kAfter = 2 * 8 + 2 * 8 + 18;  // two starts, the trailer
    Sha256 hash;
    hash.update(std::as_bytes(std::span(text_)).subspan(kSkeleton, text_.size() - kSkeleton - kAfter));
    text_.replace(16 + 8, 64, hash.hex());
  }

 private:
  std::size_t arrays_;
  std::string text_;
};

Record scalars() {
  Record record{"document", "scalars", {}, {}};
  record.provenance.files = {{"file-a", "1"}, {"file-b", "2"}};
  record.fields["number-a"] = 1.0;
  record.fields["number-b"] = 2.0;
  return record;
}

std::string refusal(const fs::path& path, const std::string& bytes) {
  spill(path, bytes);
  const ReadOnlyFile file(path);
  const auto contents = ContentsReader::open(file);
  if (!contents) return "no contents";
  return message_of<StorageError>([&] { contents->read(0, contents->head(0).id); });
}

TEST(Contents, NamesHaveOneOrder) {
  const TemporaryDirectory directory;
  Forgery good(scalars());
  good.fit_id();
  EXPECT_EQ(refusal(directory / "good", good.text()), "no exception");
  for (const std::string what : {"file-", "number-"}) {
    Forgery swapped(scalars());
    swapped.replace(what + "a", what + "c");  // b, which follows, comes before it
    swapped.fit_id();
    EXPECT_TRUE(contains(refusal(directory / "swapped", swapped.text()), {"swapped", "not in order of name"}));
    Forgery twice(scalars());
    twice.replace(what + "b", what + "a");
    twice.fit_id();
    EXPECT_TRUE(contains(refusal(directory / "twice", twice.text()), {"not in order of name"}));
  }
}

TEST(Contents, WhatThisProgramWouldNotWriteIsNotTaken) {
  const TemporaryDirectory directory;
  Forgery forged(scalars());
  forged.replace("scalars", "scalar\xFF");
  forged.fit_id();
  spill(directory / "forged.h5", forged.text());
  Store store(directory / "store", true);
  const std::string text = message_of<InputError>(
      [&] { import_single_file(directory / "forged.h5", store, [](std::size_t, std::size_t) {}); });
  EXPECT_TRUE(contains(text, {"forged.h5: object " + forged.text().substr(24, 64), "name", "not UTF-8"}));
  EXPECT_TRUE(store.list().empty());
}

/// Each array fits into the file, all at the same place; together they would take a hundred times its size.
TEST(Contents, ArraysTogetherAreNoLargerThanTheFile) {
  const TemporaryDirectory directory;
  constexpr Eigen::Index kValues = 4000;
  Record record{"document", "arrays", {}, {}};
  for (int i = 0; i < 100; ++i) {
    record.fields.emplace("array" + std::to_string(100 + i), Eigen::VectorXd(Eigen::VectorXd::Zero(kValues)));
  }
  Forgery forged(record, ArrayOffsets(100, 0));
  const std::string bytes = std::string(8 * kValues, '\0');
  spill(directory / "forged", bytes + forged.text());  // salvage needs no table
  EXPECT_TRUE(salvage(ReadOnlyFile(directory / "forged")).empty());
  ContentsBuilder builder;
  builder.add(record, content_hash(record), ArrayOffsets(100, 0));
  const auto contents = builder.finish(bytes.size());
  EXPECT_TRUE(contains(
      refusal(directory / "sum", bytes + std::string(reinterpret_cast<const char*>(contents.data()), contents.size())),
      {"arrays", "larger than the file"}));
}

/// Found by fuzzing: Eigen goes through the rows even where they are empty.
TEST(Contents, MatricesWithoutValuesTakeNoTimeHoweverLong) {
  const TemporaryDirectory directory;
  constexpr Eigen::Index kRows = Eigen::Index{1} << 40;
  Record record{"document", "empty", {}, {}};
  record.fields.emplace("matrix", Eigen::MatrixXd(kRows, 0));
  ContentsBuilder builder;
  builder.add(record, content_hash(record), {0});
  const auto bytes = builder.finish(0);
  EXPECT_EQ(refusal(directory / "empty", {reinterpret_cast<const char*>(bytes.data()), bytes.size()}), "no exception");
}

}  // namespace
}  // namespace opponens::storage::test
