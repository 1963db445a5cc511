// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: which objects were made last. An object that is made again, byte for byte, is not written again,
// so the order of the files cannot tell; a line of the run log does.

#include <string>
#include <vector>

#include "storage/store.hpp"

namespace opponens::storage {

/// The line of the run log of a commit that held objects which were there already: ids of all its objects, in order,
/// and the id of the object that was the last one in the store when they were made.
std::string production_line(const std::vector<std::string>& ids, const std::string& after);

/// entries: in order of commit. Returned: in the order in which they were made last. Lines that are not production
/// lines, cannot be read (a log cut off), or name what is not there are passed over.
std::vector<IndexEntry> in_order_of_production(std::vector<IndexEntry> entries, const std::string& run_log);

}  // namespace opponens::storage
