// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "storage/store.hpp"

namespace opponens::cli {

inline constexpr std::size_t kShortId = 12;  ///< digits of an id for a person
std::string short_id(const std::string& id);

/// Everything that a stored object holds.
nlohmann::json record_json(const std::string& id, const storage::Record& record);

/// {id, kind, name}, and more of the entry where a command adds it.
nlohmann::json entry_json(const storage::IndexEntry& entry);

/// Lines for a person: what it is, what it was made from, and every field with its shape and the range of its values.
std::vector<std::string> record_lines(const std::string& id, const storage::Record& record);

}  // namespace opponens::cli
