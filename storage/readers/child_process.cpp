// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/readers/child_process.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "core/require.hpp"
#include "storage/posix_file.hpp"
#include "storage/store.hpp"

namespace opponens::storage {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// First byte of what comes back.
constexpr char kResult = 'r';
constexpr char kRefusal = 'e';

/// B of address space. AddressSanitizer reserves terabytes, so that no limit of use can be set there.
std::uint64_t address_space() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void limit(int resource, std::uint64_t value) {
  const rlimit both{value, value};
  // A limit that is lower already stays.
  static_cast<void>(::setrlimit(static_cast<__rlimit_resource_t>(resource), &both));
}

void enter_limits(const ChildLimits& limits) {
  constexpr std::uint64_t kSanitized = std::uint64_t{1} << 40;
  const std::uint64_t now = address_space();
  if (now < kSanitized) limit(RLIMIT_AS, now + limits.memory);
  limit(RLIMIT_CPU, static_cast<std::uint64_t>(std::ceil(limits.seconds)));
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CORE, 0);
  // The parent decides what an interruption means, after this child is done.
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_IGN);
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL}) std::signal(signal, SIG_DFL);
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(nothing, stream);
}

/// Fills what is allocated from now on, and the free memory behind what is allocated already.
void fill_memory(int byte) {
  if (byte == 0) return;
  ::mallopt(M_PERTURB, byte);
  constexpr std::size_t kBlock = 64 << 10;  // below the size from which each gets pages of its own
  const std::vector<std::string> blocks(64, std::string(kBlock, static_cast<char>(byte)));
}

void send(int pipe, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t sent = ::write(pipe, bytes, count);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) ::_exit(1);
    bytes += sent;
    count -= static_cast<std::size_t>(sent);
  }
}

[[noreturn]] void be_child(int pipe, const std::function<std::string()>& work, const ChildLimits& limits) {
  enter_limits(limits);
  fill_memory(limits.memory_fill);
  char state = kRefusal;
  std::string answer;
  try {
    answer = work();
    state = kResult;
  } catch (const std::bad_alloc&) {
    answer = "needs more memory than " + std::to_string(limits.memory >> 20) + " MB";
  } catch (const std::exception& error) {
    answer = error.what();
  }
  send(pipe, &state, 1);
  send(pipe, answer.data(), answer.size());
  ::_exit(0);
}

/// The child and the end of the pipe that it writes to; both are gone when this is.
class Child {
 public:
  Child(const std::function<std::string()>& work, const ChildLimits& limits, const fs::path& file) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw_errno("cannot make a pipe for reading", file);
    const pid_t parent = ::getpid();
    id_ = ::fork();
    if (id_ == 0) {
      // Nobody is left to read what this process finds when its parent is killed.
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (::getppid() != parent) ::_exit(1);
      ::close(ends[0]);
      be_child(ends[1], work, limits);
    }
    const int error = errno;
    ::close(ends[1]);
    pipe_ = ends[0];
    if (id_ < 0) {
      ::close(pipe_);
      errno = error;
      throw_errno("cannot start a process for reading", file);
    }
  }
  ~Child() {
    ::close(pipe_);
    if (id_ > 0) {
      ::kill(id_, SIGKILL);
      while (::waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
      }
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  int pipe() const { return pipe_; }
  /// Its end, as waitpid tells it; none when it lives on until the deadline.
  std::optional<int> wait(Clock::time_point deadline) {
    int status = 0;
    while (true) {
      const pid_t ended = ::waitpid(id_, &status, WNOHANG);
      if (ended == id_) break;
      if (Clock::now() >= deadline) return {};
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    id_ = 0;
    return status;
  }

 private:
  pid_t id_ = -1;
  int pipe_ = -1;
};

std::string too_slow(const ChildLimits& limits) {
  return "did not end within " + std::to_string(std::lround(limits.seconds)) + " s";
}

/// All that comes through the pipe; a sentence in place of it when the child is too slow or says too much.
std::pair<std::string, std::string> receive(int pipe, const ChildLimits& limits, Clock::time_point deadline) {
  std::string bytes;
  std::string chunk(1 << 20, '\0');
  while (true) {
    const double left = std::chrono::duration<double>(deadline - Clock::now()).count();
    if (left <= 0.0) return {"", too_slow(limits)};
    pollfd wanted{pipe, POLLIN, 0};
    const int ready = ::poll(&wanted, 1, static_cast<int>(std::min(left * 1e3, 1e6)) + 1);
    if (ready <= 0) continue;  // interrupted, or time is up
    const ssize_t count = ::read(pipe, chunk.data(), chunk.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return {std::move(bytes), ""};
    if (bytes.size() + static_cast<std::size_t>(count) > limits.output) {
      return {"", "gave more than " + std::to_string(limits.output >> 20) + " MB"};
    }
    bytes.append(chunk.data(), static_cast<std::size_t>(count));
  }
}

std::string ending(int status) {
  if (WIFEXITED(status)) return "ended with status " + std::to_string(WEXITSTATUS(status));
  if (!WIFSIGNALED(status)) return "ended in an unknown way";
  const char* name = ::sigabbrev_np(WTERMSIG(status));
  return std::string("was ended by SIG") + (name == nullptr ? "?" : name);
}

}  // namespace

std::string run_limited(const fs::path& file, const std::string& kind, const std::function<std::string()>& work,
                        const ChildLimits& limits) {
  const std::string reader = file.string() + ": the reader of " + kind + " files ";
  const std::string advice = "; the file is damaged, or not of that kind";
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits.seconds));
  Child child(work, limits, file);
  auto [bytes, complaint] = receive(child.pipe(), limits, deadline);
  if (!complaint.empty()) throw InputError(reader + complaint + advice);
  const std::optional<int> status = child.wait(deadline);
  if (!status) throw InputError(reader + too_slow(limits) + advice);
  if (!WIFEXITED(*status) || WEXITSTATUS(*status) != 0) throw InputError(reader + ending(*status) + advice);
  if (bytes.empty() || (bytes[0] != kResult && bytes[0] != kRefusal)) {
    throw InputError(reader + "sent back nothing of use" + advice);
  }
  const bool refused = bytes[0] == kRefusal;
  bytes.erase(0, 1);
  if (!refused) return std::move(bytes);
  const bool named = bytes.find(file.filename().string()) != std::string::npos;
  throw InputError(named ? bytes : file.string() + ": " + bytes);
}

}  // namespace opponens::storage
