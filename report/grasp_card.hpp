// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/grasp_drawing.hpp"
#include "report/html.hpp"
#include "report/report.hpp"

namespace opponens::report {

std::string words(ContactModel model);
std::string words(ClosureState state);

/// A quality convention as a sentence: contact model, friction, force unit, norm, torque scale and origin.
std::string convention_words(const QualityConvention& convention);

/// Three significant digits, or "none".
std::string optional_number(const std::optional<double>& value);

/// "along the synergies" or "free".
std::string posture_words(const Grasp& grasp);

/// Coloured dots with the names of the fingers whose links touch in a picture, and of the palm.
Markup finger_legend(const robot::RobotModel& hand);

/// A grasp with its pictures from several sides (none without a stage), its figures, and its contacts by finger and
/// link; positions and normals of the contacts behind a summary line. name: "Grasp 1 of family 2".
Markup grasp_card(const GraspStage* stage, const GraspItem& item, const std::string& name);

}  // namespace opponens::report
