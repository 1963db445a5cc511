// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/contact_marks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>

#include <Eigen/Geometry>

#include "report/text.hpp"

namespace opponens::report {
namespace {

constexpr int kRim = 24;              // points around a cone's base
constexpr double kSide = 30.0;        // px, length of a cone's sides seen square
constexpr double kDot = 3.6;          // px, radius
constexpr double kNumberHeight = 11;  // px, font size
constexpr double kArrowHead = 5.0;    // px

/// Where a number may stand around its dot, in the order of preference.
std::vector<Eigen::Vector2d> number_places() {
  std::vector<Eigen::Vector2d> places;
  for (const double radius : {11.0, 17.0, 24.0}) {
    for (int i = 0; i < 8; ++i) {
      const double angle = -std::numbers::pi / 4 + i * std::numbers::pi / 4;
      places.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
  }
  return places;
}

/// How much two upright boxes share (px^2), by their centres and half sizes.
double shared_area(const Eigen::Vector2d& a, const Eigen::Vector2d& half_a, const Eigen::Vector2d& b,
                   const Eigen::Vector2d& half_b) {
  const Eigen::Array2d overlap = (half_a + half_b).array() - (a - b).array().abs();
  return overlap.max(0.0).prod();
}

/// Centres of the numbers (px) of dots at the given places.
std::vector<Eigen::Vector2d> place_numbers(const std::vector<Eigen::Vector2d>& dots, const View& view) {
  const Eigen::Vector2d half_dot(kDot + 1.0, kDot + 1.0);
  const auto half_of = [](std::size_t i) {
    return Eigen::Vector2d(0.5 * text_width(std::to_string(i + 1), kNumberHeight), 0.45 * kNumberHeight);
  };
  std::vector<Eigen::Vector2d> numbers;
  for (std::size_t i = 0; i < dots.size(); ++i) {
    Eigen::Vector2d best = dots[i];
    double least = std::numeric_limits<double>::infinity();
    for (const auto& offset : number_places()) {
      const Eigen::Vector2d at = dots[i] + offset;
      const Eigen::Vector2d half = half_of(i);
      double covered = 0.02 * offset.norm();
      for (const auto& dot : dots) covered += shared_area(at, half, dot, half_dot);
      for (std::size_t j = 0; j < i; ++j) covered += shared_area(at, half, numbers[j], half_of(j));
      const bool outside =
          (at - half).minCoeff() < 0.0 || at.x() + half.x() > view.width || at.y() + half.y() > view.height;
      if (outside) covered += 1e3;
      if (covered >= least) continue;
      least = covered;
      best = at;
    }
    numbers.push_back(best);
  }
  return numbers;
}

void draw_normal(Svg& svg, const Eigen::Vector2d& from, const Eigen::Vector2d& to, const std::string& color) {
  const std::string stroke = concat({"class=\"axis-of-cone\" stroke=\"", color, "\""});
  const Eigen::Vector2d along = to - from;
  svg.line(from.x(), from.y(), to.x(), to.y(), stroke);
  if (along.norm() < 1.5 * kArrowHead) return;  // seen nearly from its end: a head would be all there is
  const Eigen::Vector2d back = -kArrowHead * along.normalized();
  const Eigen::Vector2d side(-0.45 * back.y(), 0.45 * back.x());
  svg.polygon({to, to + back + side, to + back - side}, concat({"fill=\"", color, "\""}));
}

void draw_mark(Svg& svg, const View& view, const ContactMark& mark, bool cone) {
  const std::string color = css(contact_paint(mark.finger));
  const ConeOutline outline = cone_outline(mark.contact, kSide / view.scale, view);
  const Eigen::Vector2d at = view.project(mark.contact.p_OC);
  if (cone && mark.contact.mu > 0.0) {
    const std::string dashes = mark.hidden ? " stroke-dasharray=\"3 2\"" : "";
    svg.polygon(outline.silhouette, concat({"class=\"cone\" color=\"", color, "\"", dashes}));
    svg.polygon(outline.base, concat({"class=\"rim\" color=\"", color, "\"", dashes}));
  }
  draw_normal(svg, at, outline.tip, color);
  svg.circle(at.x(), at.y(), kDot,
             mark.hidden ? concat({"fill=\"#fff\" stroke=\"", color, "\" stroke-width=\"1.8\""})
                         : concat({"fill=\"", color, "\" stroke=\"#fff\" stroke-width=\"1.2\""}));
}

}  // namespace

Paint contact_paint(int finger) {
  // Colour-blind safe hues (Okabe and Ito), dark enough to be read on a light ground.
  static constexpr std::array<std::array<int, 3>, 5> kFingers{
      {{0, 104, 170}, {0, 128, 92}, {184, 62, 140}, {205, 84, 0}, {122, 92, 0}}};
  if (finger < 0) return {44, 48, 56, false};
  const auto& color = kFingers[static_cast<std::size_t>(finger) % kFingers.size()];
  return {color[0], color[1], color[2], false};
}

std::string css(const Paint& paint) {
  std::string color = "#";
  for (const int channel : {paint.red, paint.green, paint.blue}) {
    color += "0123456789abcdef"[channel / 16];
    color += "0123456789abcdef"[channel % 16];
  }
  return color;
}

std::vector<Eigen::Vector2d> convex_outline(std::vector<Eigen::Vector2d> points) {
  const auto less = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  std::sort(points.begin(), points.end(), less);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  const auto turns_left = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x()) > 0.0;
  };
  std::vector<Eigen::Vector2d> hull;
  for (const bool upper : {false, true}) {
    const std::size_t begin = hull.size();
    for (const auto& p : points) {
      while (hull.size() >= begin + 2 && !turns_left(hull[hull.size() - 2], hull.back(), p)) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();  // where the other half begins
    if (!upper) std::reverse(points.begin(), points.end());
  }
  return hull;
}

ConeOutline cone_outline(const Contact& contact, double length, const View& view) {
  const double angle = std::atan(contact.mu);
  const double height = length * std::cos(angle);
  const double radius = length * std::sin(angle);
  const Eigen::Vector3d n = contact.n_O.normalized();
  const Eigen::Vector3d t_x = n.unitOrthogonal();
  const Eigen::Vector3d t_y = n.cross(t_x);
  ConeOutline outline;
  outline.tip = view.project(contact.p_OC + height * n);
  if (radius > 0.0) {
    for (int i = 0; i < kRim; ++i) {
      const double turn = 2.0 * std::numbers::pi * i / kRim;
      outline.base.push_back(
          view.project(contact.p_OC + height * n + radius * (std::cos(turn) * t_x + std::sin(turn) * t_y)));
    }
  } else {
    outline.base = {outline.tip};
  }
  std::vector<Eigen::Vector2d> all = outline.base;
  all.push_back(view.project(contact.p_OC));
  outline.silhouette = convex_outline(std::move(all));
  return outline;
}

void draw_contacts(Svg& svg, const View& view, const std::vector<ContactMark>& marks, bool cones) {
  std::vector<std::size_t> order(marks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return view.toward.dot(marks[a].contact.p_OC) < view.toward.dot(marks[b].contact.p_OC);
  });
  for (const std::size_t i : order) draw_mark(svg, view, marks[i], cones);
  std::vector<Eigen::Vector2d> dots;
  for (const auto& mark : marks) dots.push_back(view.project(mark.contact.p_OC));
  const auto numbers = place_numbers(dots, view);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    svg.text(numbers[i].x(), numbers[i].y() + 0.36 * kNumberHeight, std::to_string(i + 1),
             concat({"class=\"mark\" color=\"", css(contact_paint(marks[i].finger)), "\""}));
  }
}

}  // namespace opponens::report
