// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <optional>
#include <utility>

#include "motion/syn_planner.hpp"

namespace opponens::motion {
namespace {

/// Whether the gap between two graphs still shrinks.
class GapWatch {
 public:
  explicit GapWatch(double epsilon) : least_progress_(0.01 * epsilon) {}

  bool shrinks(double gap) {
    if (gap < smallest_ - least_progress_) {
      smallest_ = gap;
      idle_ = 0;
      return true;
    }
    return ++idle_ < kPatience;
  }

 private:
  /// Two extensions of each graph: the first step into a box may widen the gap for a moment.
  static constexpr int kPatience = 4;
  double least_progress_;
  double smallest_ = std::numeric_limits<double>::infinity();
  int idle_ = 0;
};

/// Two graphs as CONNECT was given them, one of which grows towards a vertex of the other.
struct Sides {
  const Graph* a;
  const Graph* growing;
  const Graph* other;
};

/// What an extension that did not reach its target tells of the gap between the graphs.
void note_gap(const Sides& sides, int target, const Extension& extension, Approach& closest) {
  if (extension.gap >= closest.gap) return;
  const int growing = sides.growing->forest.root(extension.vertex);
  const int other = sides.other->forest.root(target);
  closest =
      sides.growing == sides.a ? Approach{extension.gap, growing, other} : Approach{extension.gap, other, growing};
}

}  // namespace

std::optional<Bridge> straight_connect(int vertex_new, const Graph& a, Graph& b, const StepSettings& settings,
                                       const World& world, SearchCounts& counts) {
  const Eigen::VectorXd q_new = a.forest.vertex(vertex_new);
  Extension extension;
  do {
    extension = syn_extend(b, q_new, false, settings, world, counts);
    if (extension.advance == Advance::reached) return Bridge{vertex_new, extension.vertex};
    note_gap({&a, &b, &a}, vertex_new, extension, counts.closest);
  } while (extension.advance == Advance::advanced);
  return std::nullopt;
}

std::optional<Bridge> syn_connect(int vertex_new, Graph& a, Graph& b, const StepSettings& settings, const World& world,
                                  SearchCounts& counts) {
  Graph* growing = &b;
  Graph* other = &a;  // holds q_new
  int newest = vertex_new;
  const auto bridge = [&](const Bridge& found) { return other == &a ? found : Bridge{found.vertex_b, found.vertex_a}; };
  GapWatch gap(settings.shortest());
  while (true) {  // line 1: q_new is not the empty set
    const Eigen::VectorXd q_new = other->forest.vertex(newest);
    const Extension extension = syn_extend(*growing, q_new, true, settings, world, counts);  // line 4
    if (extension.advance == Advance::reached) return bridge({newest, extension.vertex});    // line 2
    note_gap({&a, growing, other}, newest, extension, counts.closest);
    if (extension.advance == Advance::blocked) return std::nullopt;  // line 6
    if (extension.advance == Advance::stalled || !gap.shrinks(extension.gap)) {
      // The fallback may take the two graphs the other way round.
      const Approach closest = counts.closest;
      const auto found = straight_connect(newest, *other, *growing, settings, world, counts);
      if (other != &a && counts.closest.gap < closest.gap) std::swap(counts.closest.root_a, counts.closest.root_b);
      return found ? std::optional(bridge(*found)) : std::nullopt;
    }
    newest = extension.vertex;
    std::swap(growing, other);  // line 5
  }
}

}  // namespace opponens::motion
