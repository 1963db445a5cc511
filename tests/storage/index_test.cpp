// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/index.hpp"

#include "storage/catalog.hpp"
#include "tests/storage/support.hpp"

namespace opponens::storage::test {
namespace {

std::vector<IndexEntry> some_entries(Rng& rng, std::size_t count) {
  std::vector<IndexEntry> entries;
  for (std::size_t i = 0; i < count; ++i) {
    entries.push_back({content_hash(any_record(rng)), "kind " + std::to_string(rng.index(3)), any_text(rng), "", {}});
    for (std::uint64_t inputs = rng.index(4); inputs > 0; --inputs) entries.back().inputs.push_back(any_text(rng));
  }
  return entries;
}

void expect_equal(const IndexBlock& block, const std::string& file, const std::vector<IndexEntry>& entries) {
  EXPECT_EQ(block.file(), file);
  ASSERT_EQ(block.size(), entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const IndexEntry entry = block.entry(i);
    EXPECT_EQ(entry.id, entries[i].id);
    EXPECT_EQ(entry.kind, entries[i].kind);
    EXPECT_EQ(entry.name, entries[i].name);
    EXPECT_EQ(entry.file, file);
    EXPECT_EQ(entry.inputs, entries[i].inputs);
  }
}

TEST(Index, BlocksComeBack) {
  Rng rng = stream(11, "index");
  std::string bytes;
  std::vector<std::vector<IndexEntry>> all;
  for (const std::size_t count : {3U, 0U, 40U}) {
    all.push_back(some_entries(rng, count));
    bytes += encode_index_block("file " + std::to_string(count), all.back());
  }
  const ParsedIndex parsed = parse_index(bytes);
  EXPECT_EQ(parsed.valid_bytes, bytes.size());
  ASSERT_EQ(parsed.blocks.size(), 3U);
  expect_equal(parsed.blocks[0], "file 3", all[0]);
  expect_equal(parsed.blocks[1], "file 0", all[1]);
  expect_equal(parsed.blocks[2], "file 40", all[2]);
}

TEST(Index, EveryFlippedBitAndEveryCutIsFound) {
  Rng rng = stream(12, "index");
  const std::string first = encode_index_block("first", some_entries(rng, 2));
  const std::string second = encode_index_block("second", some_entries(rng, 5));
  for (std::size_t bit = 0; bit < 8 * second.size(); ++bit) {
    std::string damaged = first + second;
    char& byte = damaged[first.size() + bit / 8];
    byte = static_cast<char>(byte ^ (1 << (bit % 8)));
    const ParsedIndex parsed = parse_index(damaged);
    ASSERT_EQ(parsed.blocks.size(), 1U) << "bit " << bit;
    ASSERT_EQ(parsed.valid_bytes, first.size());
  }
  for (std::size_t size = 0; size < second.size(); ++size) {
    ASSERT_EQ(parse_index(first + second.substr(0, size)).blocks.size(), 1U) << size;
  }
}

TEST(Index, NumbersThatLeadOutsideAreRefusedThoughTheSumFits) {
  Rng rng = stream(13, "index");
  const std::string good = encode_index_block("file", some_entries(rng, 6));
  int refused = 0;
  for (std::size_t at = 24; at + 4 <= good.size(); at += 4) {
    std::string bytes = good;
    bytes.replace(at, 4, "\xFF\xFF\xFF\x7F");
    seal_index_block(bytes);
    const ParsedIndex parsed = parse_index(bytes);
    refused += parsed.blocks.empty() ? 1 : 0;
    for (const auto& block : parsed.blocks) {
      for (std::size_t i = 0; i < block.size(); ++i) EXPECT_EQ(block.entry(i).id.size(), 64U);  // no crash (ASan)
    }
  }
  EXPECT_GT(refused, 30);
}

TEST(Index, IdsHaveToBeHashes) {
  EXPECT_THROW(static_cast<void>(encode_index_block("file", {{"xyz", "kind", "", "", {}}})), StorageError);
  EXPECT_THROW(static_cast<void>(encode_index_block("file", {{std::string(64, 'g'), "kind", "", "", {}}})),
               StorageError);
  EXPECT_THROW(static_cast<void>(encode_index_block("file", {{std::string(66, 'a'), "kind", "", "", {}}})),
               StorageError);
}

TEST(Catalog, AnObjectInTwoFilesCountsOnceAndFilesKeepTheirOrder) {
  Rng rng = stream(14, "catalog");
  const auto entries = some_entries(rng, 4);
  Catalog catalog;
  catalog.append("b", {entries[2], entries[0]});
  catalog.append("a", {entries[0], entries[1]});
  catalog.append("c", {entries[3]});
  EXPECT_TRUE(catalog.arrange({"a", "b", "c"}).gone.empty());
  std::vector<std::string> ids;
  for (const auto& entry : catalog.list("")) ids.push_back(entry.id);
  EXPECT_EQ(ids, (std::vector<std::string>{entries[0].id, entries[1].id, entries[2].id, entries[3].id}));
  EXPECT_EQ(catalog.find(entries[0].id).size(), 1U);
  EXPECT_EQ(catalog.entry(catalog.find(entries[0].id)[0]).file, "a");
  EXPECT_EQ(catalog.find("").size(), 2U);
  const auto changes = catalog.arrange({"a", "c", "d"});
  EXPECT_EQ(changes.unknown, std::vector<std::string>{"d"});
  ASSERT_EQ(changes.gone.size(), 1U);
  EXPECT_EQ(changes.gone[0].file, "b");
  EXPECT_EQ(catalog.find(entries[2].id).size(), 0U);
}

TEST(Store, CommitsAppendToTheIndexOfAnotherWriter) {
  const TemporaryDirectory directory;
  const fs::path path = directory / "store";
  Store first(path, true);
  Store second(path, false);
  for (int i = 0; i < 6; ++i) {
    const std::string before = slurp(path / kIndexName);
    (i % 2 == 0 ? first : second).commit({small_record(i)});
    EXPECT_TRUE(slurp(path / kIndexName).starts_with(before)) << "appended to, not made anew";
  }
  EXPECT_EQ(parse_index(slurp(path / kIndexName)).blocks.size(), 6U);
  EXPECT_EQ(Store(path, false).list().size(), 6U);
}

}  // namespace
}  // namespace opponens::storage::test
