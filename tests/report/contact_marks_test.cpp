// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/contact_marks.hpp"

#include <algorithm>
#include <cmath>
#include <regex>
#include <set>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "report/text.hpp"
#include "tests/report/markup_check.hpp"

namespace opponens::report {
namespace {

View seen_from(const Eigen::Vector3d& toward) {
  const Eigen::Vector3d up = toward.normalized().unitOrthogonal();
  return fit_view(toward, up, {{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}}, 300.0, 300.0, 10.0);
}

double angle_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0));
}

TEST(ConeOutline, SeenSquareItOpensByTheArcTangentOfFriction) {
  Rng rng = stream(1, "cone");
  for (const double mu : {0.1, 0.5, 1.0, 2.0}) {
    const Eigen::Vector3d n = Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
    const Contact contact{"tip", {0.01, -0.02, 0.03}, n, mu};
    const View view = seen_from(n.cross(n.unitOrthogonal()));
    const ConeOutline outline = cone_outline(contact, 0.05, view);
    const Eigen::Vector2d apex = view.project(contact.p_OC);
    const Eigen::Vector2d axis = outline.tip - apex;
    double widest = 0.0;
    for (const auto& p : outline.base) widest = std::max(widest, angle_between(p - apex, axis));
    EXPECT_NEAR(widest, std::atan(mu), 1e-9) << mu;
    double longest = 0.0;
    for (const auto& p : outline.silhouette) longest = std::max(longest, (p - apex).norm());
    EXPECT_NEAR(longest, 0.05 * view.scale, 1e-6);
    const Eigen::Vector2d into(view.right.dot(n), -view.up.dot(n));
    EXPECT_NEAR(angle_between(axis, into), 0.0, 1e-6) << "the axis is the normal, into the object";
  }
}

TEST(ConeOutline, SeenFromItsEndIsTheRimAlone) {
  const Contact contact{"tip", Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 0.5};
  const View view = seen_from(Eigen::Vector3d::UnitZ());
  const ConeOutline outline = cone_outline(contact, 0.05, view);
  EXPECT_EQ(outline.silhouette.size(), outline.base.size());
  for (const auto& p : outline.base) {
    EXPECT_NEAR((p - view.project(contact.p_OC)).norm(), 0.05 * std::sin(std::atan(0.5)) * view.scale, 1e-6);
  }
}

TEST(ConeOutline, WithoutFrictionIsTheNormal) {
  const Contact contact{"tip", Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(), 0.0};
  const ConeOutline outline = cone_outline(contact, 0.05, seen_from(Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(outline.silhouette.size(), 2U);
}

TEST(ConvexOutline, LeavesOutPointsInsideAndOnTheSides) {
  const auto hull = convex_outline({{0, 0}, {2, 0}, {1, 0}, {2, 2}, {0, 2}, {1, 1}, {0, 1}, {0, 0}});
  ASSERT_EQ(hull.size(), 4U);
  for (const auto& corner : {Eigen::Vector2d(0, 0), {2, 0}, {2, 2}, {0, 2}}) {
    EXPECT_NE(std::find(hull.begin(), hull.end(), corner), hull.end());
  }
  EXPECT_EQ(convex_outline({{1, 1}, {1, 1}}).size(), 1U);
  EXPECT_TRUE(convex_outline({}).empty());
}

std::string drawn(const std::vector<ContactMark>& marks, bool cones) {
  Svg svg(300.0, 300.0, "contacts");
  draw_contacts(svg, seen_from(Eigen::Vector3d::UnitZ()), marks, cones);
  return svg.str();
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

/// Contacts around a cylinder about z, two of them hidden, seen from above.
std::vector<ContactMark> ring(int contacts, double radius) {
  std::vector<ContactMark> marks;
  for (int i = 0; i < contacts; ++i) {
    const double angle = 6.2831853 * i / contacts;
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    marks.push_back({{"link", radius * out, -out, 0.5}, i % 3 - 1, i < 2});
  }
  return marks;
}

TEST(DrawContacts, EachHasItsConeNormalDotAndNumber) {
  const auto marks = ring(7, 0.06);
  const std::string svg = drawn(marks, true);
  EXPECT_EQ(markup_problems(svg), std::vector<std::string>{});
  EXPECT_EQ(count(svg, "class=\"cone\""), 7U);
  EXPECT_EQ(count(svg, "class=\"rim\""), 7U);
  EXPECT_EQ(count(svg, "class=\"axis-of-cone\""), 7U);
  EXPECT_EQ(count(svg, "<circle"), 7U);
  EXPECT_EQ(count(svg, "stroke-dasharray"), 4U) << "cone and rim of the two that are hidden";
  for (int i = 1; i <= 7; ++i) EXPECT_EQ(count(svg, concat({">", std::to_string(i), "</text>"})), 1U) << i;
  for (const int finger : {-1, 0, 1}) EXPECT_GT(count(svg, css(contact_paint(finger))), 0U) << finger;
  EXPECT_EQ(count(drawn(marks, false), "class=\"cone\""), 0U) << "a frictionless contact has no cone";
  auto slippery = marks;
  slippery[3].contact.mu = 0.0;
  EXPECT_EQ(count(drawn(slippery, true), "class=\"cone\""), 6U);
}

TEST(DrawContacts, NumbersOfCrowdedContactsDoNotCoverEachOther) {
  const std::string svg = drawn(ring(10, 0.012), true);  // 10 dots on a circle of 17 px
  static const std::regex kNumber(R"re(<text x="([-0-9.]+)" y="([-0-9.]+)" class="mark")re");
  std::vector<Eigen::Vector2d> places;
  for (std::sregex_iterator it(svg.begin(), svg.end(), kNumber), end; it != end; ++it) {
    places.emplace_back(std::stod((*it)[1].str()), std::stod((*it)[2].str()));
  }
  ASSERT_EQ(places.size(), 10U);
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Eigen::Vector2d apart = (places[i] - places[j]).cwiseAbs();
      EXPECT_TRUE(apart.x() > 6.0 || apart.y() > 9.0) << i + 1 << " over " << j + 1;
    }
  }
}

TEST(ContactPaint, FingersAndPalmAreToldApart) {
  std::set<std::string> colors;
  for (int finger = -1; finger < 5; ++finger) colors.insert(css(contact_paint(finger)));
  EXPECT_EQ(colors.size(), 6U);
  EXPECT_EQ(css({255, 0, 16, false}), "#ff0010");
}

}  // namespace
}  // namespace opponens::report
