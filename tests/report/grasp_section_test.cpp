// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// The gallery of grasps: what it shows equals what is stored, and a group without a grasp says why.
#include <regex>

#include <gtest/gtest.h>

#include "report/grasp_card.hpp"
#include "report/grasp_rejections.hpp"
#include "report/sections.hpp"
#include "tests/report/made_reports.hpp"

namespace opponens::report {
namespace {

std::string section(const ReportInput& input) {
  std::string html = grasp_section(input).html;
  EXPECT_EQ(markup_problems(html), std::vector<std::string>{});
  return html;
}

/// One grasp of family 1, searched.
ReportInput one_grasp() {
  ReportInput input = small();
  input.grasps->searches.resize(1);
  input.grasps->searches[0].found = 1;
  return input;
}

std::size_t pictures(const std::string& html) {
  std::size_t count = 0;
  for (std::size_t at = html.find("class=\"sky\""); at != std::string::npos; at = html.find("class=\"sky\"", at + 1))
    ++count;
  return count;
}

TEST(GraspSection, ShowsTheStoredValuesOfEachGrasp) {
  ReportInput input = one_grasp();
  Grasp& grasp = input.grasps->items[0].grasp;
  grasp.quality.epsilon = 0.04321;
  grasp.quality.min_weight = 0.00246;
  grasp.slack = Eigen::VectorXd::Zero(16);
  grasp.slack[3] = 0.3579;
  grasp.contacts.resize(2);
  grasp.contacts[0] = {"link_3.0_tip", {0.0123, -0.0045, 0.0067}, {0.6, 0.8, 0.0}, 0.75};
  grasp.contacts[1].link = "palm_link";
  const std::string html = section(input);
  for (const char* words :
       {"<dt>\u03B5</dt><dd>0.0432</dd>", "<dt>l*</dt><dd>0.00246</dd>", "along the synergies, slack 0.358 rad",
        "<b>index</b> link_3.0_tip: 1", "<b>palm</b> palm_link: 2", "12.3, -4.5, 6.7", "0.600, 0.800, 0.000", ">0.750<",
        "3 solutions for both poses", "2 contacts:", "Grasp 1 of family 1", "Grasps: family 1"}) {
    EXPECT_TRUE(contains(html, words)) << words;
  }
  EXPECT_EQ(pictures(html), 3U);
  EXPECT_TRUE(std::regex_search(html, std::regex("from [a-z ',]+: [0-2] of 2 contacts in sight")));
  grasp.synergy_grasp = false;
  EXPECT_TRUE(contains(section(input), "free, slack 0.358 rad"));
}

TEST(GraspSection, CertificateAndQualityUnderErrorsAreShownWhereTheyAre) {
  ReportInput input = one_grasp();
  Grasp& grasp = input.grasps->items[0].grasp;
  EXPECT_TRUE(contains(section(input), "<dt>certified</dt><dd>no</dd>"));
  EXPECT_FALSE(contains(section(input), "under errors"));
  grasp.certificate = Certificate{std::vector<CertificateEdge>(9), 0.1357};
  grasp.robust = RobustQuality{{0.004, 0.03, 0.1, 250}, 0.912, 0.87, 0.944, 0.0511, 0.0123};
  input.grasps->items[0].verified = false;
  grasp.origin = GraspOrigin::imported;
  const std::string html = section(input);
  for (const char* words :
       {"<span class=\"good\">yes</span>, by 9 edge forces in exact balance; \u03B5 is at most 0.136 for certain",
        "force closure in 91.2 % of 250 disturbed grasps [87.0 %, 94.4 %], \u03B5 0.0511 on average, 0.0123 at the 5 %",
        "moved by 4 mm and 0.03 rad, \u03BC by 0.1, standard", "<dt>origin</dt><dd>imported</dd>",
        "<span class=\"bad\">failed</span>"}) {
    EXPECT_TRUE(contains(html, words)) << words;
  }
}

TEST(GraspSection, EachConventionIsSaidOnceInWords) {
  ReportInput input = full();
  auto& convention = input.grasps->items[1].grasp.quality.convention;
  convention.model = ContactModel::soft_finger;
  convention.torsion_radius = 0.0042;
  convention.mu = 0.8;
  convention.norm = WrenchNorm::linf;
  convention.unit = ForceUnit::force;
  convention.origin = {0.01, -0.02, 1e-19};
  const std::string html = section(input);
  for (const char* words :
       {"point contacts with friction, friction coefficient \u03BC = 0.5, cones of 8 edges; edge "
        "forces with a normal component of 1; L1: the fingers share a total force of 1 (the hull of "
        "all edge wrenches); torques about the object&#39;s origin, divided by \u03C1 = 0.108 m",
        "soft fingers, friction coefficient \u03BC = 0.8, torsion radius 0.00420 m; edge forces of "
        "length 1; L\u221E: each contact has a force of 1 of its own (the sum of the contacts&#39; "
        "hulls); torques about (0.01, -0.02, 0) m in the object, divided by \u03C1 = 0.108 m"}) {
    const std::size_t first = html.find(words);
    ASSERT_NE(first, std::string::npos) << words << html.substr(0, 3000);
    EXPECT_EQ(html.find(words, first + 1), std::string::npos);
  }
  QualityConvention round;
  round.cone = FrictionCone::quadratic;
  EXPECT_TRUE(contains(convention_words(round), "round cones (l*: cones of 8 edges)"));
  round.model = ContactModel::frictionless;
  EXPECT_FALSE(contains(convention_words(round), "cones"));
}

TEST(GraspSection, WithoutFrictionNoConesAreDrawn) {
  ReportInput input = one_grasp();
  EXPECT_TRUE(contains(section(input), "class=\"cone\""));
  input.grasps->items[0].grasp.quality.convention.model = ContactModel::frictionless;
  EXPECT_FALSE(contains(section(input), "class=\"cone\""));
}

TEST(GraspSection, AGroupWithoutAGraspSaysWhy) {
  ReportInput input = one_grasp();
  input.grasps->items.clear();
  auto& search = input.grasps->searches[0];
  search.found = 0;
  search.trials = 200;
  search.rejected = {
      {"collision: link_3.0-shelf", 120}, {"collision: palm_link-shelf", 42}, {"no IK", 24}, {"not force closure", 14}};
  EXPECT_TRUE(
      contains(section(input), "No grasp of bottle in 200 trials: 81 % collision, 12 % no IK, 7 % not force closure."));
  search.causes = {{"collision with shelf", "move shelf away", 162}, {"out of reach", "move the robot", 38}};
  const std::string html = section(input);
  EXPECT_TRUE(
      contains(html, "in 200 trials: 81 % collision with shelf, 19 % out of reach. To try first: move shelf away."));
  EXPECT_TRUE(contains(html, "<td>link_3.0-shelf (120)</td>")) << "the bodies named most often";
  EXPECT_TRUE(contains(html, "81 % (162)"));
  search.trials = 0;
  search.rejected.clear();
  search.causes.clear();
  EXPECT_TRUE(contains(section(input), "No grasp of bottle: the search made no trial."));
  input.grasps->searches.clear();
  EXPECT_TRUE(contains(section(input), "No grasp has been found or searched yet."));
}

TEST(GraspSection, GraspsOfOtherSearchesStandWithTheirGroup) {
  ReportInput input = one_grasp();
  GraspSearch imported;
  imported.group = "imported";
  imported.of_group = false;
  imported.found = 1;
  imported.trials = 12;
  imported.rejected = {{"not force closure", 11}};
  input.grasps->searches.push_back(imported);
  input.grasps->searches[0].found = 0;
  std::string html = section(input);
  EXPECT_TRUE(contains(html, "One grasp of bottle; the search of this group found 0 in 320 trials."));
  EXPECT_TRUE(contains(html, "One grasp of bottle in 12 trials, shown with the groups that they are nearest to."));
  EXPECT_TRUE(contains(html, "<h3>Grasps: imported</h3>"));
  input.grasps->searches.erase(input.grasps->searches.begin());
  html = section(input);
  EXPECT_TRUE(contains(html, "One grasp of bottle; no search of this group is stored."));
}

TEST(GraspSection, ShowsTheBestOfEachGroupAndListsAll) {
  ReportInput input = one_grasp();
  const GraspItem first = input.grasps->items[0];
  for (int i = 1; i < 4; ++i) {
    input.grasps->items.push_back(first);
    input.grasps->items.back().id = concat({"id", std::to_string(i)});
  }
  input.grasps->max_pictures = 2;
  const std::string html = section(input);
  EXPECT_EQ(pictures(html), 6U);
  EXPECT_TRUE(contains(html, "The best 2 are shown"));
  for (const char* id : {">id1<", ">id2<", ">id3<"}) EXPECT_TRUE(contains(html, id)) << id;
  input.hand.reset();
  const std::string undrawn = section(input);
  EXPECT_EQ(pictures(undrawn), 0U);
  EXPECT_TRUE(contains(undrawn, "no pictures"));
  EXPECT_TRUE(contains(undrawn, "7 contacts:"));
}

TEST(RejectionChart, BarsAreAsLongAsTheirShares) {
  GraspSearch search;
  search.group = "1";
  search.trials = 400;
  search.rejected = {{"a", 200}, {"b", 100}, {"c", 60}};
  const std::string html = rejection_chart(search).html;
  EXPECT_EQ(markup_problems(html), std::vector<std::string>{});
  static const std::regex kBar(R"re(<rect x="[0-9.]+" y="[0-9.]+" width="([0-9.]+)")re");
  std::vector<double> widths;
  for (std::sregex_iterator it(html.begin(), html.end(), kBar), end; it != end; ++it)
    widths.push_back(std::stod((*it)[1].str()));
  ASSERT_EQ(widths.size(), 4U);  // kept, a, b, c
  EXPECT_NEAR(widths[1] / widths[2], 2.0, 0.01);
  EXPECT_NEAR(widths[1] / widths[3], 200.0 / 60.0, 0.01);
  EXPECT_NEAR(widths[1] / widths[0], 200.0 / 40.0, 0.02);
  for (const char* words : {"10 % (40)", "50 % (200)", "25 % (100)", "15 % (60)", "kept as grasps"}) {
    EXPECT_TRUE(contains(html, words)) << words;
  }
  for (int i = 0; i < 12; ++i) search.rejected[concat({"rare ", std::to_string(10 + i)})] = 1;
  EXPECT_TRUE(contains(rejection_chart(search).html, "other reasons (8)"));
  EXPECT_TRUE(contains(rejection_words(search, 2), "50 % a, 25 % b, 18 % other reasons (13)"));
  search.trials = 0;
  EXPECT_TRUE(rejection_chart(search).html.empty());
}

TEST(ByReason, CountsBodiesTogetherAndNamesTheCommonest) {
  const auto reasons = by_reason({{"hit: a-b", 3}, {"hit: a-c", 5}, {"far", 7}, {"hit", 1}});
  ASSERT_EQ(reasons.size(), 2U);
  EXPECT_EQ(reasons[0].reason, "hit");
  EXPECT_EQ(reasons[0].trials, 9);
  EXPECT_EQ(reasons[0].bodies, "a-c");
  EXPECT_EQ(reasons[0].of_bodies, 5);
  EXPECT_EQ(reasons[1].reason, "far");
  EXPECT_TRUE(reasons[1].bodies.empty());
}

}  // namespace
}  // namespace opponens::report
