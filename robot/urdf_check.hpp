// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

class TiXmlElement;

namespace opponens::robot {

/// Every number of the links and joints that a URDF parser reads is finite and there as often as it should be. urdfdom
/// would refuse the rest without naming the element, or leave the shape out. Throws InputError "file: line N: joint
/// 'j': <origin> xyz 'nan 0 0': expected 3 finite numbers".
void check_urdf_numbers(const std::filesystem::path& file, const TiXmlElement& robot);

}  // namespace opponens::robot
