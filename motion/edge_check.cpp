// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/edge_check.hpp"

#include <array>
#include <cmath>

#include "core/require.hpp"
#include "motion/joint_groups.hpp"

namespace opponens::motion {

namespace {

constexpr double kConfirmShare = 10.0;  ///< an answer is asked again this much more densely

/// The checked fractions of a motion in order: its end, then the inner ones by bisection.
class CoarseToFine {
 public:
  explicit CoarseToFine(double segments) {
    require(std::isfinite(segments), "first_invalid: configurations must be finite");
    segments_ = static_cast<std::uint64_t>(std::ceil(segments));
    while ((std::uint64_t{1} << bits_) < segments_) ++bits_;
  }

  /// The next fraction in (0, 1]; nullopt after the last.
  std::optional<double> next() {
    if (k_ == 0) {
      ++k_;
      return 1.0;
    }
    for (; k_ < (std::uint64_t{1} << bits_); ++k_) {
      std::uint64_t i = 0;  // k with its bits reversed
      for (int bit = 0; bit < bits_; ++bit) i |= ((k_ >> bit) & 1U) << (bits_ - 1 - bit);
      if (i >= segments_) continue;
      ++k_;
      return static_cast<double>(i) / static_cast<double>(segments_);
    }
    return std::nullopt;
  }

 private:
  std::uint64_t segments_ = 0;
  int bits_ = 0;
  std::uint64_t k_ = 0;
};

/// from + 1 (to - from) may miss `to` by a rounding.
Eigen::VectorXd between(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to, double fraction) {
  return fraction == 1.0 ? q_to : Eigen::VectorXd(q_from + fraction * (q_to - q_from));
}

}  // namespace

std::optional<double> first_invalid(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to, const Validity& valid,
                                    const Eigen::VectorXd& weights, const Spacing& resolution, std::int64_t& checks) {
  CoarseToFine fractions(spacings(resolution, weights, q_from, q_to));
  while (const std::optional<double> fraction = fractions.next()) {
    ++checks;
    if (!valid(between(q_from, q_to, *fraction))) return fraction;
  }
  return std::nullopt;
}

std::optional<double> first_invalid_by_rows(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to,
                                            const FirstInvalidRow& first_row, const Eigen::VectorXd& weights,
                                            const Spacing& resolution, std::int64_t& checks) {
  CoarseToFine fractions(spacings(resolution, weights, q_from, q_to));
  robot::ConfigurationBatch batch(robot::CollisionChecker::kTogether, q_to.size());
  std::array<double, robot::CollisionChecker::kTogether> asked{};
  std::optional<double> fraction = fractions.next();
  while (fraction) {
    int rows = 0;
    for (; fraction && rows < batch.rows(); fraction = fractions.next()) {
      asked[static_cast<std::size_t>(rows)] = *fraction;
      batch.row(rows++) = between(q_from, q_to, *fraction).transpose();
    }
    if (rows < batch.rows()) batch.conservativeResize(rows, Eigen::NoChange);
    checks += rows;
    if (const auto row = first_row(batch)) return asked[static_cast<std::size_t>(*row)];
  }
  return std::nullopt;
}

std::optional<double> first_invalid(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to,
                                    const robot::CollisionChecker& checker, const Eigen::VectorXd& weights,
                                    const Spacing& resolution, std::int64_t& checks) {
  const auto first = [&checker](const robot::ConfigurationBatch& batch) { return checker.first_colliding(batch); };
  return first_invalid_by_rows(q_from, q_to, first, weights, resolution, checks);
}

World make_world_by_rows(const FirstInvalidRow& first_row, const Eigen::VectorXd& weights, const Spacing& resolution) {
  require(static_cast<bool>(first_row), "make_world_by_rows: no validity given");
  validate(resolution, "make_world_by_rows");
  const auto at = [first_row, weights](const Spacing& spacing) -> MotionCheck {
    return [first_row, weights, spacing](const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to,
                                         std::int64_t& checks) {
      return first_invalid_by_rows(q_from, q_to, first_row, weights, spacing, checks);
    };
  };
  World world;
  world.first_invalid = at(resolution);
  world.confirm = at(resolution.divided_by(kConfirmShare));
  world.free = [first_row](const Eigen::MatrixXd& batch, std::int64_t& checks) {
    std::vector<bool> free;
    for (const auto& row : batch.rowwise()) free.push_back(!first_row(robot::ConfigurationBatch(row)));
    checks += batch.rows();
    return free;
  };
  return world;
}

World make_world(const Validity& valid, const Eigen::VectorXd& weights, double resolution, double confirm_resolution) {
  require(std::isfinite(confirm_resolution) && confirm_resolution >= 0.0,
          "make_world: confirm_resolution must be >= 0 and finite");
  World world = make_world(valid, weights, resolution);
  world.confirm = confirm_resolution > 0.0 ? make_world(valid, weights, confirm_resolution).first_invalid : nullptr;
  return world;
}

World make_world(const Validity& valid, const Eigen::VectorXd& weights, const Spacing& resolution) {
  require(static_cast<bool>(valid), "make_world: no validity given");
  validate(resolution, "make_world");
  const auto at = [valid, weights](const Spacing& spacing) -> MotionCheck {
    return [valid, weights, spacing](const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to, std::int64_t& checks) {
      return first_invalid(q_from, q_to, valid, weights, spacing, checks);
    };
  };
  World world;
  world.first_invalid = at(resolution);
  world.confirm = at(resolution.divided_by(kConfirmShare));
  world.free = [valid](const Eigen::MatrixXd& batch, std::int64_t& checks) {
    std::vector<bool> free;
    for (const auto& row : batch.rowwise()) free.push_back(valid(row.transpose()));
    checks += batch.rows();
    return free;
  };
  return world;
}

World make_world(const robot::CollisionChecker& checker, const robot::RobotModel& robot, const Spacing& resolution,
                 std::shared_ptr<const ContinuousCheck> clearance) {
  validate(resolution, "make_world");
  require(clearance != nullptr, "make_world: no clearance given");
  World world;
  world.first_invalid = [&checker, &robot, resolution](const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to,
                                                       std::int64_t& checks) -> std::optional<double> {
    if (!robot.within_limits(q_to)) {  // then all between is inside them too, since q_from is
      ++checks;
      return 1.0;
    }
    return first_invalid(q_from, q_to, checker, robot.weights(), resolution, checks);
  };
  // Where surfaces keep apart, nothing gets inside anything: one end tells.
  world.confirm = [&checker, &robot, clearance](const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to,
                                                std::int64_t& checks) -> std::optional<double> {
    ++checks;
    if (!robot.within_limits(q_to) || !checker.free(q_to)) return 1.0;
    return clearance->first_near(q_from, q_to, checks);
  };
  world.explain = [&checker](const Eigen::VectorXd& q) { return checker.colliding_pairs(q); };
  world.free = [&checker, &robot, clearance](const Eigen::MatrixXd& batch, std::int64_t& checks) {
    std::vector<bool> free = checker.free_rows(batch);
    for (Eigen::Index row = 0; row < batch.rows(); ++row) {
      const auto index = static_cast<std::size_t>(row);
      const Eigen::VectorXd q = batch.row(row).transpose();
      free[index] = free[index] && robot.within_limits(q) && clearance->keeps(q);
    }
    checks += batch.rows();
    return free;
  };
  return world;
}

World make_world(const robot::CollisionChecker& checker, const robot::RobotModel& robot, const Spacing& resolution) {
  return make_world(checker, robot, resolution, std::make_shared<const ContinuousCheck>(checker, robot));
}

}  // namespace opponens::motion
