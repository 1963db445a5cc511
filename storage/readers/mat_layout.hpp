// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: whether the bytes of a MATLAB v5 file are what they claim to be.

#include <filesystem>
#include <string>
#include <string_view>

namespace opponens::storage {

/// matio takes much on trust: it reads short data as zeros, and compressed data without their check sum. This walks
/// over every element of the file (MAT-File Format, MathWorks), inflates what is compressed to its end, and compares
/// every size with the type and dimensions that it belongs to in the variable of the given name, which has to be real
/// numbers or cells of them. Throws InputError "file: what, at byte N" when anything does not fit, or when the
/// variable is not there exactly once.
void check_mat_layout(std::string_view bytes, const std::string& variable, const std::filesystem::path& file);

}  // namespace opponens::storage
