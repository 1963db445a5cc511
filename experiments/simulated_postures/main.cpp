// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// simulated_postures CONFIG.yaml HAND.yaml OUT.yaml: closes a parametric human hand on simple objects and writes the
// postures of models/human/grasp_types.yaml. See README.md.

#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include <yaml-cpp/yaml.h>

#include "close_hand.hpp"
#include "robot/load_robot.hpp"

namespace {

using namespace simulated_postures;
namespace robot = opponens::robot;

// Joints of the hand model that the 22-sensor glove does not measure.
const std::string kUnmeasured = "M_ABD";

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

Eigen::Vector3d vector3(const YAML::Node& node) {
  const auto values = node.as<std::vector<double>>();
  if (values.size() != 3) throw std::runtime_error("config: a vector needs 3 numbers");
  return {values[0], values[1], values[2]};
}

robot::Shape shape(const YAML::Node& node) {
  if (const auto sphere = node["sphere"]) return robot::Sphere{sphere["radius"].as<double>()};
  if (const auto box = node["box"]) return robot::Box{vector3(box["size"])};
  const auto cylinder = node["cylinder"];
  return robot::Cylinder{cylinder["radius"].as<double>(), cylinder["length"].as<double>()};
}

std::string flow(const YAML::Node& node) {
  YAML::Emitter out;
  out.SetMapFormat(YAML::Flow);
  out.SetSeqFormat(YAML::Flow);
  out << node;
  return out.c_str();
}

/// Sets the named channels, degrees; MCP, PIP and DIP stand for all four fingers and are overridden by a finger's own.
void set_channels(const Hand& hand, const YAML::Node& node, Eigen::VectorXd& q) {
  for (const char* joint : {"MCP", "PIP", "DIP"}) {
    if (!node[joint]) continue;
    for (const char* finger : {"I_", "M_", "R_", "L_"}) {
      q[hand.channel(std::string(finger) + joint)] = radians(node[joint].as<double>());
    }
  }
  for (const auto& entry : node) {
    const auto name = entry.first.as<std::string>();
    if (name == "MCP" || name == "PIP" || name == "DIP") continue;
    q[hand.channel(name)] = radians(entry.second.as<double>());
  }
  if (!hand.model.within_limits(q))
    throw std::runtime_error("config: a posture leaves the joint limits: " + flow(node));
}

GraspSpec grasp_spec(const Hand& hand, const YAML::Node& node, const Eigen::VectorXd& open) {
  GraspSpec spec;
  const std::map<std::string, Place> places{
      {"palm", Place::palm}, {"tips", Place::tips}, {"rim", Place::rim}, {"index", Place::index}};
  spec.place = places.at(node["place"].as<std::string>());
  spec.at = vector3(node["at"]);
  spec.axis = vector3(node["axis"]).normalized();
  spec.start = open;
  set_channels(hand, node["start"], spec.start);
  spec.fingers = node["fingers"].as<std::vector<std::string>>();
  spec.rate = vector3(node["rate"]);
  spec.thumb_rate = vector3(node["thumb_rate"]);
  return spec;
}

class Writer {
 public:
  Writer(std::ostream& out, const Hand& hand) : out_(out), hand_(hand) {
    for (const std::string& name : hand.model.joint_names()) {
      if (name != kUnmeasured) channels_.push_back(name);
    }
    out_ << std::fixed << std::setprecision(4);
  }

  void posture(const std::string& key, const Eigen::VectorXd& q) {
    out_ << key << "[";
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      if (i > 0) out_ << (i % 11 == 0 ? ",\n    " : ", ");
      // Rounded towards zero, so that a joint at its limit stays inside it.
      const double value = std::trunc(q[hand_.channel(channels_[i])] * 1e4) / 1e4;
      out_ << (value == 0.0 ? 0.0 : value);
    }
    out_ << "]";
  }

  void names() {
    out_ << "channels: [";
    list([](const std::string& name) { return name; });
    out_ << "]\n# Finger whose common flexion drives a channel in free motion; \"\": a course of its own.\nfingers: [";
    list([](const std::string& name) { return finger(name); });
    out_ << "]\n";
  }

 private:
  static std::string finger(const std::string& name) {
    const bool flexion = name.ends_with("_MCP") || name.ends_with("_PIP") || name.ends_with("_DIP") || name == "T_IP";
    if (!flexion) return "\"\"";
    switch (name.front()) {
      case 'T':
        return "thumb";
      case 'I':
        return "index";
      case 'M':
        return "middle";
      case 'R':
        return "ring";
      default:
        return "little";
    }
  }
  template <typename Text>
  void list(Text&& text) {
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      out_ << (i == 0 ? "" : i % 11 == 0 ? ",\n  " : ", ") << text(channels_[i]);
    }
  }

  std::ostream& out_;
  const Hand& hand_;
  std::vector<std::string> channels_;
};

constexpr const char* kHead = R"(# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
#
# The simulated human hand: written by experiments/simulated_postures (do not edit; edit its config.yaml). SI, rad.
# Flexion positive; abduction positive away from the middle finger. Channels: the 22 sensors of a CyberGlove.
#
# Postures: a parametric hand (models/human_hand; segment lengths of Buchholz, Armstrong and Goldstein 1992,
# doi:10.1080/00140139208967812) closed on simple objects until its joints are blocked. No number here was chosen by
# comparison with published synergies; what changed after the first analysis, and why, stands in the README of
# experiments/simulated_postures. Agreement of simulated movements with recorded ones proves nothing about humans.
#
# Grasp types: Cutkosky 1989 (doi:10.1109/70.34763). family: the caption of the paper's Fig. 9 names one example of each
# of four families (assumed: false); the numbers of the families, and the families of all other types, are ASSUMED.
)";

constexpr const char* kMovement = R"(
# Stated a priori, without a source, unless one is named.
movement:
  opening_duration: 0.9    # s, mean
  closing_duration: 1.1    # s, mean
  duration_spread: 0.12    # standard deviation of the log of a duration
  onset_spread: 0.08       # s, a joint starts a phase later by uniform [0, this)
  amplitude_spread: 0.06   # standard deviation of the factor on a phase's displacement
  rest_spread: 0.052       # rad (3 deg), standard deviation of each joint at rest
  open_spread: 0.052       # rad, the same at the transition
  end_spread: 0.052        # rad, the same at the end
  noise: 0.0044            # rad (0.25 deg), standard deviation of a sensor: half its resolution
  resolution: 0.0087       # rad (0.5 deg): the order the maker of the CyberGlove states

# Free motions of the fingers, the reference of human-likeness: nothing in it comes from the grasps. Every finger wanders
# through its whole range by minimum-jerk segments between uniform targets.
free:
  recordings: 6
  duration: 20.0           # s, of each
  segment_shortest: 0.5    # s
  segment_longest: 1.5     # s
  deviation: 0.15          # of a joint's range, by which it departs from its finger, standard deviation
)";

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

void write(std::ostream& out, const YAML::Node& config, const Hand& hand) {
  Writer writer(out, hand);
  out << kHead << "\n";
  writer.names();
  out << "# Joint ranges, as in models/human_hand: most upper limits of the American Academy of Orthopaedic Surgeons "
         "1965;\n"
         "# T_ROT, PALM_ARCH and the lower limits of flexion are assumed there, without a source.\n";
  writer.posture("lower: ", hand.model.lower());
  out << "\n";
  writer.posture("upper: ", hand.model.upper());
  Eigen::VectorXd rest = Eigen::VectorXd::Zero(hand.model.dof());
  set_channels(hand, config["rest"], rest);
  Eigen::VectorXd open = Eigen::VectorXd::Zero(hand.model.dof());
  set_channels(hand, config["open"], open);
  out << "\n# Before the movement, and at the transition.\n";
  writer.posture("rest: ", rest);
  out << "\n";
  writer.posture("open: ", open);
  out << "\n" << kMovement << "\nobjects:  # m\n";
  for (const auto& object : config["objects"]) {
    out << "  " << object.first.as<std::string>() << ": " << flow(object.second) << "\n";
  }
  out << "\ntypes:\n";
  for (const auto& type : config["types"]) {
    const GraspSpec spec = grasp_spec(hand, type, open);
    const bool example = type["example"] && type["example"].as<bool>();
    out << "  - name: " << type["name"].as<std::string>() << "\n    family: \"" << type["family"].as<std::string>()
        << "\"\n    assumed: " << (example ? "false  # an example in the paper; the number is assumed" : "true")
        << "\n    ends:\n";
    for (const auto& object : type["objects"]) {
      const auto name = object.as<std::string>();
      const Closed closed = close_hand(hand, shape(config["objects"][name]), spec);
      out << "    - object: " << name << "  # touched by " << joined(closed.touching) << "\n";
      writer.posture("      posture: ", closed.posture);
      out << "\n";
      std::cout << type["name"].as<std::string>() << " on " << name << ": " << joined(closed.touching) << "\n";
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: simulated_postures CONFIG.yaml HAND.yaml OUT.yaml\n";
    return 2;
  }
  try {
    const Hand hand(robot::load_hand(argv[2]));
    std::ostringstream text;
    write(text, YAML::LoadFile(argv[1]), hand);
    std::ofstream file(argv[3], std::ios::binary);
    file << text.str();
    if (!file.flush()) throw std::runtime_error(std::string("cannot write ") + argv[3]);
  } catch (const std::exception& error) {
    std::cerr << "simulated_postures: " << error.what() << "\n";
    return 2;
  }
  return 0;
}
