// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/codec.hpp"

#include <array>
#include <cstdio>
#include <string_view>
#include <utility>

#include "core/require.hpp"
#include "storage/codec_fields.hpp"

namespace opponens::storage {
namespace {

constexpr const char* kFirstOrder = "first_order_synergies";

constexpr std::string_view kLabel = "label.";
constexpr std::array<std::string_view, 2> kOrigins{"recorded", "simulated"};

void encode_group(Record& record, const std::string& prefix, const SynergyGroup& group) {
  auto& fields = record.fields;
  fields[prefix + "name"] = group.name;
  fields[prefix + "phase"] = group.phase;
  fields[prefix + "basis_mean"] = group.basis.mean;
  fields[prefix + "basis_axes"] = group.basis.axes;
  fields[prefix + "basis_variance"] = group.basis.variance;
  fields[prefix + "basis_count"] = group.basis.count;
  fields[prefix + "box_center"] = group.box.center;
  fields[prefix + "box_axes"] = group.box.axes;
  fields[prefix + "box_half_width"] = group.box.half_width;
  fields[prefix + "box_scale"] = group.box.scale;
  fields[prefix + "box_alpha"] = group.box.alpha;
  fields[prefix + "box_beta"] = group.box.beta;
  fields[prefix + "dof_effective"] = std::int64_t{group.dof_effective};
  fields[prefix + "dropped_channels"] = group.dropped_channels;
}

SynergyGroup decode_group(const FieldReader& read, const std::string& prefix) {
  SynergyGroup group;
  group.name = read.text(prefix + "name");
  group.phase = read.text(prefix + "phase");
  group.basis.mean = read.vector(prefix + "basis_mean");
  group.basis.axes = read.matrix(prefix + "basis_axes");
  group.basis.variance = read.vector(prefix + "basis_variance");
  group.basis.count = read.number(prefix + "basis_count");
  group.box.center = read.vector(prefix + "box_center");
  group.box.axes = read.matrix(prefix + "box_axes");
  group.box.half_width = read.vector(prefix + "box_half_width");
  group.box.scale = read.vector(prefix + "box_scale");
  group.box.alpha = read.number(prefix + "box_alpha");
  group.box.beta = read.number(prefix + "box_beta");
  group.dof_effective = read.small_integer(prefix + "dof_effective");
  group.dropped_channels = read.texts(prefix + "dropped_channels");
  const Eigen::Index n = group.basis.mean.size();
  read.expect(group.basis.axes.rows() == n && group.basis.axes.cols() == group.basis.variance.size(),
              prefix + "basis_axes", "[n x number of variances], n = length of basis_mean");
  read.expect(group.box.axes.rows() == group.box.center.size() && group.box.scale.size() == group.box.center.size(),
              prefix + "box_axes", "as many rows as box_center and box_scale have values");
  read.expect(group.box.axes.cols() == group.box.half_width.size(), prefix + "box_half_width",
              "one value per column of box_axes");
  return group;
}

std::string grasp_prefix(int index) {
  std::array<char, 24> text{};
  std::snprintf(text.data(), text.size(), "grasp.%03d.", index);
  return text.data();
}

}  // namespace

Record encode(const Demonstration& demonstration, const Provenance& provenance) {
  require(demonstration.time.size() == demonstration.q_h.rows() &&
              static_cast<Eigen::Index>(demonstration.joint_names.size()) == demonstration.q_h.cols(),
          [&] { return "encode: demonstration '" + demonstration.id + "': time, joint_names and q_h do not fit"; });
  Record record{"demonstration", demonstration.id, provenance, {}};
  for (const auto& [label, value] : demonstration.labels) record.fields[std::string(kLabel) + label] = value;
  record.fields["origin"] = enum_text(kOrigins, demonstration.origin);
  record.fields["weight"] = demonstration.weight;
  record.fields["time"] = demonstration.time;
  record.fields["joint_names"] = demonstration.joint_names;
  record.fields["q_h"] = demonstration.q_h;
  if (demonstration.known_transition) record.fields["known_transition"] = *demonstration.known_transition;
  return record;
}

Demonstration decode_demonstration(const Record& record) {
  // A motion mapped to a robot hand has the same fields under a kind of its own.
  const FieldReader read(record, record.kind == "hand_demonstration" ? record.kind : "demonstration");
  Demonstration demonstration;
  demonstration.id = record.name;
  for (const auto& [name, field] : record.fields) {
    if (name.starts_with(kLabel)) demonstration.labels[name.substr(kLabel.size())] = read.text(name);
  }
  demonstration.origin = read.enumerator<Origin>("origin", kOrigins);
  demonstration.weight = read.number("weight");
  demonstration.time = read.vector("time");
  demonstration.joint_names = read.texts("joint_names");
  demonstration.q_h = read.matrix("q_h");
  demonstration.known_transition = read.optional_number("known_transition");
  read.expect(demonstration.q_h.rows() == demonstration.time.size(), "q_h", "one row per value of time");
  read.expect(demonstration.q_h.cols() == static_cast<Eigen::Index>(demonstration.joint_names.size()), "q_h",
              "one column per joint name");
  return demonstration;
}

Record encode(const SynergySet& set, const Provenance& provenance) {
  require(set.order == 0 || set.order == 1, "encode: the order of a synergy set is 0 or 1");
  Record record{set.order == 0 ? "synergy_set" : kFirstOrder, "synergies", provenance, {}};
  record.fields["joint_names"] = set.joint_names;
  record.fields["grasp_count"] = static_cast<std::int64_t>(set.grasp.size());
  encode_group(record, "pre_grasp.", set.pre_grasp);
  for (std::size_t i = 0; i < set.grasp.size(); ++i) {
    encode_group(record, grasp_prefix(static_cast<int>(i)), set.grasp[i]);
  }
  return record;
}

SynergySet decode_synergy_set(const Record& record) {
  // Synergies of velocities have a kind of their own, so that nobody takes them for postures.
  const FieldReader read(record, record.kind == kFirstOrder ? kFirstOrder : "synergy_set");
  SynergySet set;
  set.order = record.kind == kFirstOrder ? 1 : 0;
  set.joint_names = read.texts("joint_names");
  set.pre_grasp = decode_group(read, "pre_grasp.");
  const int count = read.small_integer("grasp_count");
  for (int i = 0; i < count; ++i) set.grasp.push_back(decode_group(read, grasp_prefix(i)));
  return set;
}

Record encode(const PlanResult& result, const Provenance& provenance) {
  Record record{"path", "path to goal " + std::to_string(result.goal), provenance, {}};
  auto& fields = record.fields;
  fields["status"] = status_name(result.status);
  fields["joint_names"] = result.path.joint_names;
  fields["waypoints"] = result.path.waypoints;
  fields["goal"] = std::int64_t{result.goal};
  fields["iterations"] = result.iterations;
  fields["extends"] = result.extends;
  fields["extends_grown"] = result.extends_grown;
  fields["collision_checks"] = result.collision_checks;
  fields["length"] = result.length;
  fields["length_l1"] = result.length_l1;
  fields["detail"] = result.detail;
  return record;
}

PlanResult decode_plan_result(const Record& record) {
  const FieldReader read(record, "path");
  PlanResult result;
  result.status = read.enumerator<PlanStatus>("status", kPlanStatusNames);
  result.path.joint_names = read.texts("joint_names");
  result.path.waypoints = read.matrix("waypoints");
  result.goal = read.small_integer("goal");
  result.iterations = read.integer("iterations");
  result.extends = read.integer("extends");
  result.extends_grown = read.integer("extends_grown");
  result.collision_checks = read.integer("collision_checks");
  result.length = read.number("length");
  result.length_l1 = read.number("length_l1");
  result.detail = read.text("detail");
  read.expect(result.path.waypoints.rows() == 0 ||
                  result.path.waypoints.cols() == static_cast<Eigen::Index>(result.path.joint_names.size()),
              "waypoints", "one column per joint name");
  return result;
}

}  // namespace opponens::storage
