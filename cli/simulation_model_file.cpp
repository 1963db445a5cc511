// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/simulation_model_file.hpp"

#include <stdexcept>

#include "core/require.hpp"
#include "robot/yaml_file.hpp"

namespace opponens::cli {
namespace {

using robot::YamlValue;

bool truth(const YamlValue& value) {
  const std::string text = value.text();
  if (text != "true" && text != "false") value.fail("expected true or false, found '" + text + "'");
  return text == "true";
}

int whole(const YamlValue& value) {
  const double number = value.number();
  if (number != static_cast<int>(number)) value.fail("expected a whole number");
  return static_cast<int>(number);
}

analysis::SimulatedGraspType read_type(const YamlValue& value, int channels) {
  value.allow_keys({"name", "family", "assumed", "ends"});
  analysis::SimulatedGraspType type{value.at("name").text(), value.at("family").text(), truth(value.at("assumed")), {}};
  for (const auto& end : value.at("ends").items()) {
    end.allow_keys({"object", "posture"});
    type.ends.push_back({end.at("object").text(), end.at("posture").numbers(channels)});
  }
  return type;
}

void read_movement(const YamlValue& value, analysis::SimulationModel& model) {
  value.allow_keys({"opening_duration", "closing_duration", "duration_spread", "onset_spread", "amplitude_spread",
                    "rest_spread", "open_spread", "end_spread", "noise", "resolution"});
  model.opening_duration = value.at("opening_duration").number();
  model.closing_duration = value.at("closing_duration").number();
  model.duration_spread = value.at("duration_spread").number();
  model.onset_spread = value.at("onset_spread").number();
  model.amplitude_spread = value.at("amplitude_spread").number();
  model.rest_spread = value.at("rest_spread").number();
  model.open_spread = value.at("open_spread").number();
  model.end_spread = value.at("end_spread").number();
  model.noise = value.at("noise").number();
  model.resolution = value.at("resolution").number();
}

void read_free(const YamlValue& value, analysis::FreeMotionModel& model) {
  value.allow_keys({"recordings", "duration", "segment_shortest", "segment_longest", "deviation"});
  model.recordings = whole(value.at("recordings"));
  model.duration = value.at("duration").number();
  model.segment_shortest = value.at("segment_shortest").number();
  model.segment_longest = value.at("segment_longest").number();
  model.deviation = value.at("deviation").number();
}

}  // namespace

analysis::SimulationModel load_simulation_model(const std::filesystem::path& file) {
  const YamlValue root = YamlValue::load(file);
  // "objects" documents what the postures were closed on; the movement does not need it.
  root.allow_keys({"channels", "fingers", "lower", "upper", "rest", "open", "movement", "free", "objects", "types"});
  analysis::SimulationModel model;
  model.channels = root.at("channels").texts();
  model.fingers = root.at("fingers").texts();
  const int n = static_cast<int>(model.channels.size());
  model.lower = root.at("lower").numbers(n);
  model.upper = root.at("upper").numbers(n);
  model.rest = root.at("rest").numbers(n);
  model.open = root.at("open").numbers(n);
  read_movement(root.at("movement"), model);
  read_free(root.at("free"), model.free);
  for (const auto& type : root.at("types").items()) model.types.push_back(read_type(type, n));
  try {
    analysis::validate(model);
  } catch (const std::invalid_argument& error) {
    throw InputError(file.string() + ": " + error.what());
  }
  return model;
}

}  // namespace opponens::cli
