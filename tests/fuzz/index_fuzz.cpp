// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "storage/index.hpp"

using opponens::storage::IndexBlock;
using opponens::storage::parse_index;

namespace {

/// Whatever is believed can be read in full.
void read_all(std::string_view bytes) {
  for (const IndexBlock& block : parse_index(bytes).blocks) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      if (block.entry(i).id.size() != 64) std::abort();
    }
  }
}

}  // namespace

/// The bytes as they are; and the same with size and sum made to fit, without which hardly any input gets past them.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  read_all(bytes);
  opponens::storage::seal_index_block(bytes);
  read_all(bytes);
  return 0;
}
