// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Inputs of the report that tests vary, and what every page has to be.

#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "report/report.hpp"
#include "tests/report/markup_check.hpp"
#include "tests/report/synthetic_report.hpp"

namespace opponens::report {

/// Made once: loading the models is most of the time.
inline const ReportInput& full() {
  static const ReportInput input = synthetic_report();
  return input;
}

/// The same with two groups, one grasp and two snapshots: quick to render.
inline const ReportInput& small() {
  static const ReportInput input = [] {
    ReportInput reduced = full();
    reduced.synergies->groups.resize(2);
    reduced.grasps->items.resize(1);
    reduced.path->pictures = 2;
    return reduced;
  }();
  return input;
}

inline bool contains(const std::string& page, const std::string& part) { return page.find(part) != std::string::npos; }

/// The page without tags and style sheet: what a person reads.
inline std::string words_of(const std::string& page) {
  std::string words;
  bool inside = false;
  for (const char c : page.substr(page.find("</style>"))) {
    inside = (inside || c == '<') && c != '>';
    words += inside || c == '>' ? ' ' : c;
  }
  return words;
}

inline void expect_sound(const std::string& page) {
  EXPECT_EQ(markup_problems(page), std::vector<std::string>{});
  static const std::regex kBadNumber(R"(\b(nan|inf|-nan|-inf)\b)");
  EXPECT_FALSE(std::regex_search(words_of(page), kBadNumber));
  for (const char* name : {"d", "points", "x", "y", "x1", "y1", "x2", "y2", "cx", "cy", "width", "height", "viewBox"}) {
    for (const auto& value : attribute_values(page, name)) {
      ASSERT_EQ(value.find("nan"), std::string::npos) << name;
      ASSERT_EQ(value.find("inf"), std::string::npos) << name;
      ASSERT_EQ(value.find("n/a"), std::string::npos) << name;
    }
  }
}

}  // namespace opponens::report
