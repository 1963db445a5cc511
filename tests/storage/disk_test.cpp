// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "core/require.hpp"
#include "tests/storage/process.hpp"
#include "tests/storage/support.hpp"

namespace opponens::storage::test {
namespace {

Record noise(std::uint64_t seed, Eigen::Index count) {
  Rng rng(seed);
  Record record{"document", "noise", {}, {}};
  Eigen::VectorXd values(count);
  for (auto& value : values) value = rng.uniform();
  record.fields["values"] = std::move(values);
  return record;
}

/// The commit must fail with the given words and leave every file as it was; then a small one must work.
void expect_refused_and_unchanged(const fs::path& path, const std::string& words) {
  Store store(path, false);
  const auto before = contents(path);
  EXPECT_TRUE(contains(message_of<InputError>([&] {
                         store.commit({small_record(2), noise(1, 200000)});
                       }),
                       {path.string(), words}));
  EXPECT_EQ(contents(path), before);
  EXPECT_EQ(store.list().size(), 1U);
  store.commit({small_record(3)});
  EXPECT_TRUE(Store(path, false).check().empty());
  EXPECT_EQ(Store(path, false).list().size(), 2U);
}

TEST(Disk, FileSizeLimitIsReportedAndTheStoreUnchanged) {
  const TemporaryDirectory directory;
  const fs::path path = directory / "store";
  Store(path, true).commit({small_record(1)});
  EXPECT_TRUE(succeeded(start([&] {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{100000, 100000};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
    expect_refused_and_unchanged(path, "File too large");
  })));
}

TEST(Disk, FullDiskIsReportedAndTheStoreUnchanged) {
  const TemporaryDirectory directory;
  const fs::path disk = directory / "disk";
  fs::create_directory(disk);
  if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=400k") != 0) GTEST_SKIP() << "mounting is not permitted";
  Store(disk / "store", true).commit({small_record(1)});
  expect_refused_and_unchanged(disk / "store", "No space left on device");
  ::umount2(disk.c_str(), MNT_DETACH);
}

TEST(Disk, ReadOnlyDirectoryCanBeReadButNotWritten) {
  const TemporaryDirectory directory;
  const fs::path path = directory / "store";
  const std::string id = Store(path, true).commit({small_record(1)}).front();
  fs::remove(path / "index.bin");  // it cannot be rebuilt on disk either
  fs::create_directory(directory / "closed");
  ::chmod((directory / "").c_str(), 0755);
  ::chmod(path.c_str(), 0555);
  ::chmod((directory / "closed").c_str(), 0555);
  EXPECT_TRUE(succeeded(start([&] {
    // Permissions do not hold for root.
    ASSERT_TRUE(::getuid() != 0 || ::setuid(65534) == 0);
    Store store(path, false);
    EXPECT_TRUE(same(store.read(id), small_record(1)));
    EXPECT_TRUE(contains(message_of<InputError>([&] { store.commit({small_record(2)}); }),
                         {path.string(), "Permission denied"}));
    EXPECT_TRUE(
        contains(message_of<InputError>([&] { Store(directory / "closed", true); }), {"closed", "Permission denied"}));
    EXPECT_TRUE(contains(message_of<InputError>([&] { Store(directory / "closed" / "new", true); }),
                         {"closed/new", "Permission denied"}));
    EXPECT_TRUE(contains(message_of<InputError>([&] { store.log_run("{}"); }), {"runs.jsonl", "Permission denied"}));
  })));
  EXPECT_EQ(contents(path).size(), 1U);
  ::chmod(path.c_str(), 0755);
  ::chmod((directory / "closed").c_str(), 0755);
}

}  // namespace
}  // namespace opponens::storage::test
