// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/demonstration.hpp"

namespace opponens::analysis {

/// Where a closing ends: the hand around one object.
struct GraspEnd {
  std::string object;
  Eigen::VectorXd posture;  ///< [n] rad
};

struct SimulatedGraspType {
  std::string name;            ///< of Cutkosky's taxonomy, e.g. "medium_wrap"
  std::string family;          ///< "1" to "4"
  bool family_assumed = true;  ///< false only for the paper's four examples (caption of Fig. 9)
  std::vector<GraspEnd> ends;  ///< repetitions take them in turn; at least one
};

/// Free motions of the fingers: nothing in it comes from the grasps.
struct FreeMotionModel {
  int recordings = 6;
  double duration = 20.0;         ///< s, of each
  double segment_shortest = 0.5;  ///< s, duration of one minimum-jerk segment, uniform between the two
  double segment_longest = 1.5;   ///< s
  double deviation = 0.15;        ///< share of a joint's range by which it departs from its finger, standard deviation
};

/// The movement of a simulated hand, n glove channels. models/human/grasp_types.yaml holds the values with their
/// sources; the defaults here equal that file's. Differences from the paper's recordings: docs/deviations.md, 8 and 9.
struct SimulationModel {
  std::vector<std::string> channels;  ///< [n] canonical names
  std::vector<std::string> fingers;   ///< [n] whose common flexion drives the channel in free motion; "": its own
  Eigen::VectorXd lower;              ///< [n] rad, joint range of the human hand
  Eigen::VectorXd upper;              ///< [n] rad
  Eigen::VectorXd rest;               ///< [n] rad, posture before the movement
  Eigen::VectorXd open;               ///< [n] rad, posture at the transition, common to all types
  std::vector<SimulatedGraspType> types;
  double opening_duration = 0.9;   ///< s, mean
  double closing_duration = 1.1;   ///< s, mean
  double duration_spread = 0.12;   ///< standard deviation of the log of a duration
  double onset_spread = 0.08;      ///< s, a joint starts a phase later by uniform [0, this)
  double amplitude_spread = 0.06;  ///< standard deviation of the factor on a phase's displacement
  double rest_spread = 0.052;      ///< rad, standard deviation of each joint at rest
  double open_spread = 0.052;      ///< rad, the same at the transition
  double end_spread = 0.052;       ///< rad, the same at the end
  double noise = 0.0044;           ///< rad, standard deviation of a sensor
  double resolution = 0.0087;      ///< rad, of a sensor: values are rounded to multiples of it
  FreeMotionModel free;
};

struct SimulationSettings {
  int repetitions = 12;  ///< of each grasp type
  double rate = 50.0;    ///< Hz
  std::string subject = "simulated-1";
};

/// Throws std::invalid_argument naming what does not fit.
void validate(const SimulationModel& model);

/// Minimum-jerk course from 0 to 1 (Flash and Hogan 1985, doi:10.1523/JNEUROSCI.05-07-01688.1985):
/// s(u) = 10 u^3 - 15 u^4 + 6 u^5 for u in [0, 1], clamped outside.
double minimum_jerk(double u);

/// Recordings of a human hand in the form of the paper's section 3.2: per type `repetitions` two-phase movements, then
/// the free motions. Opening: every joint goes from rest to the open posture, the same in all types but for the
/// variation between repetitions. Closing: from there to the type's posture. The time the closing begins is
/// known_transition; a joint starts each phase up to onset_spread later and arrives at the phase's end. Values are
/// clipped to the joint ranges, then noise is added, then they are rounded to the resolution. Origin: simulated;
/// labels: subject, object, grasp_type, family, family_assumed, repetition, kind = "grasp" or "free".
/// Each recording has its own stream of the seed: adding types or repetitions changes no other recording.
std::vector<Demonstration> simulate(const SimulationModel& model, const SimulationSettings& settings,
                                    std::uint64_t seed);

}  // namespace opponens::analysis
