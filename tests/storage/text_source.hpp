// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A text file and its description, for the tests of the readers.

#include <string>
#include <vector>

#include "core/require.hpp"
#include "storage/readers/source.hpp"
#include "tests/storage/support.hpp"

namespace opponens::storage::test {

/// Reads one text file "cup_s1.txt" through a description.
struct TextSource {
  TemporaryDirectory directory;
  std::string yaml;

  explicit TextSource(const std::string& rest, const std::string& text) {
    yaml = "name: made_up\nrecordings: {files: '([a-z]+)_s([0-9])\\.txt', parts: [object, subject]}\n" + rest;
    spill(directory / "data/cup_s1.txt", text);
  }
  std::vector<Recording> read() const { return read_source({directory / "data"}, parse_source(yaml, "made_up.yaml")); }
  std::string refusal() const {
    return message_of<InputError>([&] { read(); });
  }
};

inline const std::string kTwo = "channels: [{column: '2', joint: I_MCP}, {column: '3', joint: I_PIP}]\n";
inline const std::string kLabels = "labels: {object: object, subject: subject, hand: {constant: right}}\n";

}  // namespace opponens::storage::test
