// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cli/console.hpp"
#include "cli/json.hpp"
#include "cli/stored.hpp"
#include "robot/hand_mapping.hpp"

namespace opponens::cli {

/// How the channels of one cluster are calibrated, and from which recordings.
struct Calibration {
  robot::ChannelCalibration channels;
  std::vector<std::string> recordings;  ///< ids
};
using Calibrations = std::map<std::string, Calibration>;

/// Value of a label; empty where the recording has none.
std::string label_of(const Demonstration& motion, const std::string& name);

Calibrations calibrate(const std::vector<Stored<Demonstration>>& motions, const robot::RobotModel& human);

/// The identity for a recording whose channels need none.
Calibration calibration_of(const Demonstration& motion, const Calibrations& calibrations);

/// What a mapped motion is made from: its recording first, then the others that its calibration rests on.
std::vector<std::string> inputs_of(const std::string& recording, const Calibration& calibration);

/// Channels that only flicker, by the recordings that are calibrated together; [{recordings, channels}].
Json still_json(const Calibrations& calibrations);
void say_still(const Calibrations& calibrations, const Console& console);

}  // namespace opponens::cli
