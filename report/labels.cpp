// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/labels.hpp"

#include <algorithm>
#include <cmath>

#include "report/text.hpp"

namespace opponens::report {
namespace {

constexpr double kLine = 13.0;       // px from one label to the next
constexpr double kInset = 6.0;       // px from the window's edge to the text
constexpr double kLabelFont = 10.5;  // px

/// Heights as near to the wanted ones (ascending) as a least distance allows: neighbours that are too near are spread
/// about their mean, and everything is kept in [low, high].
std::vector<double> spread(const std::vector<double>& wanted, double low, double high) {
  struct Block {
    double sum;  ///< of the members' wanted heights less their offsets
    std::size_t count;
    double begin() const { return sum / static_cast<double>(count); }
  };
  std::vector<Block> blocks;
  for (const double y : wanted) {
    blocks.push_back({y, 1});
    while (blocks.size() > 1) {
      Block& before = blocks[blocks.size() - 2];
      const Block& last = blocks.back();
      if (before.begin() + kLine * static_cast<double>(before.count) <= last.begin()) break;
      const double shift = kLine * static_cast<double>(before.count);
      before.sum += last.sum - shift * static_cast<double>(last.count);
      before.count += last.count;
      blocks.pop_back();
    }
  }
  std::vector<double> placed;
  for (const Block& block : blocks) {
    for (std::size_t i = 0; i < block.count; ++i) placed.push_back(block.begin() + kLine * static_cast<double>(i));
  }
  for (std::size_t i = 0; i < placed.size(); ++i) {
    placed[i] = std::max(placed[i], i == 0 ? low : placed[i - 1] + kLine);
  }
  for (std::size_t i = placed.size(); i-- > 0;) {
    placed[i] = std::min(placed[i], i + 1 == placed.size() ? high : placed[i + 1] - kLine);
  }
  return placed;
}

void draw_side(Svg& svg, std::vector<Label> labels, double width, double height, bool left) {
  std::stable_sort(labels.begin(), labels.end(), [](const Label& a, const Label& b) { return a.at.y() < b.at.y(); });
  std::vector<double> wanted;
  for (const Label& label : labels) wanted.push_back(label.at.y());
  const std::vector<double> placed = spread(wanted, kLine, height - 4.0);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const double x = left ? kInset : width - kInset;
    const double reach = text_width(labels[i].text, kLabelFont) + 3.0;
    const double end = left ? x + reach : x - reach;
    svg.line(end, placed[i], labels[i].at.x(), labels[i].at.y(),
             concat({"stroke=\"", labels[i].color, "\" stroke-width=\".7\" stroke-opacity=\".75\""}));
    svg.text(x, placed[i] + 3.5, labels[i].text,
             concat({"font-size=\"10.5\" text-anchor=\"", left ? "start" : "end", "\""}));
  }
}

}  // namespace

void draw_labels(Svg& svg, std::vector<Label> labels, double width, double height) {
  std::stable_sort(labels.begin(), labels.end(), [](const Label& a, const Label& b) { return a.at.x() < b.at.x(); });
  const auto room = static_cast<std::size_t>(height / kLine);
  std::size_t left = 0;
  while (left < labels.size() && labels[left].at.x() < 0.5 * width) ++left;
  // Neither side more than two thirds, and no more than there is room for.
  const std::size_t most = std::min(room, (2 * labels.size() + 2) / 3);
  left = std::min(left, most);
  if (labels.size() > most) left = std::max(left, labels.size() - most);
  const auto middle = labels.begin() + static_cast<std::ptrdiff_t>(left);
  draw_side(svg, {labels.begin(), middle}, width, height, true);
  draw_side(svg, {middle, labels.end()}, width, height, false);
}

}  // namespace opponens::report
