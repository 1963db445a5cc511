// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Scanned objects (YCB), read from the shared data.
#include <gtest/gtest.h>

#include <filesystem>

#include "allegro.hpp"
#include "grasp/grasp_search.hpp"
#include "recheck.hpp"
#include "robot/mesh.hpp"

namespace opponens::grasp {
namespace {

class YcbSearch : public testing::TestWithParam<const char*> {};

TEST_P(YcbSearch, FindsForceClosure) {
  const std::string name = GetParam();
  const auto file = std::filesystem::path(OPPONENS_SHARED_DATA) / "data/objects/ycb" / name / (name + ".obj");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no mesh at " << file;
  const robot::Scene scene = test::scene_of(robot::load_mesh(file));
  const test::Synergies synergies = test::power_synergies();
  SearchSettings settings;
  settings.count = 2;
  settings.max_trials = 128;
  settings.threads = 2;
  const SearchResult result =
      search_grasps(test::allegro(), scene, "object", synergies.group, synergies.pre_grasp, settings, 1);
  ASSERT_FALSE(result.grasps.empty());
  for (const Grasp& grasp : result.grasps) test::recheck(grasp, test::allegro(), scene, synergies.group, settings);
}

INSTANTIATE_TEST_SUITE_P(Objects, YcbSearch,
                         testing::Values("006_mustard_bottle", "005_tomato_soup_can", "055_baseball"));

}  // namespace
}  // namespace opponens::grasp
