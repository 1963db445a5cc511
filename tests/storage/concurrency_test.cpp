// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <malloc.h>

#include <thread>

#include "tests/storage/process.hpp"
#include "tests/storage/support.hpp"

namespace opponens::storage::test {
namespace {

TEST(TwoWriters, LoseNothing) {
  const TemporaryDirectory directory;
  const fs::path path = directory / "store";
  { const Store store(path, true); }
  constexpr int kCommits = 60;
  const auto writer = [&](int offset) {
    return start([&, offset] {
      Store store(path, false);
      for (int i = 0; i < kCommits; ++i) store.commit({small_record(offset + i), small_record(10000 + i)});
    });
  };
  const pid_t first = writer(0);
  const pid_t second = writer(1000);
  // A reader meanwhile sees only whole objects.
  for (int i = 0; i < 20; ++i) {
    const Store reader(path, false);
    for (const auto& entry : reader.list()) EXPECT_EQ(content_hash(reader.read(entry.id)), entry.id);
  }
  EXPECT_TRUE(succeeded(first));
  EXPECT_TRUE(succeeded(second));
  const Store store(path, false);
  EXPECT_TRUE(store.check().empty());
  EXPECT_EQ(store.list().size(), 3U * kCommits);
  for (int i = 0; i < kCommits; ++i) {
    for (const int number : {i, 1000 + i, 10000 + i}) {
      EXPECT_TRUE(same(store.read(content_hash(small_record(number))), small_record(number)));
    }
  }
}

TEST(Threads, WithAStoreEachReadSideBySide) {
  const TemporaryDirectory directory;
  const fs::path path = directory / "store";
  std::vector<Record> records;
  for (int i = 0; i < 300; ++i) records.push_back(small_record(i));
  Store(path, true).commit(records);
  std::vector<std::size_t> right(4, 0);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < right.size(); ++t) {
    threads.emplace_back([&, t] {
      Store store(path, false);
      if (t == 3) store.commit({small_record(-1)});  // one writes meanwhile
      for (const auto& entry : store.list()) right[t] += content_hash(store.read(entry.id)) == entry.id ? 1 : 0;
    });
  }
  for (auto& thread : threads) thread.join();
  for (const std::size_t count : right) EXPECT_GE(count, records.size());
}

TEST(Determinism, EqualCommitsGiveEqualBytesWhateverTheHeapHolds) {
  const TemporaryDirectory directory;
  const auto write = [&](const std::string& name, int filler) {
    return succeeded(start([&, filler] {
      ::mallopt(M_PERTURB, filler);  // fills allocated memory: bytes that nobody set would show
      Rng rng = stream(4, "determinism");
      Store store(directory / name, true);
      for (int commit = 0; commit < 3; ++commit) {
        std::vector<Record> records;
        for (int i = 0; i < 30; ++i) records.push_back(any_record(rng));
        records.push_back(small_record(commit));
        records.back().fields["large"] = Eigen::MatrixXd(Eigen::MatrixXd::Constant(500, 23, 0.1 * commit));
        store.commit(records);
      }
    }));
  };
  ASSERT_TRUE(write("a", 0x55));
  ::sleep(1);  // a time stamp of whole seconds would differ
  ASSERT_TRUE(write("b", 0xAA));
  EXPECT_EQ(contents(directory / "a").size(), 4U);
  EXPECT_EQ(contents(directory / "a"), contents(directory / "b"));
}

}  // namespace
}  // namespace opponens::storage::test
