// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// What the sections of the page say of the values that they are made from.
#include <regex>

#include <gtest/gtest.h>

#include "report/body_drawing.hpp"
#include "report/paper_tables.hpp"
#include "report/report.hpp"
#include "report/text.hpp"
#include "tests/report/made_reports.hpp"

namespace opponens::report {
namespace {

TEST(Report, SuccessIsTheShareOfAllRunsAndEachLengthIsNamed) {
  ReportInput input = small();
  PlanRun solved;
  solved.planner = "synergy";
  solved.settings = "step 0.4 rad";
  solved.result.status = PlanStatus::solved;
  solved.result.length = 2.125;
  solved.result.length_l1 = 5.96;
  solved.shortened_length = 1.92;
  PlanRun failed = solved;
  failed.result = {};
  failed.result.status = PlanStatus::check_limit;
  failed.shortened_length.reset();
  input.path = PathPart{};
  input.path->runs = {solved, failed, failed, failed};
  input.run = RunPart{"log", {{"synergy", 0.25}}, {{"plan", "2026-01-01T10:00:00Z", 0.5, 0.25, 2, "host"}}};
  const std::string page = render_report(input);
  const std::size_t row = page.find("here, synergy (4 runs, step 0.4 rad)");
  ASSERT_NE(row, std::string::npos);
  EXPECT_NE(page.substr(row, 200).find("25 %"), std::string::npos) << page.substr(row, 200);
  for (const char* words : {"as planned 2.12 rad in the joint metric, 5.96 rad as the sum of weighted joint movements; "
                            "shortened 1.92 rad in the joint metric",
                            "synergy: 0.250 s of CPU per run", "check limit", "<td>2026-01-01T10:00:00Z</td>"}) {
    EXPECT_NE(page.find(words), std::string::npos) << words;
  }
  expect_sound(page);
}

TEST(Report, CoverageAndTheMappingAreShown) {
  ReportInput input = small();
  input.demonstrations->mapping = "fingertip";
  input.demonstrations->tip_residuals = {{"thumb", 0.0131}};
  input.demonstrations->clamped_shares = {{"joint_15.0", 0.493}};
  input.transitions->others.push_back(*input.transitions->example);
  input.transitions->chosen_by = "Chosen by lot.";
  const std::string page = render_report(input);
  expect_sound(page);
  for (const char* words : {"13.1", "joint_15.0", "49.3", "Chosen by lot.", "Coverage of the full box", "held out (bar",
                            "Synergy 3:", "mean + 1.5 s"}) {
    EXPECT_TRUE(contains(page, words)) << words;
  }
}

/// Vertical places of the dashed lines in a plot, from the left.
std::vector<double> dashed_heights(const std::string& svg) {
  static const std::regex kDashed(R"re(<polyline points="[-0-9.]+,([-0-9.]+) [^>]*stroke-dasharray)re");
  std::vector<double> heights;
  for (std::sregex_iterator it(svg.begin(), svg.end(), kDashed), end; it != end; ++it)
    heights.push_back(std::stod((*it)[1].str()));
  return heights;
}

TEST(Report, EachGroupsCoverageStandsAtItsOwnNominalAndNamesItsCluster) {
  ReportInput input = small();
  input.synergies->groups[0].reduced_box->nominal = 0.99;
  input.synergies->groups[1].reduced_box->nominal = 0.91;
  input.synergies->groups[0].cluster = "subject";
  const std::string page = render_report(input);
  const std::size_t title = page.find("Coverage of the first k coordinates");
  ASSERT_NE(title, std::string::npos);
  const auto heights = dashed_heights(page.substr(title, page.find("</svg>", title) - title));
  ASSERT_EQ(heights.size(), 2U) << "one line per group";
  EXPECT_LT(heights[0] + 5.0, heights[1]) << "99 % lies above 91 %";
  EXPECT_TRUE(contains(page, "Coverage of the first k coordinates. 1: pre-grasp, 2: family 1."));
  for (const char* cluster : {"subject", "recording"}) {
    EXPECT_TRUE(contains(page, concat({"<td>", cluster, "</td>"}))) << cluster;
  }
}

TEST(Report, AGroupOfTooFewClustersHasNoBandAndSaysSo) {
  const std::string said = "no interval: too few clusters";
  ReportInput input = small();
  EXPECT_FALSE(contains(render_report(input), said));
  auto& item = input.synergies->groups[1];
  item.cumulative_low.resize(0);
  item.cumulative_high.resize(0);
  item.full_box->interval.reset();
  const std::string page = render_report(input);
  expect_sound(page);
  EXPECT_TRUE(contains(page, concat({"this analysis (", said, ")"})));
  EXPECT_TRUE(contains(page, concat({"[", said, "] of "})));
}

TEST(Report, WithoutASplitNoRuleIsInForce) {
  ReportInput input = small();
  EXPECT_TRUE(contains(render_report(input), "In force here: likeness."));
  input.transitions = TransitionPart{};
  const std::string page = render_report(input);
  EXPECT_FALSE(contains(page, "In force here"));
  EXPECT_TRUE(contains(page, "No split was made here"));
}

TEST(Report, APostureBeyondTheLimitsSaysByHowMuchItWasClipped) {
  ReportInput input = small();
  input.synergies->groups.resize(1);
  auto& basis = input.synergies->groups[0].group.basis;
  basis.mean = rest_configuration(*input.hand);
  basis.variance.setZero();
  EXPECT_FALSE(contains(render_report(input), "clipped by")) << "the rest configuration is within the limits";
  basis.mean[2] = input.hand->upper()[2] + 0.37;
  EXPECT_TRUE(contains(render_report(input), "mean, clipped by 0.37"));
}

TEST(Report, TableOneIsComparedOnlyByFamily) {
  EXPECT_TRUE(contains(render_report(small()), "Table 1, family 1"));
  ReportInput objects = small();
  objects.synergies->grouped_by = "object";
  const std::string page = render_report(objects);
  EXPECT_FALSE(contains(page, "Table 1, family"));
  EXPECT_TRUE(contains(page, "Table 1, pre-grasp (context)"));
  EXPECT_TRUE(contains(page, "not comparable group by group"));
  EXPECT_EQ(paper_variance("Family 3"), nullptr);
  EXPECT_EQ(paper_variance("5"), nullptr);
  EXPECT_EQ(paper_variance("family_2"), &kPaperTable1[2]);
}

TEST(Report, AFailedRunAndAFailedVerdictAreSeen) {
  ReportInput input = small();
  input.path->runs[0].result.status = PlanStatus::iteration_limit;
  input.path->runs[0].result.detail = "stopped after 100000 iterations";
  input.verification->verdicts[0] = {"abc", "grasp", false, "slips"};
  const std::string page = render_report(input);
  EXPECT_TRUE(contains(page, "iteration limit"));
  EXPECT_TRUE(contains(page, "stopped after 100000 iterations"));
  EXPECT_TRUE(contains(page, "none found by synergy"));
  EXPECT_TRUE(contains(page, " grasps and paths failed; 187 hashes agree"));
  EXPECT_TRUE(contains(page, "slips"));
}

TEST(ByName, OrdersByNameAndKeepsTheValues) {
  const auto& hand = *full().hand;
  const auto& names = hand.joint_names();
  const Eigen::VectorXd base = rest_configuration(hand);
  const Eigen::VectorXd q = by_name(hand, {names[5], names[2]}, Eigen::Vector2d(0.3, 100.0), base);
  EXPECT_DOUBLE_EQ(q[5], 0.3);
  EXPECT_DOUBLE_EQ(q[2], 100.0) << "clipping is the caller's, who may have to say so";
  EXPECT_DOUBLE_EQ(q[7], base[7]);
  EXPECT_THROW(by_name(hand, {names[0]}, Eigen::Vector2d(0, 0), base), std::invalid_argument);
  EXPECT_THROW(by_name(hand, {names[0], "unknown"}, Eigen::Vector2d(0, 0), base), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::report
