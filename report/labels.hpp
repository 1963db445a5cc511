// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "report/svg.hpp"

namespace opponens::report {

struct Label {
  Eigen::Vector2d at;  ///< px, the place it belongs to
  std::string text;
  std::string color;  ///< CSS
};

/// Writes the labels into the margins left and right of a window of the given width and height (px), each on the side
/// where its place lies, in order of height, none over another, with a line from each to its place. A side that would
/// have more than two thirds of them hands those nearest to the middle to the other. Room for 2 height / 13 labels.
void draw_labels(Svg& svg, std::vector<Label> labels, double width, double height);

}  // namespace opponens::report
