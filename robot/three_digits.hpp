// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header.

#include <string>

namespace opponens::robot {

/// A number for a sentence, with three significant digits: "0.0123", "1.5e-07".
std::string three_digits(double value);

}  // namespace opponens::robot
