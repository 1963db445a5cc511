// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/table2_planning/summary.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "core/require.hpp"
#include "core/rng.hpp"

namespace opponens::table2 {
namespace {

constexpr int kResamples = 10000;
using Values = std::vector<double>;

double mean_of(const Values& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double quantile(Values values, double p) {
  std::sort(values.begin(), values.end());
  const double place = p * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

double median_of(const Values& values) { return quantile(values, 0.5); }

using Statistic = std::function<double(const Values&)>;

/// The statistic of resampled indices, sorted.
Values replicates(std::size_t count, const std::function<double(const std::vector<std::size_t>&)>& statistic) {
  Rng rng = stream(1, "table2/bootstrap");
  std::vector<std::size_t> chosen(count);
  Values result;
  for (int i = 0; i < kResamples; ++i) {
    for (std::size_t& one : chosen) one = rng.index(count);
    result.push_back(statistic(chosen));
  }
  return result;
}

std::optional<Estimate> estimate(const Values& values, const Statistic& statistic) {
  if (values.empty()) return std::nullopt;
  Values resampled(values.size());
  const Values all = replicates(values.size(), [&](const std::vector<std::size_t>& chosen) {
    for (std::size_t i = 0; i < chosen.size(); ++i) resampled[i] = values[chosen[i]];
    return statistic(resampled);
  });
  return Estimate{statistic(values), quantile(all, 0.025), quantile(all, 0.975)};
}

std::optional<Estimate> ratio_of_means(const Values& above, const Values& below) {
  if (above.empty()) return std::nullopt;
  const Values all = replicates(above.size(), [&](const std::vector<std::size_t>& chosen) {
    double a = 0.0;
    double b = 0.0;
    for (const std::size_t i : chosen) {
      a += above[i];
      b += below[i];
    }
    return a / b;
  });
  return Estimate{mean_of(above) / mean_of(below), quantile(all, 0.025), quantile(all, 0.975)};
}

/// exp of mean log.
std::optional<Estimate> geometric(const Values& ratios) {
  Values logs;
  for (const double ratio : ratios) logs.push_back(std::log(ratio));
  const auto found = estimate(logs, mean_of);
  if (!found) return std::nullopt;
  return Estimate{std::exp(found->value), std::exp(found->low), std::exp(found->high)};
}

template <typename Get>
Values values_of(const std::vector<const Record*>& records, const Get& get) {
  Values values;
  for (const Record* record : records) {
    const std::optional<double> value = get(*record);
    if (value) values.push_back(*value);
  }
  return values;
}

double all_checks(const Record& record) { return static_cast<double>(record.checks + record.confirm_checks); }

}  // namespace

Column column_of(const std::vector<double>& values) {
  return {static_cast<int>(values.size()), estimate(values, median_of), estimate(values, mean_of)};
}

Summary summarize(const std::vector<Record>& records, const std::string& planner, double range) {
  std::vector<const Record*> own;
  for (const Record& record : records) {
    if (record.planner == planner && record.range == range) own.push_back(&record);
  }
  require(!own.empty(), "summarize: no runs of " + planner);
  Summary row;
  row.planner = planner;
  row.range = range;
  std::set<std::string> groups;
  for (const Record* record : own) {
    ++row.runs;
    row.solved += record->solved ? 1 : 0;
    row.verified_of += record->verified ? 1 : 0;
    row.verified += record->verified.value_or(false) ? 1 : 0;
    if (record->solved) groups.insert(record->group);
  }
  row.grasp_groups = static_cast<int>(groups.size());
  using Value = std::optional<double>;
  const auto column = [&](const auto& get) { return column_of(values_of(own, get)); };
  row.cpu_ms = column([](const Record& r) -> Value { return 1e3 * r.cpu_seconds; });
  row.cpu_ms_99 = quantile(values_of(own, [](const Record& r) -> Value { return 1e3 * r.cpu_seconds; }), 0.99);
  row.iterations = column(
      [](const Record& r) -> Value { return r.iterations ? Value(static_cast<double>(*r.iterations)) : std::nullopt; });
  row.checks = column([](const Record& r) -> Value { return static_cast<double>(r.checks); });
  row.all_checks = column([](const Record& r) -> Value { return all_checks(r); });
  row.valid_percent = column(
      [](const Record& r) -> Value { return r.valid_segments ? Value(100.0 * *r.valid_segments) : std::nullopt; });
  row.length = column([](const Record& r) -> Value { return r.length; });
  row.length_l1 = column([](const Record& r) -> Value { return r.length_l1; });
  row.arm_length = column([](const Record& r) -> Value { return r.arm_length; });
  row.hand_length = column([](const Record& r) -> Value { return r.hand_length; });
  row.likeness = column([](const Record& r) -> Value { return r.likeness; });
  row.time_ratio = column(
      [](const Record& r) -> Value { return r.path_seconds ? Value(r.cpu_seconds / *r.path_seconds) : std::nullopt; });
  return row;
}

Comparison compare(const std::vector<Record>& records, const std::string& planner, const std::string& baseline) {
  std::map<std::uint64_t, std::pair<const Record*, const Record*>> pairs;
  for (const Record& record : records) {
    if (record.planner == planner) pairs[record.seed].first = &record;
    if (record.planner == baseline) pairs[record.seed].second = &record;
  }
  Comparison result;
  result.planner = planner;
  result.baseline = baseline;
  Values checks, mean_above, mean_below, all, times, shorter, lengths, sums, likeness;
  for (const auto& [seed, pair] : pairs) {
    const auto& [own, other] = pair;
    if (own == nullptr || other == nullptr) continue;
    ++result.pairs;
    checks.push_back(static_cast<double>(own->checks) / static_cast<double>(other->checks));
    mean_above.push_back(static_cast<double>(own->checks));
    mean_below.push_back(static_cast<double>(other->checks));
    all.push_back(all_checks(*own) / all_checks(*other));
    times.push_back(own->cpu_seconds / other->cpu_seconds);
    if (!own->solved || !other->solved) continue;
    ++result.solved_pairs;
    shorter.push_back(*own->length - *other->length);
    lengths.push_back(*own->length / *other->length);
    sums.push_back(*own->length_l1 / *other->length_l1);
    if (own->likeness && other->likeness) likeness.push_back(*own->likeness - *other->likeness);
  }
  result.checks_ratio = geometric(checks);
  result.checks_mean_ratio = ratio_of_means(mean_above, mean_below);
  result.all_checks_ratio = geometric(all);
  result.cpu_ratio = geometric(times);
  result.length_difference = estimate(shorter, mean_of);
  result.length_ratio = geometric(lengths);
  result.length_l1_ratio = geometric(sums);
  result.likeness_difference = estimate(likeness, mean_of);
  return result;
}

double best_range(const std::vector<Record>& records, const std::string& planner) {
  std::map<double, std::pair<int, Values>> by_range;
  for (const Record& record : records) {
    if (record.planner != planner) continue;
    by_range[record.range].first += record.solved ? 1 : 0;
    by_range[record.range].second.push_back(static_cast<double>(record.checks));
  }
  require(!by_range.empty(), "best_range: no runs of " + planner);
  const auto best = std::min_element(by_range.begin(), by_range.end(), [](const auto& a, const auto& b) {
    return std::pair(-a.second.first, median_of(a.second.second)) <
           std::pair(-b.second.first, median_of(b.second.second));
  });
  return best->first;
}

}  // namespace opponens::table2
