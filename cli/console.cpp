// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/console.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdio>

namespace opponens::cli {

std::atomic<bool> interrupt_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

void catch_interrupts() {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::signal(signal, [](int number) {
      // A second signal ends the program at once.
      if (interrupt_requested.exchange(true)) {
        std::signal(number, SIG_DFL);
        std::raise(number);
      }
    });
  }
}

std::string joined(const std::vector<std::string>& names) {
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

void Console::say(const std::string& line) const {
  if (!json_ && !quiet_) std::printf("%s\n", line.c_str());
}

void Console::document(const std::string& json_text) const {
  if (json_) std::printf("%s\n", json_text.c_str());
}

void Console::warn(const std::string& line) { std::fprintf(stderr, "opponens: %s\n", line.c_str()); }

void Console::advise(const std::string& line) const {
  if (!quiet_) warn("note: " + line);
}

bool Console::shows_progress() const { return !quiet_ && isatty(STDERR_FILENO) == 1; }

Progress::Progress(const Console& console, std::string label)
    : label_(std::move(label)),
      shown_(console.shows_progress()),
      begin_(std::chrono::steady_clock::now()),
      last_(begin_) {}

Progress::~Progress() {
  if (drawn_) std::fprintf(stderr, "\r\033[K");
}

std::function<void(std::size_t, std::size_t)> Progress::counter() {
  return [this](std::size_t done, std::size_t total) {
    update(static_cast<std::int64_t>(done), static_cast<std::int64_t>(total));
  };
}

void Progress::update(std::int64_t done, std::int64_t total) {
  if (interrupt_requested) throw Interrupted();
  const auto now = std::chrono::steady_clock::now();
  if (!shown_ || total <= 0 || now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  drawn_ = true;
  const double elapsed = std::chrono::duration<double>(now - begin_).count();
  const double left = done > 0 ? elapsed * static_cast<double>(total - done) / static_cast<double>(done) : 0.0;
  std::fprintf(stderr, "\r\033[K%s: %lld of %lld, at most %.0f s left", label_.c_str(), static_cast<long long>(done),
               static_cast<long long>(total), left);
  std::fflush(stderr);
}

}  // namespace opponens::cli
