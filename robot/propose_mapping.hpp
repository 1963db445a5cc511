// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "robot/hand_mapping.hpp"
#include "robot/robot_model.hpp"

namespace opponens::robot {

/// A first mapping from the human hand (models/human_hand) for a hand whose fingers are called thumb, index, middle,
/// ring or little: phalanges (propose_contacts.hpp) copy the flexion channels in the sense in which the finger closes,
/// the fingers' other joints are fitted to the fingertips, the thumb's measured from the index finger's base. Palm
/// axes: x out of the palm, z along the fingers. Empty when no finger has such a name, or the fingers do not tell the
/// palm's axes. Right for hands built like a human one; to be looked at before use.
std::optional<HandMapping> propose_mapping(const RobotModel& robot);

}  // namespace opponens::robot
