// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/retarget.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "robot/finger.hpp"
#include "robot/load_robot.hpp"
#include "tests/robot/swinging_hand.hpp"

namespace opponens::robot {
namespace {

/// The Allegro as its own human under the identity: an exactly reachable motion of all joints.
RetargetSettings own_settings() {
  RetargetSettings settings = default_settings(MappingKind::fingertip);
  settings.alignment = HandAlignment{};
  return settings;
}

TEST(RetargetFingertip, AnExactlyReachableMotionIsFollowed) {
  const Hands hands;
  HandMapping mapping = self_mapping(hands.mapping);
  mapping.direct.clear();
  const Demonstration recording = swing(hands.hand, 0.3, 0.7);
  RetargetSettings settings = own_settings();
  settings.acceleration = 0.0;
  settings.rest = 1e-4;
  settings.max_iterations = 2000;
  const auto result = retarget(recording, {}, hands.hand, hands.hand, mapping, settings);
  ASSERT_TRUE(result) << result.error().detail;
  EXPECT_LT(result->tip_residual_max, 1e-5);
  EXPECT_EQ(result->tips, (std::vector<std::string>{"index", "middle", "ring", "thumb"}));
  // Companion: targets elsewhere are not followed, so it is the positions that are compared.
  settings.alignment->offset.x() = 0.1;
  const auto far = retarget(recording, {}, hands.hand, hands.hand, mapping, settings);
  ASSERT_TRUE(far);
  EXPECT_GT(far->tip_residual_rms, 1e-3);
}

Finger finger(const RobotModel& model, const std::string& name) {
  const auto& tips = model.description().tips;
  const auto found = std::find_if(tips.begin(), tips.end(), [&](const SurfacePoint& tip) { return tip.name == name; });
  return finger_of(model, *found);
}

/// m, from a point to the nearest place of the thumb's tip, over a grid of all four of its joints.
double distance_to_reach(const RobotModel& hand, const Eigen::Vector3d& point) {
  constexpr int kSteps = 14;
  const Finger thumb = finger(hand, "thumb");
  double nearest = 1e9;
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(hand.dof(), 1);
  for (int cell = 0; cell < kSteps * kSteps * kSteps * kSteps; ++cell) {
    int rest = cell;
    for (const int joint : thumb.moved_by) {
      q(joint, 0) = hand.lower()[joint] + (hand.upper()[joint] - hand.lower()[joint]) * (rest % kSteps) / (kSteps - 1);
      rest /= kSteps;
    }
    nearest = std::min(nearest, (tip_path(hand, thumb, q).col(0) - point).norm());
  }
  return nearest;
}

/// Why --mapping paper leaves the thumb far off: the hand opened to grasp asks for places that no posture of the
/// Allegro's thumb reaches. A grid step moves the tip by less than 2 cm, so a reachable point is within 1 cm per axis.
TEST(RetargetFingertip, ThePapersThumbTargetIsOutOfReachAndTheAlignedOneIsNot) {
  const Hands hands;
  Eigen::MatrixXd q = hands.human.clip(Eigen::VectorXd::Zero(hands.human.dof()));
  const std::map<std::string, double> open = {{"T_ROT", 0.96}, {"T_ABD", 0.87}, {"T_MCP", 0.07}, {"T_IP", 0.03}};
  for (int i = 0; i < hands.human.dof(); ++i) {
    const auto found = open.find(hands.human.joint_names()[static_cast<std::size_t>(i)]);
    if (found != open.end()) q(i, 0) = found->second;
  }
  const Eigen::Vector3d tip = tip_path(hands.human, finger(hands.human, "thumb"), q).col(0);
  const Finger ours = finger(hands.hand, "index");
  const Finger theirs = finger(hands.human, "index");
  const double paper = distance_to_reach(hands.hand, ours.base + ours.length / theirs.length * (tip - theirs.base));
  const HandAlignment alignment = align_hands(hands.human, hands.hand, hands.mapping).value();
  const double aligned = distance_to_reach(hands.hand, alignment.offset + alignment.scale * tip);
  EXPECT_GT(paper, 0.03);
  EXPECT_LT(aligned, 0.02);
}

TEST(RetargetFingertip, TheAlignmentBringsTheThumbIntoReach) {
  const Hands hands;
  const auto alignment = align_hands(hands.human, hands.hand, hands.mapping);
  ASSERT_TRUE(alignment) << alignment.error().detail;
  double scale = 0.0;
  for (const char* name : {"index", "middle", "ring", "thumb"}) {
    scale += 0.25 * finger(hands.hand, name).length / finger(hands.human, name).length;
  }
  EXPECT_NEAR(alignment->scale, scale, 1e-12);
  const Demonstration recording = swing(hands.human, 0.3, 0.6);
  const auto paper = retarget(recording, {}, hands.human, hands.hand, hands.mapping, {});
  RetargetSettings settings = default_settings(MappingKind::fingertip);
  settings.alignment = *alignment;
  const auto fingertip = retarget(recording, {}, hands.human, hands.hand, hands.mapping, settings);
  ASSERT_TRUE(paper && fingertip);
  EXPECT_LT(fingertip->tip_rms[3], 0.5 * paper->tip_rms[3]) << "the thumb is last by name";
  for (Eigen::Index t = 0; t < recording.q_h.rows(); ++t) {
    EXPECT_TRUE(hands.hand.within_limits(fingertip->demonstration.q_h.row(t).transpose(), 0.0)) << "sample " << t;
  }
}

TEST(RetargetFingertip, TheSizeOfTheHumanHandMattersForTheSameAlignment) {
  const Hands hands;
  const Demonstration recording = swing(hands.human, 0.3, 0.6, 20);
  RetargetSettings settings = default_settings(MappingKind::fingertip);
  settings.alignment = align_hands(hands.human, hands.hand, hands.mapping).value();
  const auto mapped = [&](double size) {
    return retarget(recording, {}, RobotModel(scaled(load_hand(kHuman), size)), hands.hand, hands.mapping, settings)
        .value()
        .demonstration.q_h;
  };
  EXPECT_GT((mapped(0.9) - mapped(1.1)).cwiseAbs().maxCoeff(), 0.05);
}

/// The cost of retarget.hpp is a time average: recorded twice as densely, the same motion gives the same result.
TEST(RetargetFingertip, TheSamplingRateDoesNotMatter) {
  const Hands hands;
  HandMapping mapping = self_mapping(hands.mapping);
  mapping.direct.clear();
  RetargetSettings settings = own_settings();
  settings.acceleration = 0.05;  // strong, so that a wrong weight would show
  const auto at = [&](int factor) {
    const int samples = 40 * factor + 1;
    Demonstration recording = swing(hands.hand, 0.3, 0.7, 2);
    recording.time = Eigen::VectorXd::LinSpaced(samples, 0.0, 0.8);
    recording.q_h.resize(samples, hands.hand.dof());
    for (int t = 0; t < samples; ++t) {
      for (int i = 0; i < hands.hand.dof(); ++i) {
        const double share = 0.5 + 0.2 * std::sin(i + 12.0 * recording.time[t]);
        recording.q_h(t, i) = hands.hand.lower()[i] + share * (hands.hand.upper()[i] - hands.hand.lower()[i]);
      }
    }
    return retarget(recording, {}, hands.hand, hands.hand, mapping, settings).value();
  };
  const Retargeted coarse = at(1);
  const Retargeted fine = at(2);
  EXPECT_GT(coarse.tip_residual_rms, 1e-4) << "smoothing trades tip positions";
  EXPECT_NEAR(fine.tip_residual_rms, coarse.tip_residual_rms, 0.1 * coarse.tip_residual_rms);
}

TEST(RetargetFingertip, LimitsAreNeverViolatedAndSharesAreCounted) {
  const Hands hands;
  RetargetSettings settings = default_settings(MappingKind::fingertip);
  settings.alignment = align_hands(hands.human, hands.hand, hands.mapping).value();
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    Rng rng(seed);
    Demonstration recording = swing(hands.human, 0.0, 1.0, 30);
    for (Eigen::Index i = 0; i < recording.q_h.size(); ++i) recording.q_h.data()[i] += 0.2 * rng.normal();
    const auto result = retarget(recording, {}, hands.human, hands.hand, hands.mapping, settings);
    ASSERT_TRUE(result) << "seed " << seed;
    const Eigen::MatrixXd& q = result->demonstration.q_h;
    Eigen::VectorXd share = Eigen::VectorXd::Zero(q.cols());
    for (Eigen::Index t = 0; t < q.rows(); ++t) {
      ASSERT_TRUE(hands.hand.within_limits(q.row(t).transpose(), 0.0)) << "seed " << seed << " sample " << t;
      for (Eigen::Index i = 0; i < q.cols(); ++i) {
        if (q(t, i) == hands.hand.lower()[i] || q(t, i) == hands.hand.upper()[i]) share[i] += 1.0 / q.rows();
      }
    }
    EXPECT_TRUE(result->clamped_share.isApprox(share, 1e-9)) << "seed " << seed;
    EXPECT_GT(share.maxCoeff(), 0.0);
  }
}

/// A table of postures has no order, so none may show in the result.
TEST(RetargetFingertip, PermutingPosturesPermutesTheResult) {
  const Hands hands;
  const Demonstration recording = swing(hands.human, 0.2, 0.8, 12);
  Demonstration turned = recording;
  turned.q_h = recording.q_h.colwise().reverse().eval();
  for (const MappingKind kind : {MappingKind::fingertip, MappingKind::paper}) {
    RetargetSettings settings = default_settings(kind);
    settings.alignment = HandAlignment{1.5, Eigen::Vector3d::Zero()};
    const auto mapped = [&](const Demonstration& postures, bool unordered) {
      settings.postures = unordered;
      return retarget(postures, {}, hands.human, hands.hand, hands.mapping, settings).value().demonstration.q_h;
    };
    EXPECT_EQ(mapped(turned, true).colwise().reverse().eval(), mapped(recording, true));
    Demonstration slower = recording;  // companion: as movements they depend on time and order
    slower.q_h.row(5) = recording.q_h.row(0);
    EXPECT_EQ(mapped(slower, true).row(4), mapped(recording, true).row(4));
    EXPECT_NE(mapped(slower, false).row(4), mapped(recording, false).row(4));
  }
}

TEST(RetargetFingertip, SaysWhenTheSolverStoppedEarly) {
  const Hands hands;
  RetargetSettings settings = default_settings(MappingKind::fingertip);
  settings.alignment = HandAlignment{1.5, Eigen::Vector3d::Zero()};
  settings.max_iterations = 3;
  const Demonstration recording = swing(hands.human, 0.2, 0.8, 20);
  const auto early = retarget(recording, {}, hands.human, hands.hand, hands.mapping, settings);
  ASSERT_TRUE(early);
  EXPECT_FALSE(early->converged);
  HandMapping without = hands.mapping;
  without.fingertips.clear();
  const auto none = retarget(recording, {}, hands.human, hands.hand, without, settings);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().detail.find("names no fingertip"), std::string::npos);
}

TEST(RetargetJoint, RangesAreLaidOnRangesAndSignsTurn) {
  const Hands hands;
  const Demonstration recording = swing(hands.human, 0.0, 1.0);
  RetargetSettings settings = default_settings(MappingKind::joint);
  settings.alignment = HandAlignment{};
  const auto result = retarget(recording, {}, hands.human, hands.hand, hands.mapping, settings);
  ASSERT_TRUE(result) << result.error().detail;
  const auto share = [](const RobotModel& model, const Demonstration& motion, const std::string& name) {
    const Eigen::Index i = column(motion, name);
    return ((motion.q_h.col(i).array() - model.lower()[i]) / (model.upper()[i] - model.lower()[i])).eval();
  };
  const Demonstration& mapped = result->demonstration;
  EXPECT_TRUE(share(hands.hand, mapped, "joint_12.0").isApprox(share(hands.human, recording, "T_ROT"), 1e-9));
  EXPECT_EQ(mapped.q_h.col(column(mapped, "joint_8.0")), -recording.q_h.col(column(recording, "R_ABD")));
}

/// Another hand than the Allegro, from a URDF that is not in this repository.
TEST(RetargetShadow, FollowsAHumanHand) {
  const std::string urdf = OPPONENS_SHARED_DATA "/data/robots/dex-urdf/robots/hands/shadow_hand/shadow_hand_right.urdf";
  if (!std::filesystem::exists(urdf)) GTEST_SKIP() << urdf << " is absent";
  const std::string yaml = OPPONENS_SOURCE_DIR "/models/shadow_hand/shadow_right.yaml";
  const RobotModel human(load_hand(kHuman));
  const RobotModel shadow(load_hand(yaml, urdf));
  const HandMapping mapping = load_hand_mapping(yaml);
  const Demonstration recording = swing(human, 0.3, 0.6, 30);
  for (const MappingKind kind : {MappingKind::joint, MappingKind::fingertip, MappingKind::paper}) {
    const auto result = retarget(recording, {}, human, shadow, mapping, default_settings(kind));
    ASSERT_TRUE(result) << result.error().detail;
    EXPECT_EQ(result->tips.size(), 5u);
    for (Eigen::Index t = 0; t < recording.q_h.rows(); ++t) {
      EXPECT_TRUE(shadow.within_limits(result->demonstration.q_h.row(t).transpose(), 0.0));
    }
    if (kind == MappingKind::fingertip) {
      EXPECT_LT(result->tip_residual_rms, 0.01) << "an anthropomorphic hand";
    }
  }
}

TEST(RetargetMimic, ACoupledJointIsFittedThroughItsDriver) {
  const auto folder = std::filesystem::temp_directory_path() / "opponens_mimic_test";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "hand.urdf")
      << "<robot name='h'><link name='palm'/><link name='a'/><link name='b'/>"
         "<joint name='driver' type='revolute'><parent link='palm'/><child link='a'/><axis xyz='0 1 0'/>"
         "<limit lower='0' upper='1.5' velocity='1' effort='1'/></joint>"
         "<joint name='follower' type='revolute'><parent link='a'/><child link='b'/><origin xyz='0 0 0.05'/>"
         "<axis xyz='0 1 0'/><limit lower='0' upper='1.5' velocity='1' effort='1'/>"
         "<mimic joint='driver' multiplier='0.7'/></joint></robot>";
  std::ofstream(folder / "hand.yaml") << "urdf: hand.urdf\npalm_link: palm\njoints: [driver]\ntips:\n"
                                         "  - {finger: index, link: b, point: [0, 0, 0.04], normal: [0, 0, 1]}\n"
                                         "mapping:\n  copied: []\n  fingertips: {index: index}\n";
  const RobotModel hand(load_hand(folder / "hand.yaml"));
  const HandMapping mapping = load_hand_mapping(folder / "hand.yaml");
  RetargetSettings settings = own_settings();
  settings.acceleration = 0.0;
  settings.rest = 1e-4;
  const Demonstration recording = swing(hand, 0.2, 0.8, 20);
  const auto result = retarget(recording, {}, hand, hand, mapping, settings);
  ASSERT_TRUE(result) << result.error().detail;
  EXPECT_LT(result->tip_residual_max, 1e-5);
  EXPECT_LT((result->demonstration.q_h - recording.q_h).cwiseAbs().maxCoeff(), 1e-3);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace opponens::robot
