// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/in_parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace opponens::grasp {

void in_parallel(int threads, int count, const std::function<void(int)>& work) {
  std::atomic<int> next{0};
  std::mutex guard;
  std::exception_ptr error;
  const auto run = [&] {
    try {
      for (int i = next++; i < count; i = next++) work(i);
    } catch (...) {
      const std::lock_guard lock(guard);
      if (!error) error = std::current_exception();
      next = count;
    }
  };
  {
    std::vector<std::jthread> workers;
    for (int t = 1; t < std::min(threads, count); ++t) workers.emplace_back(run);
    run();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace opponens::grasp
