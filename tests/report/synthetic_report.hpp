// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "report/report.hpp"

namespace opponens::report {

/// A complete made-up input of realistic sizes on the models of this repository: five groups, grasps that only look
/// like grasps, a straight path in joint space. Its numbers mean nothing and its text says so.
ReportInput synthetic_report();

}  // namespace opponens::report
