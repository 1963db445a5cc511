// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// The check that a MATLAB v5 file has to pass before matio sees it.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/require.hpp"
#include "storage/readers/mat_layout.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    opponens::storage::check_mat_layout({reinterpret_cast<const char*>(data), size}, "X", "fuzz.mat");
  } catch (const opponens::InputError&) {
  }
  return 0;
}
