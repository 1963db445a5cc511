// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace opponens::report {

/// What is wrong with an HTML page or an SVG, one sentence each: tags that do not balance, attributes without quotes or
/// twice, bare & or <, entities other than the five of XML and numbers, ids that occur twice.
std::vector<std::string> markup_problems(std::string_view markup);

/// Values of all attributes of a name, e.g. "href".
std::vector<std::string> attribute_values(std::string_view markup, std::string_view name);

}  // namespace opponens::report
