// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <exception>
#include <functional>
#include <iostream>

namespace opponens::storage::test {

/// Runs the action in a process of its own, which exits without running the parent's clean-up.
inline pid_t start(const std::function<void()>& action) {
  std::cout.flush();
  const pid_t child = ::fork();
  if (child != 0) return child;
  try {
    action();
    ::_exit(::testing::Test::HasFailure() ? 1 : 0);
  } catch (const std::exception& error) {
    std::cerr << "child: " << error.what() << std::endl;
    ::_exit(2);
  }
}

/// True when the process ended by itself with exit status 0.
inline bool succeeded(pid_t child) {
  int status = 0;
  return ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace opponens::storage::test
