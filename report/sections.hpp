// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "report/body_drawing.hpp"
#include "report/html.hpp"
#include "report/report.hpp"

namespace opponens::report {

// One function per section of the page: its content without the heading. A missing part gives a sentence.

Markup summary_section(const ReportInput& input);
Markup demonstration_section(const ReportInput& input);
Markup transition_section(const ReportInput& input);
Markup synergy_section(const ReportInput& input);
Markup synergy_drawing_section(const ReportInput& input);
Markup grasp_section(const ReportInput& input);
Markup path_section(const ReportInput& input);
/// Robot and scene along the path, of path_section. input: with path, robot and scene.
Markup path_snapshots(const ReportInput& input);
Markup verification_section(const ReportInput& input);
Markup provenance_section(const ReportInput& input);
Markup run_section(const ReportInput& input);

/// Throws std::invalid_argument when the sizes of a group do not fit the joint names.
void check_sizes(const SynergyPart& part);

/// Joint values over time as charts of at most `chunk` joints each, with vertical lines at the given times.
struct TimeMark {
  std::string label;
  double time;  ///< s
};
Markup joint_charts(const std::vector<std::string>& names, const Eigen::VectorXd& time, const std::string& time_label,
                    const Eigen::MatrixXd& values, const std::vector<TimeMark>& marks, int chunk);

/// Mean of the values that are there; nullopt when none is.
std::optional<double> mean_of(const std::vector<std::optional<double>>& values);

}  // namespace opponens::report
