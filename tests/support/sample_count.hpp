// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace opponens {

/// How many samples a random test draws: all of them, or a twentieth under the address sanitizer. What holds for all is
/// shown by the release build; broken memory shows in few, and each takes ten times as long there.
constexpr int sample_count(int all) {
#ifdef __SANITIZE_ADDRESS__
  return all / 20;
#else
  return all;
#endif
}

}  // namespace opponens
