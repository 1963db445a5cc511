// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/propose_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <set>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "robot/load_robot.hpp"
#include "robot/mesh.hpp"
#include "robot/mesh_distance.hpp"
#include "robot/ray_cast.hpp"
#include "robot_test.hpp"

namespace opponens::robot {
namespace {

using Eigen::Vector3d;

/// Signed distance to a shape, by formulas of its own; of a mesh the unsigned one.
double distance_to(const Geometry& geometry, const Vector3d& p_L) {
  const Vector3d p = geometry.X_BG.inverse() * p_L;
  if (const auto* sphere = std::get_if<Sphere>(&geometry.shape)) return p.norm() - sphere->radius;
  if (const auto* box = std::get_if<Box>(&geometry.shape)) return (p.cwiseAbs() - 0.5 * box->size).maxCoeff();
  if (const auto* cylinder = std::get_if<Cylinder>(&geometry.shape)) {
    return std::max(p.head<2>().norm() - cylinder->radius, std::abs(p.z()) - 0.5 * cylinder->length);
  }
  return std::abs(MeshDistance(std::get<std::shared_ptr<const TriangleMesh>>(geometry.shape)).signed_distance(p));
}

double distance_to(const Link& link, const Vector3d& p_L) {
  double least = 1e9;
  for (const Geometry& geometry : link.collision) least = std::min(least, distance_to(geometry, p_L));
  return least;
}

std::map<std::string, int> per_finger(const std::vector<SurfacePoint>& points) {
  std::map<std::string, int> count;
  for (const SurfacePoint& point : points) ++count[point.finger];
  return count;
}

/// On the surface, with a unit normal that leaves it.
void expect_on_surface(const RobotDescription& hand, const std::vector<SurfacePoint>& points) {
  std::set<std::string> names;
  for (const SurfacePoint& point : points) {
    const Link& link = hand.links[static_cast<std::size_t>(point.link)];
    EXPECT_NEAR(distance_to(link, point.p_L), 0.0, 1e-9) << point.name << " on " << link.name;
    EXPECT_NEAR(point.n_L.norm(), 1.0, 1e-9) << point.name;
    EXPECT_GT(distance_to(link, point.p_L + 1e-4 * point.n_L), 5e-5) << point.name << ": the normal does not leave";
    EXPECT_TRUE(names.insert(point.name).second) << point.name << " repeats";
  }
}

RobotDescription without_points(RobotDescription description, bool tips_too) {
  description.contact_points.clear();
  if (tips_too) description.tips.clear();
  return description;
}

const SurfacePoint& named(const std::vector<SurfacePoint>& points, const std::string& name) {
  return *std::find_if(points.begin(), points.end(), [&](const SurfacePoint& point) { return point.name == name; });
}

TEST(RayCast, FirstHitIsOnTheSurfaceAndNothingIsBefore) {
  Rng rng(11);
  const auto random = [&] { return Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)); };
  int hits = 0;
  for (int i = 0; i < 6000; ++i) {
    Geometry geometry{Box{Vector3d(0.5, 0.8, 1.1)}, at(0.1, 0.2, -0.1)};
    geometry.X_BG.rotate(Eigen::AngleAxisd(rng.uniform(-3, 3), random().normalized()));
    if (i % 3 == 1) geometry.shape = Sphere{0.6};
    if (i % 3 == 2) geometry.shape = Cylinder{0.4, 0.9};
    const Vector3d origin = 2.0 * random();
    if (distance_to(geometry, origin) < 0.01) continue;
    const Vector3d direction = (0.6 * random() - origin).normalized();
    const auto hit = first_hit(geometry, origin, direction);
    const double reach = hit ? hit->distance : 5.0;
    for (double t = 0.0; t < reach - 1e-3; t += 0.01) {
      ASSERT_GT(distance_to(geometry, origin + t * direction), 0.0) << i << ": it passes through the shape at " << t;
    }
    if (!hit) continue;
    ++hits;
    const Vector3d p = origin + hit->distance * direction;
    EXPECT_NEAR(distance_to(geometry, p), 0.0, 1e-12) << i;
    EXPECT_LE(hit->normal.dot(direction), 0.0) << i;
    EXPECT_GT(distance_to(geometry, p + 1e-4 * hit->normal), 9e-5) << i;
  }
  EXPECT_GT(hits, 3000);
}

TEST(RayCast, MeshOfABoxIsTheBox) {
  const Box box{Vector3d(0.5, 0.8, 1.1)};
  const Geometry shape{box, at(0.1, 0, 0)};
  const Geometry mesh{std::make_shared<const TriangleMesh>(triangulate(box)), at(0.1, 0, 0)};
  Rng rng(12);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d origin(rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(1, 2));
    const Vector3d direction = (Vector3d(rng.uniform(-0.4, 0.4), rng.uniform(-0.4, 0.4), 0.2) - origin).normalized();
    const auto a = first_hit(shape, origin, direction);
    const auto b = first_hit(mesh, origin, direction);
    ASSERT_EQ(a.has_value(), b.has_value()) << i;
    if (!a) continue;
    EXPECT_NEAR(a->distance, b->distance, 1e-12) << i;
    EXPECT_NEAR((a->normal - b->normal).norm(), 0.0, 1e-9) << i;
  }
  EXPECT_FALSE(first_hit(shape, Vector3d(0, 0, 2), Vector3d::UnitZ()).has_value());
}

TEST(ProposeContacts, OurAllegroGetsTheLayoutOfFigure5) {
  const RobotDescription given = load_hand(ours("ur5_allegro/allegro_right.yaml"));
  for (const bool tips_too : {false, true}) {
    const RobotModel hand(without_points(given, tips_too));
    const ContactProposal proposal = propose_contacts(hand);
    EXPECT_EQ(per_finger(proposal.contact_points),
              (std::map<std::string, int>{{"index", 4}, {"middle", 4}, {"ring", 4}, {"thumb", 3}, {"palm", 3}}));
    expect_on_surface(given, proposal.contact_points);
    expect_on_surface(given, proposal.tips);
    // The pads lie where the hand's own points do: same link, same face, near the middle.
    for (const SurfacePoint& point : given.contact_points) {
      if (point.finger == "palm") continue;
      const SurfacePoint& found = named(proposal.contact_points, point.name);
      EXPECT_EQ(found.link, point.link) << point.name;
      EXPECT_GT(found.n_L.dot(point.n_L), 0.85) << point.name;
      EXPECT_LT((found.p_L - point.p_L).norm(), 0.008) << point.name;
    }
    for (const SurfacePoint& point : proposal.contact_points) {
      if (point.finger == "palm") {
        EXPECT_EQ(point.n_L, Vector3d::UnitX()) << "out of the palm";
      }
    }
    if (!tips_too) {
      EXPECT_EQ(named(proposal.tips, "index").p_L, named(given.tips, "index").p_L) << "given ones are kept";
    }
  }
}

TEST(ProposeContacts, TheSameWithTheArmAndTwice) {
  const RobotModel hand(without_points(load_hand(ours("ur5_allegro/allegro_right.yaml")), false));
  const RobotModel robot(without_points(load_robot(ours("ur5_allegro/ur5_allegro_right.yaml")), false));
  const ContactProposal alone = propose_contacts(hand);
  const ContactProposal mounted = propose_contacts(robot);
  ASSERT_EQ(alone.contact_points.size(), mounted.contact_points.size());
  for (std::size_t i = 0; i < alone.contact_points.size(); ++i) {
    EXPECT_EQ(alone.contact_points[i].name, mounted.contact_points[i].name);
    EXPECT_NEAR((alone.contact_points[i].p_L - mounted.contact_points[i].p_L).norm(), 0.0, 1e-9);
  }
  const ContactProposal again = propose_contacts(hand);
  for (std::size_t i = 0; i < alone.contact_points.size(); ++i) {
    EXPECT_EQ(alone.contact_points[i].p_L, again.contact_points[i].p_L);
  }
}

TEST(ProposeContacts, HumanHand) {
  const RobotDescription given = load_hand(ours("human_hand/human_hand.yaml"));
  const ContactProposal proposal = propose_contacts(RobotModel(without_points(given, true)));
  expect_on_surface(given, proposal.contact_points);
  const auto count = per_finger(proposal.contact_points);
  for (const char* finger : {"index", "middle", "ring", "little"}) EXPECT_EQ(count.at(finger), 4) << finger;
  EXPECT_EQ(count.at("thumb"), 3);
}

/// A base with fingers, each a box on a joint; jaws: prismatic. Root frame: z ahead.
struct Digit {
  std::string name;
  Eigen::Isometry3d X_PJ;
  Vector3d axis;
  double lower, upper;
};

RobotDescription hand_of_digits(const std::vector<Digit>& digits, JointType type) {
  RobotDescription hand;
  hand.name = "made";
  hand.palm_link = "palm";
  hand.links.push_back({"palm", -1, {{Box{Vector3d(0.1, 0.1, 0.02)}, at(0, 0, -0.01)}}});
  for (const Digit& digit : digits) {
    const int index = static_cast<int>(hand.joints.size());
    hand.joints.push_back(
        {digit.name + "_joint", type, 0, index + 1, digit.X_PJ, digit.axis, digit.lower, digit.upper, 1.0, {}, {}, {}});
    hand.links.push_back({digit.name, index, {{Box{Vector3d(0.01, 0.02, 0.06)}, at(0, 0, 0.03)}}});
    hand.hand_joints.push_back(digit.name + "_joint");
  }
  hand.weights = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(digits.size()));
  return hand;
}

TEST(ProposeContacts, JawsFaceEachOtherAndThePalmLiesBehindThem) {
  for (const double sign : {1.0, -1.0}) {  // of the axis: the sense of a jaw's joint is not its direction
    const RobotDescription hand = hand_of_digits({{"left", at(0.03, 0, 0), Vector3d(-sign, 0, 0), 0, 0.03},
                                                  {"right", at(-0.03, 0, 0), Vector3d(sign, 0, 0), 0, 0.03}},
                                                 JointType::prismatic);
    const ContactProposal proposal = propose_contacts(RobotModel(hand));
    expect_on_surface(hand, proposal.contact_points);
    int pads = 0;
    for (const SurfacePoint& point : proposal.contact_points) {
      if (point.finger == "palm") {
        EXPECT_EQ(point.n_L, Vector3d::UnitZ());
      }
      if (point.link == 1) {
        EXPECT_LT(point.n_L.x(), -0.5) << point.name;
      }
      if (point.link == 2) {
        EXPECT_GT(point.n_L.x(), 0.5) << point.name;
      }
      pads += point.finger == "palm" ? 0 : 1;
    }
    EXPECT_EQ(pads, 8) << "three pads and a tip each, on their only link";
    EXPECT_EQ(per_finger(proposal.contact_points).at("palm"), 3);
  }
}

TEST(ProposeContacts, PadsAreOnTheSideToWhichTheFingerBendsFurther) {
  for (const double sense : {1.0, -1.0}) {
    const RobotDescription hand = hand_of_digits(
        {{"finger_a", at(0, 0.03, 0), Vector3d::UnitY(), sense > 0 ? -0.2 : -1.5, sense > 0 ? 1.5 : 0.2},
         {"finger_b", at(0, -0.03, 0), Vector3d::UnitY(), sense > 0 ? -0.2 : -1.5, sense > 0 ? 1.5 : 0.2}},
        JointType::revolute);
    const ContactProposal proposal = propose_contacts(RobotModel(hand));
    expect_on_surface(hand, proposal.contact_points);
    for (const SurfacePoint& point : proposal.contact_points) EXPECT_GT(sense * point.n_L.x(), 0.5) << point.name;
    EXPECT_TRUE(proposal.notes.empty());
  }
}

TEST(ProposeContacts, WithoutGeometryItSaysSo) {
  RobotDescription hand = hand_of_digits({{"a", at(0, 0.03, 0), Vector3d::UnitY(), 0, 1}}, JointType::revolute);
  for (Link& link : hand.links) link.collision.clear();
  const ContactProposal proposal = propose_contacts(RobotModel(hand));
  EXPECT_TRUE(proposal.contact_points.empty());
  EXPECT_TRUE(proposal.tips.empty());
  EXPECT_FALSE(proposal.notes.empty());
}

TEST(ProposeContacts, RealHands) {
  const std::string hands = OPPONENS_SHARED_DATA "/data/robots/dex-urdf/robots/hands/";
  if (!std::filesystem::exists(hands)) GTEST_SKIP() << "no " << hands;
  setenv("DEX_URDF", OPPONENS_SHARED_DATA "/data/robots/dex-urdf", 1);
  const RobotDescription shadow = load_hand(ours("shadow_hand/shadow_right.yaml"));
  const ContactProposal found = propose_contacts(RobotModel(without_points(shadow, true)));
  expect_on_surface(shadow, found.contact_points);
  const auto count = per_finger(found.contact_points);
  for (const char* finger : {"index", "middle", "ring", "little"}) EXPECT_EQ(count.at(finger), 4) << finger;
  EXPECT_EQ(count.at("thumb"), 3);
  EXPECT_EQ(count.at("palm"), 3);
  for (const SurfacePoint& point : found.contact_points) {
    if (point.finger != "thumb") {
      EXPECT_LT(point.n_L.y(), -0.4) << point.name << ": -y is the Shadow hand's palm side";
    }
  }

  const RobotDescription barrett = load_hand(ours("barrett_hand/barrett_right.yaml"));
  const ContactProposal three = propose_contacts(RobotModel(without_points(barrett, false)));
  expect_on_surface(barrett, three.contact_points);
  EXPECT_EQ(per_finger(three.contact_points),
            (std::map<std::string, int>{{"index", 4}, {"middle", 4}, {"thumb", 3}, {"palm", 3}}));
}

}  // namespace
}  // namespace opponens::robot
