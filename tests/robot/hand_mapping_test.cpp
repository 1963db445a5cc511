// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/retarget.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>

#include "core/require.hpp"
#include "core/rng.hpp"
#include "robot/load_robot.hpp"
#include "tests/robot/swinging_hand.hpp"

namespace opponens::robot {
namespace {

using BoolCounts = Eigen::ArrayXXd;  ///< [T x n] 1 where clamped

TEST(HandMapping, ReadsTheMappingOfThePaper) {
  const HandMapping mapping = load_hand_mapping(kHand);
  EXPECT_EQ(mapping.copied.size(), 11u);
  EXPECT_EQ(mapping.fitted,
            (std::vector<std::string>{"joint_0.0", "joint_4.0", "joint_8.0", "joint_12.0", "joint_13.0"}));
  EXPECT_EQ(mapping.fingertips.at("ring"), "ring");
  EXPECT_THROW(load_hand_mapping(kHuman), InputError) << "it has no key 'mapping'";
}

TEST(HandMapping, MappingErrorsNameTheField) {
  const auto folder = std::filesystem::temp_directory_path() / "opponens_hand_mapping_test";
  std::filesystem::create_directories(folder);
  const auto error = [&](const std::string& mapping) {
    const auto file = folder / "hand.yaml";
    std::ofstream(file) << "urdf: x\npalm_link: a\njoints: [j, k]\ntips:\n  - {finger: i, link: a, point: [0, 0, 0], "
                           "normal: [1, 0, 0]}\nmapping:\n"
                        << mapping;
    try {
      load_hand_mapping(file);
    } catch (const InputError& caught) {
      return std::string(caught.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(error("  copied: [{joint: j, channel: C}]\n  fitted: [k]\n  fingertips: {i: index}\n"), "no error");
  EXPECT_NE(error("  copied: [{joint: z, channel: C}]\n").find("hand.yaml:7: mapping.copied[0].joint"),
            std::string::npos);
  EXPECT_NE(error("  copied: [{joint: j, channel: C}]\n  fitted: [j]\n").find("mapped twice"), std::string::npos);
  EXPECT_NE(error("  copied: []\n  fingertips: {thumb: thumb}\n").find("no tip 'thumb'"), std::string::npos);
  EXPECT_NE(error("  copied: [{joint: j, channel: C, gain: high}]\n").find("expected a number"), std::string::npos);
  std::filesystem::remove_all(folder);
}

TEST(Retarget, CopiesExactlyStaysInsideTheLimitsAndKeepsTheRest) {
  const Hands hands;
  const Demonstration recording = swing(hands.human, 0.0, 1.0);
  const auto result = retarget(recording, {}, hands.human, hands.hand, hands.mapping, {});
  ASSERT_TRUE(result) << result.error().detail;
  const Demonstration& mapped = result->demonstration;
  EXPECT_EQ(mapped.joint_names, hands.hand.joint_names());
  EXPECT_EQ(mapped.labels, recording.labels);
  EXPECT_EQ(mapped.time, recording.time);
  EXPECT_EQ(mapped.origin, Origin::simulated);
  for (Eigen::Index t = 0; t < mapped.q_h.rows(); ++t) {
    EXPECT_TRUE(hands.hand.within_limits(mapped.q_h.row(t).transpose(), 0.0)) << "sample " << t;
  }
  for (const JointMapping& copy : hands.mapping.copied) {
    const Eigen::Index joint = column(mapped, copy.joint);
    const Eigen::VectorXd wanted = recording.q_h.col(column(recording, copy.channel))
                                       .cwiseMax(hands.hand.lower()[joint])
                                       .cwiseMin(hands.hand.upper()[joint]);
    EXPECT_EQ(mapped.q_h.col(joint), wanted) << copy.joint;
  }
  // Clamped: a copied joint wanted beyond its limits (the human PIP joints bend to 100 deg, the Allegro's to 1.709 rad;
  // the thumb's IP back to -15 deg and -0.162 rad), or a fitted one on its limit.
  BoolCounts counts = BoolCounts::Zero(mapped.q_h.rows(), mapped.q_h.cols());
  for (const JointMapping& copy : hands.mapping.copied) {
    const Eigen::Index joint = column(mapped, copy.joint);
    const auto wanted = recording.q_h.col(column(recording, copy.channel)).array();
    counts.col(joint) = (wanted < hands.hand.lower()[joint] || wanted > hands.hand.upper()[joint]).cast<double>();
  }
  for (const std::string& name : hands.mapping.fitted) {
    const Eigen::Index joint = column(mapped, name);
    const auto q = mapped.q_h.col(joint).array();
    counts.col(joint) = (q == hands.hand.lower()[joint] || q == hands.hand.upper()[joint]).cast<double>();
  }
  EXPECT_GT(counts.sum(), 0.0);
  EXPECT_TRUE(result->clamped_share.isApprox(counts.colwise().mean().transpose().matrix(), 1e-12));
  EXPECT_EQ(result->clamped_samples, (counts.rowwise().maxCoeff() > 0.0).count());
}

TEST(Retarget, CalibrationGainAndClampingAreApplied) {
  const Hands hands;
  Demonstration recording = swing(hands.human, 0.4, 0.5);
  ChannelCalibration calibration{{"I_MCP"}, Eigen::VectorXd::Constant(1, -1.0), Eigen::VectorXd::Constant(1, 5.0)};
  const auto result = retarget(recording, calibration, hands.human, hands.hand, hands.mapping, {});
  ASSERT_TRUE(result) << result.error().detail;
  EXPECT_EQ(result->clamped_samples, recording.q_h.rows());
  const Eigen::Index joint = column(result->demonstration, "joint_1.0");
  EXPECT_TRUE((result->demonstration.q_h.col(joint).array() == hands.hand.upper()[joint]).all());
}

TEST(Retarget, RecoversTheRobotsOwnMovement) {
  const Hands hands;
  const Demonstration recording = swing(hands.hand, 0.3, 0.7);
  const HandMapping mapping = self_mapping(hands.mapping);
  const auto exact = retarget(recording, {}, hands.hand, hands.hand, mapping, {.velocity = 0.0, .rest = 1e-4});
  ASSERT_TRUE(exact) << exact.error().detail;
  // Flexed fingers and the thumb are identifiable from their tips.
  EXPECT_LT((exact->demonstration.q_h - recording.q_h).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_LT(exact->tip_residual_max, 1e-6);
  const auto smooth = retarget(recording, {}, hands.hand, hands.hand, mapping, {});
  ASSERT_TRUE(smooth) << smooth.error().detail;
  EXPECT_LT((smooth->demonstration.q_h - recording.q_h).cwiseAbs().maxCoeff(), 5e-3);
}

TEST(Retarget, FittingReducesTheTipResidual) {
  const Hands hands;
  HandMapping unfitted = hands.mapping;
  unfitted.fitted.clear();
  const Demonstration human = swing(hands.human, 0.2, 0.8);
  const auto fitted = retarget(human, {}, hands.human, hands.hand, hands.mapping, {});
  const auto rest = retarget(human, {}, hands.human, hands.hand, unfitted, {});
  ASSERT_TRUE(fitted && rest);
  EXPECT_LT(fitted->tip_residual_rms, rest->tip_residual_rms);
  EXPECT_GT(fitted->tip_residual_rms, 1e-3) << "the hands differ: a perfect fit would mean that nothing is compared";
  // Where a perfect fit exists, it is found.
  const Demonstration robot = swing(hands.hand, 0.3, 0.7);
  const auto own = retarget(robot, {}, hands.hand, hands.hand, self_mapping(hands.mapping), {});
  const auto own_rest = retarget(robot, {}, hands.hand, hands.hand, self_mapping(unfitted), {});
  ASSERT_TRUE(own && own_rest);
  EXPECT_LT(own->tip_residual_rms, 0.01 * own_rest->tip_residual_rms);
}

/// At the optimum inside the limits the gradient of the documented cost vanishes; this writes that cost a second time.
TEST(Retarget, NoNeighbourIsBetter) {
  const Hands hands;
  const Demonstration recording = swing(hands.hand, 0.3, 0.7, 8);
  HandMapping mapping = self_mapping(hands.mapping);
  const RetargetSettings settings{.velocity = 0.04, .rest = 0.5};
  const auto result = retarget(recording, {}, hands.hand, hands.hand, mapping, settings);
  ASSERT_TRUE(result) << result.error().detail;
  const auto cost = [&](const Eigen::MatrixXd& q) {
    double sum = 0.0;
    for (Eigen::Index t = 0; t < q.rows(); ++t) {
      const auto X = hands.hand.link_poses(q.row(t).transpose());
      const auto Y = hands.hand.link_poses(recording.q_h.row(t).transpose());
      for (const SurfacePoint& tip : hands.hand.description().tips) {
        const auto link = static_cast<std::size_t>(tip.link);
        sum += (100.0 * (X[link] * tip.p_L - Y[link] * tip.p_L)).squaredNorm();
      }
      for (const std::string& name : mapping.fitted) {
        const Eigen::Index i = column(result->demonstration, name);
        sum += std::pow(settings.rest * (q(t, i) - 0.5 * (hands.hand.lower()[i] + hands.hand.upper()[i])), 2);
        if (t > 0) sum += std::pow(settings.velocity / 0.02 * (q(t, i) - q(t - 1, i)), 2);
      }
    }
    return sum;
  };
  const Eigen::MatrixXd best = result->demonstration.q_h;
  for (const std::string& name : mapping.fitted) {
    for (Eigen::Index t = 0; t < best.rows(); ++t) {
      for (const double step : {1e-3, -1e-3}) {
        Eigen::MatrixXd moved = best;
        moved(t, column(result->demonstration, name)) += step;
        EXPECT_GT(cost(moved), cost(best)) << name << " sample " << t;
      }
    }
  }
  EXPECT_LT(cost(best), 0.99 * cost(recording.q_h)) << "smoothing trades tip positions: the input is not optimal";
}

TEST(Retarget, TheSizeOfTheHumanHandDoesNotMatter) {
  const Hands hands;
  const Demonstration recording = swing(hands.human, 0.2, 0.8, 20);
  const auto mapped = [&](double size) {
    return retarget(recording, {}, RobotModel(scaled(load_hand(kHuman), size)), hands.hand, hands.mapping, {}).value();
  };
  const Retargeted small = mapped(0.7);
  const Retargeted large = mapped(1.4);
  EXPECT_TRUE(small.demonstration.q_h.isApprox(large.demonstration.q_h, 1e-6));
  EXPECT_NEAR(small.tip_residual_rms, large.tip_residual_rms, 1e-9);
  // Another shape does: only the fingers' last bones are longer.
  RobotDescription pointed = load_hand(kHuman);
  for (SurfacePoint& tip : pointed.tips) tip.p_L *= 1.5;
  EXPECT_GT((retarget(recording, {}, RobotModel(pointed), hands.hand, hands.mapping, {}).value().demonstration.q_h -
             large.demonstration.q_h)
                .norm(),
            1e-2);
}

TEST(Retarget, SmoothnessShortensThePath) {
  const Hands hands;
  Demonstration recording = swing(hands.human, 0.2, 0.8);
  Rng rng(3);
  for (Eigen::Index i = 0; i < recording.q_h.size(); ++i) recording.q_h.data()[i] += 0.03 * rng.normal();
  const auto roughness = [&](double velocity) {
    const auto result = retarget(recording, {}, hands.human, hands.hand, hands.mapping, {.velocity = velocity});
    EXPECT_TRUE(result);
    double sum = 0.0;
    for (const std::string& name : hands.mapping.fitted) {
      const auto q = result->demonstration.q_h.col(column(result->demonstration, name));
      sum += (q.tail(q.size() - 1) - q.head(q.size() - 1)).squaredNorm();
    }
    return sum;
  };
  EXPECT_LT(roughness(0.1), 0.7 * roughness(0.002));
}

TEST(Retarget, PositionsHeldAtALimitAreOptimalToo) {
  const Hands hands;
  const Demonstration recording = swing(hands.human, 0.0, 1.0);
  HandMapping turned = hands.mapping;  // the thumb's targets lie out of its reach
  turned.R_robot_human = Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const auto result = retarget(recording, {}, hands.human, hands.hand, turned, {});
  ASSERT_TRUE(result) << result.error().detail;
  int at_limit = 0;
  for (const std::string& name : turned.fitted) {
    const Eigen::Index i = column(result->demonstration, name);
    const auto q = result->demonstration.q_h.col(i).array();
    at_limit += static_cast<int>((q == hands.hand.lower()[i] || q == hands.hand.upper()[i]).count());
  }
  EXPECT_GT(at_limit, 20);
}

TEST(Retarget, IsDeterministic) {
  const Hands hands;
  const Demonstration recording = swing(hands.human, 0.1, 0.9);
  const auto first = retarget(recording, {}, hands.human, hands.hand, hands.mapping, {});
  const auto second = retarget(recording, {}, hands.human, hands.hand, hands.mapping, {});
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->demonstration.q_h, second->demonstration.q_h);
}

TEST(Retarget, SaysWhatIsMissing) {
  const Hands hands;
  const Demonstration recording = swing(hands.human, 0.2, 0.8, 5);
  const auto code = [&](const Demonstration& input, const HandMapping& mapping) {
    const auto result = retarget(input, {}, hands.human, hands.hand, mapping, {});
    return result ? std::string("none") : result.error().detail;
  };
  EXPECT_EQ(code(recording, hands.mapping), "none");
  Demonstration renamed = recording;
  renamed.joint_names[static_cast<std::size_t>(column(recording, "R_PIP"))] = "other";
  EXPECT_NE(code(renamed, hands.mapping).find("no channel 'R_PIP'"), std::string::npos);
  HandMapping without = hands.mapping;  // nothing copied: the tips still need their channels
  without.copied.clear();
  EXPECT_NE(code(renamed, without).find("no channel 'R_PIP'"), std::string::npos);
  Demonstration broken = recording;
  broken.q_h(2, 2) = std::nan("");
  EXPECT_NE(code(broken, hands.mapping).find("not finite"), std::string::npos);
  HandMapping tips = hands.mapping;
  tips.fingertips.erase("thumb");
  EXPECT_NE(code(recording, tips).find("'joint_12.0' is fitted, but moves no mapped"), std::string::npos);
  tips = hands.mapping;
  tips.fingertips["index"] = "sixth";
  EXPECT_NE(code(recording, tips).find("no tip 'sixth'"), std::string::npos);
  Demonstration ragged = recording;
  ragged.time.conservativeResize(3);
  EXPECT_THROW(code(ragged, hands.mapping), std::invalid_argument);
}

TEST(Retarget, ChannelsThatAreAssumedAreNamed) {
  const Hands hands;
  const Demonstration recording = swing(hands.human, 0.2, 0.8, 5);
  const auto lacking = [&](const char* channel, MappingKind kind) {
    Demonstration input = recording;
    input.joint_names[static_cast<std::size_t>(column(recording, channel))] = "other";
    RetargetSettings settings = default_settings(kind);
    settings.alignment = HandAlignment{};
    return retarget(input, {}, hands.human, hands.hand, hands.mapping, settings);
  };
  for (const MappingKind kind : {MappingKind::joint, MappingKind::fingertip, MappingKind::paper}) {
    for (const char* channel : {"T_ROT", "I_ABD", "T_ABD"}) {
      const auto result = lacking(channel, kind);
      ASSERT_FALSE(result) << channel << " would be constant";
      EXPECT_EQ(result.error().code, FailureCode::not_found);
    }
    EXPECT_EQ(lacking("M_ABD", kind).value().assumed, std::vector<std::string>{"M_ABD"});
    EXPECT_TRUE(lacking("L_ABD", kind).value().assumed.empty()) << "the Allegro has no little finger";
  }
}

}  // namespace
}  // namespace opponens::robot
