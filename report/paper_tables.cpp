// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/paper_tables.hpp"

namespace opponens::report {

const PaperVariance* paper_variance(std::string_view group) {
  if (group == "pre-grasp" || group == "pre_grasp") return &kPaperTable1[0];
  constexpr std::string_view kPrefix = "family";
  if (group.starts_with(kPrefix)) group.remove_prefix(kPrefix.size());
  while (!group.empty() && (group.front() == ' ' || group.front() == '_' || group.front() == '-')) {
    group.remove_prefix(1);
  }
  if (group.size() != 1 || group.front() < '1' || group.front() > '4') return nullptr;
  return &kPaperTable1[static_cast<std::size_t>(group.front() - '0')];
}

}  // namespace opponens::report
