// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <malloc.h>

#include <chrono>
#include <set>

#include "tests/storage/process.hpp"
#include "tests/storage/support.hpp"

namespace opponens::storage::test {
namespace {

/// Commits one record after another until it is killed; tells each number on the pipe once commit has returned.
void commit_forever(const fs::path& path, int first, int pipe) {
  Store store(path, true);
  for (int number = first;; ++number) {
    store.commit({small_record(number)});
    if (::write(pipe, &number, sizeof number) != sizeof number) return;
  }
}

TEST(KilledWriter, NothingAcknowledgedIsLostAndNothingIsDamaged) {
  const TemporaryDirectory directory;
  const fs::path path = directory / "store";
  Rng rng = stream(3, "kill");
  std::set<int> acknowledged;
  int leftovers = 0;
  int first = 0;
  std::uint64_t commit_us = 20000;  // as last measured; each kill comes within one commit's time of an acknowledged one
  for (int kills = 0; kills < 120; ++kills) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const auto started = std::chrono::steady_clock::now();
    const pid_t child = start([&] { commit_forever(path, first, ends[1]); });
    ::close(ends[1]);
    int number = 0;
    const int awaited = static_cast<int>(rng.index(4));
    for (int i = 0; i < awaited && ::read(ends[0], &number, sizeof number) == sizeof number; ++i) {
      acknowledged.insert(number);
      commit_us =
          static_cast<std::uint64_t>((std::chrono::steady_clock::now() - started) / std::chrono::microseconds(i + 1));
    }
    ::usleep(static_cast<useconds_t>(rng.index(commit_us)));
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "it has to be killed, not to end";
    while (::read(ends[0], &number, sizeof number) == sizeof number) acknowledged.insert(number);
    ::close(ends[0]);
    if (!acknowledged.empty()) first = *acknowledged.rbegin() + 1;
    if (!fs::exists(path)) continue;
    for (const auto& entry : fs::directory_iterator(path)) {
      leftovers += entry.path().filename().string().starts_with(".tmp-") ? 1 : 0;
    }
  }
  Store store(path, true);
  EXPECT_EQ(store.check(), std::vector<std::string>{});
  for (const int number : acknowledged) {
    EXPECT_TRUE(same(store.read(content_hash(small_record(number))), small_record(number)));
  }
  EXPECT_GE(acknowledged.size(), 100U);
  EXPECT_GT(leftovers, 0) << "no kill fell inside a commit";
  std::cout << acknowledged.size() << " commits acknowledged, " << leftovers << " temporary files seen\n";
  store.commit({small_record(-1)});
  for (const auto& [name, bytes] : contents(path)) EXPECT_FALSE(name.starts_with(".tmp-")) << name;
}

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
