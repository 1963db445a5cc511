// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/readers/child_process.hpp"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iostream>
#include <memory>
#include <vector>

#include "core/require.hpp"
#include "tests/storage/support.hpp"

namespace opponens::storage::test {
namespace {

std::string refusal(const std::function<std::string()>& work, const ChildLimits& limits = {}) {
  return message_of<InputError>([&] { run_limited("some/file.mat", "MATLAB", work, limits); });
}

TEST(ChildProcess, GivesBackWhatTheWorkReturned) {
  const std::string large(3 << 20, 'x');
  EXPECT_EQ(run_limited("f", "HDF5", [&] { return large; }, {}), large);
  EXPECT_EQ(run_limited("f", "HDF5", [] { return std::string(); }, {}), "");
}

TEST(ChildProcess, ErrorsArePassedOnWithTheFile) {
  EXPECT_EQ(refusal([]() -> std::string { throw InputError("file.mat: no such variable"); }),
            "file.mat: no such variable");
  EXPECT_EQ(refusal([]() -> std::string { throw std::runtime_error("odd"); }), "some/file.mat: odd");
}

TEST(ChildProcess, DeathIsASentence) {
  const std::string begin = "some/file.mat: the reader of MATLAB files was ended by SIG";
  EXPECT_TRUE(contains(refusal([]() -> std::string {
                         std::signal(SIGABRT, SIG_DFL);
                         ::raise(SIGKILL);
                         return "";
                       }),
                       {begin + "KILL; the file is damaged"}));
  EXPECT_TRUE(contains(refusal([]() -> std::string { ::_exit(3); }), {"ended with status 3"}));
  EXPECT_TRUE(contains(refusal([]() -> std::string { ::_exit(0); }), {"sent back nothing of use"}));
}

TEST(ChildProcess, HangsEnd) {
  ChildLimits limits;
  limits.seconds = 0.2;
  EXPECT_TRUE(contains(refusal(
                           []() -> std::string {
                             while (true) ::pause();
                           },
                           limits),
                       {"some/file.mat", "did not end within"}));
}

TEST(ChildProcess, HangsAfterTheEndOfOutputEnd) {
  ChildLimits limits;
  limits.seconds = 0.3;
  EXPECT_TRUE(contains(refusal(
                           []() -> std::string {
                             for (int file = 3; file < 1024; ++file) ::close(file);
                             while (true) ::pause();
                           },
                           limits),
                       {"some/file.mat", "did not end within"}));
}

TEST(ChildProcess, DiesWithItsParent) {
  // Both hold the end of this pipe that is written to: the other end sees its end when neither lives.
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t parent = ::fork();
  if (parent == 0) {
    try {
      run_limited("f", "HDF5",
                  [&]() -> std::string {
                    if (::write(ends[1], "w", 1) != 1) ::_exit(1);
                    while (true) ::pause();
                  },
                  {});
    } catch (...) {
    }
    ::_exit(0);
  }
  ::close(ends[1]);
  char working = 0;
  EXPECT_EQ(::read(ends[0], &working, 1), 1);
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  pollfd wanted{ends[0], POLLIN, 0};
  constexpr int kPatience = 10000;  // ms; the child's own limit is 60 s
  EXPECT_EQ(::poll(&wanted, 1, kPatience), 1) << "the child lives on";
  ::close(ends[0]);
}

TEST(ChildProcess, TooMuchOutputIsRefused) {
  ChildLimits limits;
  limits.output = 1 << 20;
  EXPECT_TRUE(contains(refusal([] { return std::string(2 << 20, 'x'); }, limits), {"gave more than 1 MB"}));
}

/// AddressSanitizer reserves terabytes of address space, and fills memory itself.
bool is_sanitized() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages > (std::uint64_t{1} << 28);
}

TEST(ChildProcess, MemoryIsLimited) {
  if (is_sanitized()) GTEST_SKIP() << "under AddressSanitizer";
  ChildLimits limits;
  limits.memory = std::uint64_t{64} << 20;
  const auto hungry = [] { return std::to_string(std::vector<char>(std::size_t{1} << 30, 'x').size()); };
  EXPECT_EQ(refusal(hungry, limits), "some/file.mat: needs more memory than 64 MB");
  EXPECT_EQ(run_limited("f", "HDF5", hungry, {}), std::to_string(1 << 30));
}

TEST(ChildProcess, MemoryThatWasNotWrittenIsSeen) {
  if (is_sanitized()) GTEST_SKIP() << "under AddressSanitizer";
  const auto first = [](int fill) {
    ChildLimits limits;
    limits.memory_fill = fill;
    const auto work = [] {
      const std::unique_ptr<volatile char[]> memory(new volatile char[1000]);
      return std::to_string(memory[500]);  // what a damaged file can make a library do
    };
    return run_limited("f", "HDF5", work, limits);
  };
  EXPECT_NE(first(0x55), first(0x2B));
}

TEST(ChildProcess, NothingIsWrittenOrSaid) {
  const TemporaryDirectory directory;
  const std::string path = (directory / "made").string();
  ::testing::internal::CaptureStdout();
  EXPECT_TRUE(contains(refusal([&]() -> std::string {
                         std::cout << "chatter" << std::endl;
                         std::signal(SIGXFSZ, SIG_IGN);
                         std::ofstream file(path);
                         file << std::string(100, 'x') << std::flush;
                         throw std::runtime_error(file ? "written" : "not written");
                       }),
                       {"not written"}));
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace opponens::storage::test
