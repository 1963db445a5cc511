// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "core/grasp.hpp"

namespace opponens {

struct ContactSet {
  std::string name;
  std::vector<Contact> contacts;
  QualityConvention convention;
};

/// Eighteen contacts around a cylinder of radius 40 mm, each normal off by about 10 degrees: no data needed.
ContactSet cylinder_of_eighteen();

/// The cases of 18 contacts and 8 edges of the reference file graspit_quality_cases.json; empty where it is absent.
std::vector<ContactSet> reference_sets_of_eighteen();

/// The contact sets of reference/graspit_ycb_top5 (ten objects, five grasps of the Allegro each); empty where absent.
std::vector<ContactSet> allegro_sets();

}  // namespace opponens
