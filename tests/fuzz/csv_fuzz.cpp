// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// CSV with a header: as it lies, transposed, and cut into runs. The first byte chooses.
#include <array>
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/tables.hpp"

using namespace opponens::storage;

namespace {

SourceDescription description(const std::string& table) {
  return parse_source("name: fuzz\nrecordings: {files: '(.*)', parts: [object]}\nlabels: {object: object}\n" + table +
                          "unit: deg\nwrap: true\nignore: [c]\n"
                          "channels: [{column: a, joint: I_MCP, sign: -1}, {column: b, joint: I_PIP}]\n",
                      "fuzz.yaml");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::array<SourceDescription, 3> sources{
      description("table: {format: csv}\ntime: {column: t}\nsplit: where_time_goes_back\n"
                  "trim: {speed: 0.001, window: 0.1}\n"),
      description("table: {format: csv, transposed: true}\ntime: {column: t}\n"),
      description("table: {format: csv, run_by: [d, e]}\ntime: none\n"),
  };
  if (size == 0) return 0;
  fuzz::read(std::string(reinterpret_cast<const char*>(data) + 1, size - 1), sources.at(data[0] % sources.size()));
  return 0;
}
