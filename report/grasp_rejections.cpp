// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/grasp_rejections.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "report/svg.hpp"

namespace opponens::report {
namespace {

constexpr std::size_t kBars = 7;  // reasons with a bar of their own
constexpr double kWidth = 700.0;  // px
constexpr double kRow = 20.0;
constexpr double kLabels = 310.0;
constexpr double kFigures = 110.0;
constexpr double kFont = 12.0;

struct Bar {
  std::string label;
  std::int64_t trials = 0;
  bool kept = false;
};

double share_of(std::int64_t count, std::int64_t trials) {
  return trials > 0 ? static_cast<double>(count) / static_cast<double>(trials) : 0.0;
}

std::string share_words(std::int64_t count, std::int64_t trials) {
  const double share = share_of(count, trials);
  return percent(share, share > 0.0 && share < 0.01 ? 1 : 0);
}

/// The commonest causes (reasons where no causes are given); those beyond `shown` together, unless it is one alone.
std::vector<Bar> commonest(const GraspSearch& search, std::size_t shown) {
  std::vector<Bar> all;
  for (const auto& cause : search.causes) all.push_back({cause.name, cause.trials});
  if (all.empty()) {
    for (const auto& one : by_reason(search.rejected)) all.push_back({one.reason, one.trials});
  }
  if (all.size() <= shown + 1) return all;
  const Bar others{concat({"other reasons (", std::to_string(all.size() - shown), ")"}), 0};
  std::vector<Bar> bars(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(shown));
  bars.push_back(others);
  for (std::size_t i = shown; i < all.size(); ++i) bars.back().trials += all[i].trials;
  return bars;
}

/// The text cut to a width, with an ellipsis.
std::string fitted(const std::string& text, double width) {
  if (text_width(text, kFont) <= width) return text;
  std::size_t end = text.size();
  while (end > 0 && text_width(text.substr(0, end), kFont) > width - kFont) {
    do --end;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U);
  }
  return concat({text.substr(0, end), "\u2026"});
}

}  // namespace

std::vector<Rejection> by_reason(const std::map<std::string, std::int64_t>& rejected) {
  std::map<std::string, Rejection> grouped;
  for (const auto& [words, count] : rejected) {
    const std::size_t colon = words.find(": ");
    auto& entry = grouped[words.substr(0, colon)];
    entry.reason = words.substr(0, colon);
    entry.trials += count;
    if (colon == std::string::npos || count <= entry.of_bodies) continue;
    entry.bodies = words.substr(colon + 2);
    entry.of_bodies = count;
  }
  std::vector<Rejection> sorted;
  for (auto& [reason, entry] : grouped) sorted.push_back(std::move(entry));
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Rejection& a, const Rejection& b) { return a.trials > b.trials; });
  return sorted;
}

std::string rejection_words(const GraspSearch& search, std::size_t shown) {
  std::string words;
  for (const auto& bar : commonest(search, shown)) {
    words += concat({words.empty() ? "" : ", ", share_words(bar.trials, search.trials), " ", bar.label});
  }
  return words;
}

Markup rejection_chart(const GraspSearch& search) {
  std::vector<Bar> bars = commonest(search, kBars);
  std::int64_t rejected = 0;
  for (const auto& [reason, count] : search.rejected) rejected += count;
  if (search.trials <= 0) return {};
  if (rejected <= search.trials) bars.insert(bars.begin(), {"kept as grasps", search.trials - rejected, true});
  const std::string title = concat({"What became of the trials of group ", search.group});
  Svg svg(kWidth, kRow * static_cast<double>(bars.size()), title);
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const double top = kRow * static_cast<double>(i);
    const double length = (kWidth - kLabels - kFigures) * share_of(bars[i].trials, search.trials);
    svg.text(kLabels - 8.0, top + 14.5, fitted(bars[i].label, kLabels - 12.0), "class=\"axis\" text-anchor=\"end\"");
    svg.rect(kLabels, top + 3.0, std::max(1.0, length), kRow - 6.0,
             bars[i].kept ? "style=\"fill:var(--good)\"" : "style=\"fill:var(--s0)\"");
    svg.text(kLabels + std::max(1.0, length) + 6.0, top + 14.5,
             concat({share_words(bars[i].trials, search.trials), " (", grouped(bars[i].trials), ")"}),
             "class=\"axis\"");
  }
  return figure(svg.str(), concat({"What became of the ", grouped(search.trials), " trials of the search."}));
}

Markup rejection_table(const GraspSearch& search) {
  if (search.rejected.empty()) return {};
  Table causes("By cause", {"cause", "trials", "share", "what may help"});
  for (const auto& cause : search.causes) {
    causes.row({text(cause.name), text(grouped(cause.trials)), text(percent(share_of(cause.trials, search.trials))),
                text(cause.advice)});
  }
  Table table(concat({"Why trials were rejected, of ", grouped(search.trials)}),
              {"reason", "trials", "share", "most often"});
  for (const auto& one : by_reason(search.rejected)) {
    table.row({text(one.reason), text(grouped(one.trials)), text(percent(share_of(one.trials, search.trials))),
               text(one.bodies.empty() ? "" : concat({one.bodies, " (", grouped(one.of_bodies), ")"}))});
  }
  Markup out = causes.empty() ? Markup{} : causes.str();
  out += table.str();
  return out;
}

}  // namespace opponens::report
