// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Delimited text without a header: dates, ticks and raw counts, a fixed rate and transposed. The first byte chooses.
#include <array>
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/tables.hpp"

using namespace opponens::storage;

namespace {

SourceDescription description(const std::string& layout, const std::string& channels) {
  return parse_source("name: fuzz\nrecordings: {files: '(.*)', parts: [object]}\nlabels: {object: object}\n" + layout +
                          "channels: [" + channels + "]\n",
                      "fuzz.yaml");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::array<SourceDescription, 3> sources{
      description("table: {format: text, columns: 8}\ntime: {date: ['1', '2', '3', '4', '5', '6']}\n"
                  "split: where_time_goes_back\n",
                  "{column: '7', joint: I_MCP}, {column: '8', joint: I_PIP}"),
      description("table: {format: text, columns: 3, skip_lines: 1}\ntime: {column: '1', unit: 0.001}\nunit: raw\n"
                  "raw_range: [0, 1000]\nweight: recording\n",
                  "{column: '2', joint: I_MCP, rad: [0, 1]}, {column: '3', joint: I_PIP, raw: [9, 3], rad: [-1, 1]}"),
      description("table: {format: text, columns: 2, transposed: true}\ntime: {rate: 50}\nwrap: true\n",
                  "{column: '1', joint: I_MCP}, {column: '2', joint: I_PIP}"),
  };
  if (size == 0) return 0;
  fuzz::read(std::string(reinterpret_cast<const char*>(data) + 1, size - 1), sources.at(data[0] % sources.size()));
  return 0;
}
