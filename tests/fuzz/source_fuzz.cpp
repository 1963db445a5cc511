// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Source YAML: whatever is accepted has channels with different joints, and labels that do not contradict each other.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <set>

#include "core/require.hpp"
#include "storage/readers/source.hpp"

using namespace opponens::storage;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const SourceDescription source = parse_source(std::string(reinterpret_cast<const char*>(data), size), "fuzz.yaml");
    std::set<std::string> joints;
    for (const auto& channel : source.channels) joints.insert(channel.joint);
    bool good = !joints.empty() && joints.size() == source.channels.size();
    for (const auto& [label, value] : source.constants) good = good && !source.labels.contains(label);
    if (!good) std::abort();
  } catch (const opponens::InputError&) {
  }
  return 0;
}
