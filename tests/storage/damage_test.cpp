// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>

#include "core/require.hpp"
#include "storage/batch_file.hpp"
#include "storage/single_file.hpp"
#include "tests/storage/support.hpp"

namespace opponens::storage::test {
namespace {

struct DamagedStore {
  TemporaryDirectory directory;
  fs::path path = directory / "store";
  std::vector<Record> records{small_record(1), small_record(2)};
  std::vector<std::string> ids;
  std::string file;
  std::string bytes;

  DamagedStore() {
    Store store(path, true);
    ids = store.commit(records);
    file = only_batch(path);
    bytes = slurp(path / file);
  }

  /// Replaces the file's bytes and tells how many reads were refused; what is not refused must be right.
  int refusals(const std::string& damaged) const {
    spill(path / file, damaged);
    int refused = 0;
    const Store store(path, false);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      try {
        EXPECT_TRUE(same(store.read(ids[i]), records[i])) << "damage was returned as good";
      } catch (const StorageError& error) {
        EXPECT_TRUE(contains(error.what(), {file}));
        ++refused;
      }
    }
    return refused;
  }
};

/// Bits of objects and of what leads to them are found when they are read; the others (HDF5's own, which are read only
/// by others) by check().
TEST(Damage, EveryFlippedBitIsFoundOrHarmless) {
  const DamagedStore store;
  Rng rng = stream(5, "flip");
  int refused = 0;
  int harmless = 0;
  const std::size_t contents = store.bytes.find("opponens object\n");  // every byte from there on, some before
  for (std::size_t at = 0; at < store.bytes.size(); at += at < contents ? 19 : 1) {
    std::string damaged = store.bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << rng.index(8)));
    const int refusals = store.refusals(damaged);
    refused += refusals > 0 ? 1 : 0;
    harmless += refusals == 0 ? 1 : 0;
    if ((refused + harmless) % 40 != 0) continue;
    ASSERT_EQ(Store(store.path, false).check().size(), 1U) << "byte " << at;
    fs::remove(store.path / "index.bin");
    ASSERT_EQ(store.refusals(damaged), 2) << "byte " << at << ": without an index the whole file is checked first";
    ASSERT_THROW(Store(store.path, false).list(), StorageError);
    spill(store.path / store.file, store.bytes);
    ASSERT_EQ(Store(store.path, false).list().size(), 2U);
  }
  std::cout << refused << " bytes whose change was refused, " << harmless << " whose change did no harm\n";
  EXPECT_GT(refused, 600);
  EXPECT_EQ(store.refusals(store.bytes), 0);
}

TEST(Damage, EveryTruncationIsFound) {
  const DamagedStore store;
  for (std::size_t size = 0; size < store.bytes.size(); size += 211) {
    EXPECT_EQ(store.refusals(store.bytes.substr(0, size)), 2) << size;
  }
  EXPECT_EQ(store.refusals(store.bytes + std::string(1, '\0')), 2);
}

/// A file of another maker has no contents: it is read by libhdf5 after its bytes were checked.
TEST(Damage, AFileWithoutContentsIsReadByItsHdf5PartAndCheckedWhole) {
  DamagedStore store;
  const std::size_t end = store.bytes.find("opponens object\n");
  ASSERT_NE(end, std::string::npos);
  const std::string plain = store.bytes.substr(0, end);
  fs::remove(store.path / store.file);
  fs::remove(store.path / "index.bin");
  store.file = batch_file_name(0, std::as_bytes(std::span(plain)));
  EXPECT_EQ(store.refusals(plain), 0);
  for (std::size_t at = 0; at < plain.size(); at += 23) {
    std::string damaged = plain;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    EXPECT_EQ(store.refusals(damaged), 2) << "byte " << at;
  }
}

TEST(Damage, ContentHashFindsWhatAMatchingFileNameWouldHide) {
  const DamagedStore store;
  const double value = std::get<Eigen::VectorXd>(store.records[1].fields.at("values"))[7];
  std::string needle(sizeof value, '\0');
  std::memcpy(needle.data(), &value, sizeof value);
  const std::size_t at = store.bytes.find(needle);
  ASSERT_NE(at, std::string::npos);
  std::string damaged = store.bytes;
  damaged[at] = static_cast<char>(damaged[at] ^ 1);
  fs::remove(store.path / store.file);
  fs::remove(store.path / "index.bin");
  const std::string name = batch_file_name(0, std::as_bytes(std::span(damaged)));
  spill(store.path / name, damaged);
  const Store opened(store.path, false);
  EXPECT_TRUE(same(opened.read(store.ids[0]), store.records[0]));
  EXPECT_TRUE(contains(message_of<StorageError>([&] { opened.read(store.ids[1]); }),
                       {name, "/objects/000001", "record 2", "content hash"}));
  ASSERT_EQ(opened.check().size(), 1U);
}

TEST(Damage, IsReportedAndStopsWritingButWhatIsIntactCanBeRead) {
  const DamagedStore store;
  const std::string intact = Store(store.path, false).commit({small_record(3)}).front();
  spill(store.path / store.file, store.bytes.substr(0, 1000));
  fs::remove(store.path / "index.bin");
  Store opened(store.path, false);
  EXPECT_TRUE(contains(message_of<StorageError>([&] { opened.list(); }), {store.file, "truncated or damaged"}));
  EXPECT_TRUE(contains(message_of<StorageError>([&] { opened.commit({small_record(4)}); }), {store.file}));
  EXPECT_TRUE(contains(message_of<StorageError>([&] { opened.read(store.ids[0]); }), {store.file}));
  EXPECT_TRUE(same(opened.read(intact), small_record(3)));
  EXPECT_EQ(opened.check().size(), 1U);
}

/// bytes with one bit changed inside the values of the record.
std::string with_a_flipped_value(std::string bytes, const Record& record) {
  const double value = std::get<Eigen::VectorXd>(record.fields.at("values"))[7];
  std::string needle(sizeof value, '\0');
  std::memcpy(needle.data(), &value, sizeof value);
  const std::size_t at = bytes.find(needle);
  EXPECT_NE(at, std::string::npos);
  bytes.at(at) = static_cast<char>(bytes.at(at) ^ 1);
  return bytes;
}

TEST(Damage, WhatIsThereButDamagedDoesNotCountAsStored) {
  const DamagedStore store;
  spill(store.path / store.file, with_a_flipped_value(store.bytes, store.records[1]));
  Store opened(store.path, false);
  EXPECT_TRUE(contains(message_of<StorageError>([&] { opened.commit({store.records[1]}); }),
                       {store.file, "content hash", "; run opponens repair first"}));
  EXPECT_EQ(opened.commit({store.records[0], small_record(9)}).front(), store.ids[0]);

  TemporaryDirectory other;
  Store source(other / "source", true);
  source.commit({store.records[1]});
  const Step ignored = [](std::size_t, std::size_t) {};
  EXPECT_TRUE(contains(message_of<StorageError>([&] { merge_store(source, opened, ignored); }),
                       {store.file, "; run opponens repair first"}));
  export_single_file(source, source.list(), other / "single.h5", ignored);
  EXPECT_TRUE(contains(message_of<StorageError>([&] { import_single_file(other / "single.h5", opened, ignored); }),
                       {store.file, "; run opponens repair first"}));
}

TEST(Damage, AnIntactCopyIsReadWhereTheFirstIsDamaged) {
  const DamagedStore store;
  const Record* const record = &store.records[1];
  const auto bytes = encode_batch(std::span(&record, 1), std::span(&store.ids[1], 1));
  const std::string copy = batch_file_name(1, bytes);
  spill(store.path / copy, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  ASSERT_EQ(Store(store.path, false).list().size(), 2U);  // the index knows both
  spill(store.path / store.file, with_a_flipped_value(store.bytes, *record));
  Store opened(store.path, false);
  EXPECT_TRUE(same(opened.read(store.ids[1]), *record));
  EXPECT_EQ(opened.commit({*record}).front(), store.ids[1]);
  spill(store.path / copy, "");
  EXPECT_TRUE(contains(message_of<StorageError>([&] { opened.read(store.ids[1]); }), {store.file, "content hash"}));
}

TEST(Damage, AMissingFileIsNotForgotten) {
  const DamagedStore store;
  fs::remove(store.path / store.file);
  const Store opened(store.path, false);
  EXPECT_TRUE(contains(message_of<StorageError>([&] { opened.list(); }), {store.file, "missing", "2 object"}));
  ASSERT_EQ(opened.check().size(), 1U);
}

TEST(Damage, FilesOfOthersAreLeftAlone) {
  const DamagedStore store;
  spill(store.path / "report.html", "<html>");
  spill(store.path / "foreign.h5", "not ours");
  const Store opened(store.path, false);
  EXPECT_EQ(opened.list().size(), 2U);
  ASSERT_EQ(opened.check().size(), 1U);
  EXPECT_TRUE(contains(opened.check().front(), {"foreign.h5", "not named like a batch"}));
}

}  // namespace
}  // namespace opponens::storage::test
