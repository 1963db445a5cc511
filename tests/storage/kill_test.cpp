// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
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

struct Kills {
  std::set<int> acknowledged;
  int leftovers = 0;
  std::size_t most_files = 0;
};

/// Starts a writer again and again and kills it within one commit's time of an acknowledged commit.
Kills kill_writers(const fs::path& path, int kills, Rng& rng) {
  Kills result;
  std::uint64_t commit_us = 20000;  // as last measured
  for (int kill = 0; kill < kills; ++kill) {
    int ends[2];
    EXPECT_EQ(::pipe(ends), 0);
    const int first = result.acknowledged.empty() ? 0 : *result.acknowledged.rbegin() + 1;
    const auto started = std::chrono::steady_clock::now();
    const pid_t child = start([&] { commit_forever(path, first, ends[1]); });
    ::close(ends[1]);
    int number = 0;
    const int awaited = static_cast<int>(rng.index(4));
    for (int i = 0; i < awaited && ::read(ends[0], &number, sizeof number) == sizeof number; ++i) {
      result.acknowledged.insert(number);
      commit_us =
          static_cast<std::uint64_t>((std::chrono::steady_clock::now() - started) / std::chrono::microseconds(i + 1));
    }
    ::usleep(static_cast<useconds_t>(rng.index(commit_us)));
    ::kill(child, SIGKILL);
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status)) << "it has to be killed, not to end";
    while (::read(ends[0], &number, sizeof number) == sizeof number) result.acknowledged.insert(number);
    ::close(ends[0]);
    if (!fs::exists(path)) continue;
    std::size_t temporary = 0;
    for (const auto& entry : fs::directory_iterator(path)) {
      temporary += entry.path().filename().string().starts_with(".tmp-") ? 1 : 0;
    }
    result.leftovers += static_cast<int>(temporary);
    result.most_files = std::max(result.most_files, temporary);
  }
  return result;
}

TEST(KilledWriter, In500KillsNothingAcknowledgedIsLostAndNothingIsDamaged) {
  const TemporaryDirectory directory;
  const fs::path path = directory / "store";
  Rng rng = stream(3, "kill");
  const Kills kills = kill_writers(path, 500, rng);
  Store store(path, true);
  EXPECT_EQ(store.check(), std::vector<std::string>{});
  for (const int number : kills.acknowledged) {
    EXPECT_TRUE(same(store.read(content_hash(small_record(number))), small_record(number)));
  }
  EXPECT_GE(kills.acknowledged.size(), 400U);
  EXPECT_GT(kills.leftovers, 0) << "no kill fell inside a commit";
  EXPECT_LE(kills.most_files, 3U) << "what killed writers leave is removed by the next one";
  std::cout << kills.acknowledged.size() << " commits acknowledged, " << kills.leftovers << " temporary files seen\n";
  fs::remove(path / "index.bin");
  EXPECT_EQ(Store(path, false).list().size(), store.list().size()) << "the index was right";
  store.commit({small_record(-1)});
  for (const auto& [name, bytes] : contents(path)) EXPECT_FALSE(name.starts_with(".tmp-")) << name;
}

/// Two writers of common and own objects while four readers look: each sees whole objects only, and never fewer.
TEST(TwoWritersAndFourReaders, LoseNothing) {
  const TemporaryDirectory directory;
  const fs::path path = directory / "store";
  { const Store store(path, true); }
  constexpr int kCommits = 60;
  std::vector<pid_t> children;
  for (const int offset : {0, 1000}) {
    children.push_back(start([&, offset] {
      Store store(path, false);
      for (int i = 0; i < kCommits; ++i) store.commit({small_record(offset + i), small_record(10000 + i)});
    }));
  }
  for (int reader = 0; reader < 4; ++reader) {
    children.push_back(start([&] {
      std::size_t last = 0;
      while (last < 3U * kCommits) {
        const Store store(path, false);
        const auto entries = store.list();
        ASSERT_GE(entries.size(), last);
        last = entries.size();
        for (const auto& entry : entries) ASSERT_EQ(content_hash(store.read(entry.id)), entry.id);
      }
    }));
  }
  for (const pid_t child : children) EXPECT_TRUE(succeeded(child));
  const Store store(path, false);
  EXPECT_TRUE(store.check().empty());
  EXPECT_EQ(store.list().size(), 3U * kCommits);
}

}  // namespace
}  // namespace opponens::storage::test
