// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/hand_mapping.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/require.hpp"
#include "robot/hand_file.hpp"

namespace opponens::robot {

namespace {

bool names_joint(const HandFile& hand, const std::string& joint) {
  return std::any_of(hand.joints.begin(), hand.joints.end(),
                     [&](const NamedValue& known) { return known.name == joint; });
}

std::string read_joint(const YamlValue& value, const HandFile& hand, std::set<std::string>& used) {
  std::string joint = value.text();
  if (!names_joint(hand, joint)) value.fail("no joint '" + joint + "' in this file's list of joints");
  if (!used.insert(joint).second) value.fail("joint '" + joint + "' is mapped twice");
  return joint;
}

void require_tip(const HandFile& hand, const std::string& name, const YamlValue& where) {
  const bool known =
      std::any_of(hand.tips.begin(), hand.tips.end(), [&](const NamedPoint& tip) { return tip.point.name == name; });
  if (!known) where.fail("no tip '" + name + "' in this file");
}

JointMapping read_copy(const YamlValue& item, const HandFile& hand, std::set<std::string>& used) {
  item.allow_keys({"joint", "channel", "gain", "offset", "ranges"});
  JointMapping copy{read_joint(item.at("joint"), hand, used), item.at("channel").text()};
  if (const auto gain = item.find("gain")) copy.gain = gain->number();
  if (const auto offset = item.find("offset")) copy.offset = offset->number();
  if (const auto ranges = item.find("ranges")) {
    if (ranges->text() != "true" && ranges->text() != "false") ranges->fail("expected true or false");
    copy.ranges = ranges->text() == "true";
    if (copy.ranges && (std::abs(copy.gain) != 1.0 || copy.offset != 0.0)) {
      ranges->fail("gain must be 1 or -1 and offset 0 where ranges are matched");
    }
  }
  return copy;
}

/// Percentile in [0, 1] of sorted values, linear between order statistics.
double percentile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

std::vector<double> sorted_values(const std::vector<const Demonstration*>& recordings, const std::string& channel) {
  std::vector<double> values;
  for (const Demonstration* recording : recordings) {
    const auto& names = recording->joint_names;
    const auto found = std::find(names.begin(), names.end(), channel);
    if (found == names.end()) continue;
    const auto column = recording->q_h.col(found - names.begin());
    require(column.allFinite(), "recording '" + recording->id + "': channel " + channel + " is not finite");
    values.insert(values.end(), column.begin(), column.end());
  }
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace

HandMapping load_hand_mapping(const std::filesystem::path& hand_yaml) {
  const HandFile hand = read_hand_file(hand_yaml);
  if (!hand.mapping) throw InputError(hand_yaml.string() + ": has no key 'mapping'");
  const YamlValue& value = *hand.mapping;
  value.allow_keys({"copied", "direct", "fitted", "fingertips", "palm_rpy"});
  HandMapping mapping;
  std::set<std::string> used;
  for (const YamlValue& item : value.at("copied").items()) mapping.copied.push_back(read_copy(item, hand, used));
  if (const auto direct = value.find("direct")) {
    std::set<std::string> copied = used;  // a joint may be both direct and fitted: one for each mapping
    for (const YamlValue& item : direct->items()) mapping.direct.push_back(read_copy(item, hand, copied));
  }
  if (const auto fitted = value.find("fitted")) {
    for (const YamlValue& item : fitted->items()) mapping.fitted.push_back(read_joint(item, hand, used));
  }
  if (const auto tips = value.find("fingertips")) {
    for (const auto& [robot_tip, human_tip] : tips->entries()) {
      require_tip(hand, robot_tip, human_tip);
      if (!human_tip.is_map()) {
        mapping.fingertips[robot_tip] = human_tip.text();
        continue;
      }
      human_tip.allow_keys({"tip", "from"});
      mapping.fingertips[robot_tip] = human_tip.at("tip").text();
      mapping.measured_from[robot_tip] = human_tip.at("from").text();
    }
    for (const auto& [tip, from] : mapping.measured_from) {
      if (!mapping.fingertips.contains(from)) tips->fail("'" + tip + "' is measured from '" + from + "': not mapped");
    }
  }
  if (const auto rpy = value.find("palm_rpy")) {
    mapping.R_robot_human = pose_from_xyz_rpy(Eigen::Vector3d::Zero(), Eigen::Vector3d(rpy->numbers(3))).linear();
  }
  return mapping;
}

ChannelCalibration calibrate_range(const std::vector<const Demonstration*>& recordings, const RobotModel& human) {
  require(!recordings.empty(), "calibrate_range needs at least one recording");
  ChannelCalibration calibration;
  std::vector<std::pair<double, double>> lines;  // gain, offset
  for (int i = 0; i < human.dof(); ++i) {
    const std::string& channel = human.joint_names()[static_cast<std::size_t>(i)];
    const std::vector<double> values = sorted_values(recordings, channel);
    if (values.empty()) continue;
    const double low = percentile(values, 0.01);
    const double high = percentile(values, 0.99);
    calibration.channels.push_back(channel);
    if (high - low < kStillRange) {
      calibration.still.push_back(channel);
      lines.emplace_back(0.0, std::clamp(0.0, human.lower()[i], human.upper()[i]));
      continue;
    }
    const double gain = (human.upper()[i] - human.lower()[i]) / (high - low);
    lines.emplace_back(gain, human.lower()[i] - gain * low);
  }
  const auto count = static_cast<Eigen::Index>(lines.size());
  calibration.gain.resize(count);
  calibration.offset.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    std::tie(calibration.gain[i], calibration.offset[i]) = lines[static_cast<std::size_t>(i)];
  }
  return calibration;
}

}  // namespace opponens::robot
