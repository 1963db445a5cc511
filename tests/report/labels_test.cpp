// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/labels.hpp"

#include <algorithm>
#include <map>
#include <regex>
#include <string>

#include <gtest/gtest.h>

#include "core/rng.hpp"

namespace opponens::report {
namespace {

struct Written {
  double x, y;
};

/// Where each text of a drawing stands.
std::map<std::string, Written> texts_of(const std::string& svg) {
  std::map<std::string, Written> texts;
  const std::regex text("<text x=\"([-0-9.]+)\" y=\"([-0-9.]+)\"[^>]*>([^<]*)</text>");
  for (std::sregex_iterator match(svg.begin(), svg.end(), text), end; match != end; ++match) {
    texts[(*match)[3]] = {std::stod((*match)[1]), std::stod((*match)[2])};
  }
  return texts;
}

/// Whatever the places: every name once, in the window, and none over another.
TEST(Labels, AreLegibleWhereverTheirPlacesAre) {
  Rng rng(3);
  for (int round = 0; round < 200; ++round) {
    const double width = 600.0;
    const double height = 400.0;
    const int count = 1 + static_cast<int>(rng.index(50));
    const bool crowded = round % 3 == 0;  // all places in one corner
    std::vector<Label> labels;
    for (int i = 0; i < count; ++i) {
      const double x = crowded ? rng.uniform(10, 40) : rng.uniform(0, width);
      const double y = crowded ? rng.uniform(380, 399) : rng.uniform(0, height);
      labels.push_back({{x, y}, "label_" + std::to_string(i), "#000"});
    }
    Svg svg(width, height, "labels");
    draw_labels(svg, labels, width, height);
    const auto texts = texts_of(svg.str());
    ASSERT_EQ(texts.size(), labels.size()) << round;
    std::map<bool, std::vector<double>> sides;
    for (const auto& [name, at] : texts) {
      EXPECT_GE(at.y, 10.0) << round << " " << name;
      EXPECT_LE(at.y, height) << round << " " << name;
      sides[at.x < 0.5 * width].push_back(at.y);
    }
    for (auto& [side, heights] : sides) {
      std::sort(heights.begin(), heights.end());
      for (std::size_t i = 1; i < heights.size(); ++i) {
        EXPECT_GE(heights[i] - heights[i - 1], 12.9) << round << ": one name over another";
      }
    }
  }
}

TEST(Labels, AFreeOneStandsAtItsHeight) {
  Svg svg(600, 400, "labels");
  draw_labels(svg, {{{100, 150}, "left", "#000"}, {{500, 222}, "right", "#000"}}, 600, 400);
  const auto texts = texts_of(svg.str());
  EXPECT_NEAR(texts.at("left").y, 153.5, 0.1);
  EXPECT_LT(texts.at("left").x, 100);
  EXPECT_NEAR(texts.at("right").y, 225.5, 0.1);
  EXPECT_GT(texts.at("right").x, 500);
}

}  // namespace
}  // namespace opponens::report
