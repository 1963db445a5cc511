// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

namespace opponens::grasp {

/// work(i) for i in [0, count) on that many threads, in any order; returns when all are done. The first exception ends
/// what has not begun and is thrown again.
void in_parallel(int threads, int count, const std::function<void(int)>& work);

}  // namespace opponens::grasp
