// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace opponens {

/// Whether the address sanitizer watches: GCC defines a macro, Clang has a question.
constexpr bool is_address_sanitized() {
#ifdef __has_feature
#if __has_feature(address_sanitizer)
  return true;
#endif
#endif
#ifdef __SANITIZE_ADDRESS__
  return true;
#endif
  return false;
}

/// How many samples a random test draws: all of them, or a twentieth under the address sanitizer. What holds for all is
/// shown by the release build; broken memory shows in few, and each takes ten times as long there.
constexpr int sample_count(int all) { return is_address_sanitized() ? all / 20 : all; }

}  // namespace opponens
