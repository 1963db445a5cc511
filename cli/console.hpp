// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace opponens::cli {

/// Thrown by Progress when the user interrupted; main turns it into exit code 130.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted; what was finished is kept") {}
};

/// Set by SIGINT and SIGTERM.
extern std::atomic<bool> interrupt_requested;
void catch_interrupts();

/// With commas between.
std::string joined(const std::vector<std::string>& names);

/// What a command says to a person: sentences on stdout, or one JSON document there (--json) and nothing else.
class Console {
 public:
  Console(bool json, bool quiet) : json_(json), quiet_(quiet) {}

  bool json() const { return json_; }
  /// A line for a person; swallowed by --quiet and --json.
  void say(const std::string& line) const;
  /// The result document; printed only with --json.
  void document(const std::string& json_text) const;
  /// A line on stderr that --quiet does not hide.
  static void warn(const std::string& line);
  /// A line on stderr that --quiet hides.
  void advise(const std::string& line) const;
  bool shows_progress() const;

 private:
  bool json_;
  bool quiet_;
};

/// A progress line on stderr with an estimate of the time left; only on a terminal. Throws Interrupted on update.
class Progress {
 public:
  Progress(const Console& console, std::string label);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void update(std::int64_t done, std::int64_t total);
  /// update() in the form in which libraries tell how far they are; not to outlive this object.
  std::function<void(std::size_t, std::size_t)> counter();

 private:
  std::string label_;
  bool shown_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point begin_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace opponens::cli
