// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/grasp_views.hpp"

#include <algorithm>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "report/body_drawing.hpp"
#include "report/grasp_drawing.hpp"
#include "tests/report/made_reports.hpp"

namespace opponens::report {
namespace {

std::vector<Facet> box_at(const Eigen::Vector3d& center, const Eigen::Vector3d& size) {
  robot::Geometry geometry{robot::Box{size}};
  geometry.X_BG.translation() = center;
  return facets(geometry, 0, {});
}

/// A cube of 10 cm between two small links that touch it at x = +-5 cm; a third link, a plate, lies over the first.
struct Pinch {
  GraspBodies bodies;
  std::vector<Contact> contacts;
};

Pinch pinch() {
  Pinch made;
  made.bodies.object = box_at(Eigen::Vector3d::Zero(), {0.1, 0.1, 0.1});
  made.bodies.links = {box_at({0.07, 0, 0}, {0.04, 0.02, 0.02}), box_at({-0.07, 0, 0}, {0.04, 0.02, 0.02}),
                       box_at({0.07, 0, 0.1}, {0.1, 0.04, 0.01})};
  made.bodies.contact_links = {0, 1};
  made.bodies.hand = {Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ()};
  made.bodies.up = Eigen::Vector3d::UnitZ();
  made.contacts = {{"first", {0.05, 0, 0}, -Eigen::Vector3d::UnitX(), 0.5},
                   {"second", {-0.05, 0, 0}, Eigen::Vector3d::UnitX(), 0.5}};
  return made;
}

TEST(Sights, TellTheObjectTheLinkThatTouchesAndOthersApart) {
  const Pinch made = pinch();
  const auto from = [&](const Eigen::Vector3d& toward) { return sights(made.bodies, made.contacts, toward); };
  using Two = std::vector<Sight>;
  EXPECT_EQ(from(Eigen::Vector3d::UnitY()), (Two{Sight::open, Sight::open}));
  EXPECT_EQ(from(Eigen::Vector3d::UnitX()), (Two{Sight::behind_link, Sight::behind_others}));
  EXPECT_EQ(from(-Eigen::Vector3d::UnitX()), (Two{Sight::behind_others, Sight::behind_link}));
  EXPECT_EQ(from(Eigen::Vector3d::UnitZ()), (Two{Sight::behind_others, Sight::open})) << "the plate covers the first";
  EXPECT_EQ(from(-Eigen::Vector3d::UnitZ()), (Two{Sight::open, Sight::open}));
}

TEST(Sights, ALinkThatTheHandLacksHidesAsAnyOther) {
  Pinch made = pinch();
  made.bodies.contact_links[0] = -1;
  EXPECT_EQ(sights(made.bodies, made.contacts, Eigen::Vector3d::UnitX())[0], Sight::behind_others);
}

TEST(GraspViews, ShowEveryContactFromDirectionsApart) {
  const Pinch made = pinch();
  const auto views = grasp_views(made.bodies, made.contacts, 3);
  ASSERT_EQ(views.size(), 3U);
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_NEAR(views[i].toward.norm(), 1.0, 1e-12);
    EXPECT_GT(views[i].toward.z(), 0.0) << "not from below: a support would stand there";
    EXPECT_EQ(views[i].sights, sights(made.bodies, made.contacts, views[i].toward));
    for (std::size_t j = 0; j < i; ++j) EXPECT_LT(views[i].toward.dot(views[j].toward), 0.7072);
  }
  EXPECT_EQ(views[0].sights, (std::vector<Sight>{Sight::open, Sight::open})) << "a side that shows both comes first";
  EXPECT_NEAR(views[0].toward.x(), 0.0, 1e-9) << "cones are seen from the side";
}

TEST(GraspViews, TurnWithTheGraspAboutTheVertical) {
  const Pinch made = pinch();
  const auto before = grasp_views(made.bodies, made.contacts, 3);
  const Eigen::Isometry3d turn(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  Pinch turned = made;
  turned.bodies.object.clear();
  append(turned.bodies.object, made.bodies.object, turn);
  for (std::size_t i = 0; i < made.bodies.links.size(); ++i) {
    turned.bodies.links[i].clear();
    append(turned.bodies.links[i], made.bodies.links[i], turn);
  }
  for (auto* axis : {&turned.bodies.hand.fingers, &turned.bodies.hand.palm, &turned.bodies.hand.thumb})
    *axis = turn * *axis;
  for (auto& contact : turned.contacts) {
    contact.p_OC = turn * contact.p_OC;
    contact.n_O = turn.linear() * contact.n_O;
  }
  const auto after = grasp_views(turned.bodies, turned.contacts, 3);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_LT((after[i].toward - turn * before[i].toward).norm(), 1e-9);
    EXPECT_EQ(after[i].words, before[i].words);
  }
}

TEST(GraspViews, WithoutContactsOrWithACountOfZeroAreDefined) {
  const Pinch made = pinch();
  EXPECT_TRUE(grasp_views(made.bodies, made.contacts, 0).empty());
  GraspBodies bodies = made.bodies;
  bodies.contact_links.clear();
  EXPECT_EQ(grasp_views(bodies, {}, 2).size(), 2U);
  EXPECT_LT(grasp_views(made.bodies, made.contacts, 100).size(), 37U) << "the directions come to an end";
}

TEST(GraspDrawing, ContactsHaveTheFingerOfTheirLink) {
  const ReportInput& input = small();
  const auto& body = input.scene->body(input.grasps->object);
  const GraspStage stage = grasp_stage(*input.hand, body);
  Grasp grasp = input.grasps->items[0].grasp;
  grasp.contacts.resize(2);
  grasp.contacts[0].link = input.hand->description().palm_link;
  const auto& thumb = *std::find_if(input.hand->description().tips.begin(), input.hand->description().tips.end(),
                                    [](const auto& tip) { return tip.finger == "thumb"; });
  grasp.contacts[1].link = input.hand->links()[static_cast<std::size_t>(thumb.link)].name;
  const auto names = finger_names(*input.hand);
  const auto fingers = contact_fingers(stage, grasp);
  EXPECT_EQ(fingers[0], -1);
  ASSERT_GE(fingers[1], 0);
  EXPECT_EQ(names[static_cast<std::size_t>(fingers[1])], "thumb");
  grasp.contacts[1].link = "no such link";
  EXPECT_EQ(contact_fingers(stage, grasp)[1], -1);
  EXPECT_EQ(grasp_bodies(stage, grasp).contact_links[1], -1);
}

TEST(GraspDrawing, TheHandStandsWhereTheGraspSaysInTheObjectsFrame) {
  const ReportInput& input = small();
  const GraspStage stage = grasp_stage(*input.hand, input.scene->body(input.grasps->object));
  Grasp grasp = input.grasps->items[0].grasp;
  const GraspBodies before = grasp_bodies(stage, grasp);
  grasp.X_OH.translation() += Eigen::Vector3d(0.01, -0.02, 0.03);
  const GraspBodies after = grasp_bodies(stage, grasp);
  for (std::size_t i = 0; i < before.links.size(); ++i) {
    for (std::size_t f = 0; f < before.links[i].size(); ++f) {
      const Eigen::Vector3d moved = after.links[i][f].corners[0] - before.links[i][f].corners[0];
      ASSERT_LT((moved - Eigen::Vector3d(0.01, -0.02, 0.03)).norm(), 1e-12);
    }
  }
  EXPECT_EQ(after.object.size(), before.object.size());
  EXPECT_EQ(after.object[0].corners, before.object[0].corners);
  robot::SceneBody nothing;
  EXPECT_THROW(grasp_stage(*input.hand, nothing), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::report
