// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

class TiXmlDocument;

namespace opponens::robot {

/// The whole of a text file; kind ("a URDF file") is what the complaint expected. Throws InputError when it is a
/// directory, cannot be opened or is longer than 64 MiB (a device would never end).
std::string read_text_file(const std::filesystem::path& file, const std::string& kind);

/// Parses XML text. Throws InputError naming file and line when it is not XML, or nested deeper than 200 elements: the
/// parser recurses, and a file of nothing but opening tags would exhaust the stack.
void parse_xml(const std::filesystem::path& file, const std::string& text, TiXmlDocument& document);

}  // namespace opponens::robot
