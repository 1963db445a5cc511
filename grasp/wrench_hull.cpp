// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/wrench_hull.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace opponens::grasp {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// Owns qhull's memory for one hull.
class QhullContext {
 public:
  QhullContext() { qh_zero(&qh_, sink_.get()); }
  ~QhullContext() {
    qh_freeqhull(&qh_, !qh_ALL);
    int current = 0;
    int total = 0;
    qh_memfreeshort(&qh_, &current, &total);
  }
  QhullContext(const QhullContext&) = delete;
  QhullContext& operator=(const QhullContext&) = delete;

  bool build(Matrix6Xd& points) {
    char command[] = "qhull Qt Q12";
    return qh_new_qhull(&qh_, 6, static_cast<int>(points.cols()), points.data(), false, command, nullptr,
                        sink_.get()) == 0;
  }
  qhT* get() { return &qh_; }

 private:
  std::unique_ptr<std::FILE, CloseFile> sink_{std::fopen("/dev/null", "w")};  // qhull reports flat sets at length
  qhT qh_;
};

}  // namespace

std::optional<WrenchHull> wrench_hull(const Matrix6Xd& points) {
  if (points.cols() < 7) return std::nullopt;
  Matrix6Xd copy = points;
  QhullContext context;
  if (!context.build(copy)) return std::nullopt;
  qhT* qh = context.get();
  qh_getarea(qh, qh->facet_list);
  WrenchHull hull{qh->totvol, std::numeric_limits<double>::infinity()};
  for (const facetT* facet = qh->facet_list; facet && facet->next; facet = facet->next) {
    if (facet->normal) hull.least_offset = std::min(hull.least_offset, -facet->offset);
  }
  return hull;
}

}  // namespace opponens::grasp
