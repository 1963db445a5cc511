// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

namespace opponens {

/// A file or the environment cannot be used as asked; what() names file, line or field, and the value. Exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws std::invalid_argument when a caller's contract is broken, in all builds. Where composing the message is
/// costly, pass a callable that returns it.
template <typename Message>
void require(bool condition, Message&& message) {
  if (condition) return;
  if constexpr (std::is_invocable_v<Message>) {
    throw std::invalid_argument(message());
  } else {
    throw std::invalid_argument(std::string(std::forward<Message>(message)));
  }
}

}  // namespace opponens
