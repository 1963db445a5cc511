// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/export_trajectory.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <utility>

#include "cli/export_table.hpp"
#include "cli/json.hpp"
#include "core/require.hpp"
#include "storage/codec.hpp"

namespace opponens::cli {
namespace {

constexpr std::int64_t kNanoseconds = 1000000000;  // in a second

/// 17 digits, and always a point: "1.0e-05".
void append_decimal(std::string& text, double value) {
  std::array<char, 32> digits{};
  std::snprintf(digits.data(), digits.size(), "%.17g", value);
  std::string number = digits.data();
  if (number.find('.') == std::string::npos) {
    const std::size_t exponent = number.find('e');
    number.insert(exponent == std::string::npos ? number.size() : exponent, ".0");
  }
  text += number;
}

template <typename Derived>
std::string decimals(const Eigen::MatrixBase<Derived>& values) {
  std::string text = "[";
  for (Eigen::Index j = 0; j < values.size(); ++j) {
    if (j > 0) text += ", ";
    append_decimal(text, values(j));
  }
  return text + "]";
}

std::int64_t nanoseconds(double seconds) { return std::llround(seconds * static_cast<double>(kNanoseconds)); }

/// What a point is made of, in the message's order: name and value, each as text that JSON and YAML read alike.
using PointFields = std::vector<std::pair<std::string, std::string>>;

std::vector<PointFields> message_points(const motion::Trajectory& trajectory) {
  std::vector<PointFields> points;
  for (Eigen::Index i = 0; i < trajectory.times.size(); ++i) {
    const std::int64_t time = nanoseconds(trajectory.times[i]);
    if (i + 1 < trajectory.times.size() && nanoseconds(trajectory.times[i + 1]) == time) continue;
    points.push_back({{"positions", decimals(trajectory.positions.row(i))},
                      {"velocities", decimals(trajectory.velocities.row(i))},
                      {"accelerations", decimals(trajectory.accelerations.row(i))},
                      {"effort", "[]"},
                      {"time_from_start", "{\"sec\": " + std::to_string(time / kNanoseconds) +
                                              ", \"nanosec\": " + std::to_string(time % kNanoseconds) + "}"}});
  }
  return points;
}

const char* const kHeader = R"({"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""})";

const Eigen::MatrixXd& matrix_field(const std::string& id, const storage::Record& record, const char* name) {
  const auto field = record.fields.find(name);
  if (field == record.fields.end()) {
    throw InputError("path '" + id + "' has no " + name + ": it was stored without them; plan it again");
  }
  return std::get<Eigen::MatrixXd>(field->second);
}

motion::Trajectory sampled(const motion::Trajectory& knots, double period) {
  const double end = knots.times[knots.times.size() - 1];
  const auto count = static_cast<Eigen::Index>(std::ceil(end / period - 1e-9)) + 1;
  motion::Trajectory result{Eigen::MatrixXd(count, knots.positions.cols()),
                            Eigen::MatrixXd(count, knots.positions.cols()),
                            Eigen::MatrixXd(count, knots.positions.cols()), Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    result.times[i] = i + 1 < count ? static_cast<double>(i) * period : end;
    const Eigen::MatrixXd state = motion::state_at(knots, result.times[i]);
    result.positions.row(i) = state.row(0);
    result.velocities.row(i) = state.row(1);
    result.accelerations.row(i) = state.row(2);
  }
  return result;
}

}  // namespace

NamedTrajectory trajectory_of(const std::string& id, const storage::Record& record, double period) {
  const storage::Episode episode = episode_of(id, record);
  NamedTrajectory named{
      episode.joint_names,
      {episode.q, matrix_field(id, record, "velocities"), matrix_field(id, record, "accelerations"), episode.time}};
  if (period > 0.0) named.trajectory = sampled(named.trajectory, period);
  return named;
}

std::string joint_trajectory_json(const NamedTrajectory& named) {
  std::string text = std::string("{\"header\": ") + kHeader + ",\n\"joint_names\": " + Json(named.joint_names).dump() +
                     ",\n\"points\": [";
  const char* separator = "\n";
  for (const PointFields& point : message_points(named.trajectory)) {
    text += separator;
    separator = ",\n";
    const char* before = "{\"";
    for (const auto& [name, value] : point) {
      text.append(before).append(name).append("\": ").append(value);
      before = ",\n \"";
    }
    text += "}";
  }
  return text + "\n]}\n";
}

std::string joint_trajectory_yaml(const NamedTrajectory& named) {
  std::string text = std::string("header: ") + kHeader + "\njoint_names: [";
  for (const std::string& name : named.joint_names) text += (text.back() == '[' ? "" : ", ") + Json(name).dump();
  text += "]\npoints:\n";
  for (const PointFields& point : message_points(named.trajectory)) {
    const char* before = "- ";
    for (const auto& [name, value] : point) {
      text.append(before).append(name).append(": ").append(value).append("\n");
      before = "  ";
    }
  }
  return text;
}

std::string trajectory_csv(const NamedTrajectory& named) {
  std::string text = "time_s";
  for (const char* rate : {"", " velocity", " acceleration"}) {
    for (const std::string& name : named.joint_names) text.append(",").append(cell(name + rate));
  }
  text += "\n";
  const motion::Trajectory& trajectory = named.trajectory;
  for (Eigen::Index i = 0; i < trajectory.times.size(); ++i) {
    append_number(text, trajectory.times[i]);
    for (const Eigen::MatrixXd* values : {&trajectory.positions, &trajectory.velocities, &trajectory.accelerations}) {
      for (Eigen::Index j = 0; j < values->cols(); ++j) {
        text += ',';
        append_number(text, (*values)(i, j));
      }
    }
    text += "\n";
  }
  return text;
}

}  // namespace opponens::cli
