// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

class TiXmlElement;

namespace opponens::robot {

/// Every number of the links and joints that a URDF parser reads is finite and there as often as it should be. urdfdom
/// would refuse the rest without naming the element, or leave the shape out. Throws InputError "file: line N: joint
/// 'j': <origin> xyz 'nan 0 0': expected 3 finite numbers".
void check_urdf_numbers(const std::filesystem::path& file, const TiXmlElement& robot);

/// Takes away the <visual> and <collision> elements that hold no box, sphere, cylinder or mesh with a file name (a
/// capsule, an empty <geometry>): urdfdom would drop all shapes of their link without a word. Returns a note for each.
std::vector<std::string> drop_unknown_shapes(const std::filesystem::path& file, TiXmlElement& robot);

}  // namespace opponens::robot
