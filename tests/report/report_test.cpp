// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/report.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "report/body_drawing.hpp"
#include "report/paper_tables.hpp"
#include "report/text.hpp"
#include "tests/report/markup_check.hpp"
#include "tests/report/synthetic_report.hpp"

namespace opponens::report {
namespace {

using Problems = std::vector<std::string>;

/// Made once: loading the models is most of the time.
const ReportInput& full() {
  static const ReportInput input = synthetic_report();
  return input;
}

/// The same with two groups, one grasp and two snapshots: quick to render.
const ReportInput& small() {
  static const ReportInput input = [] {
    ReportInput reduced = full();
    reduced.synergies->groups.resize(2);
    reduced.grasps->items.resize(1);
    reduced.path->pictures = 2;
    return reduced;
  }();
  return input;
}

bool contains(const std::string& page, const std::string& part) { return page.find(part) != std::string::npos; }

/// The page without tags and style sheet: what a person reads.
std::string words_of(const std::string& page) {
  std::string words;
  bool inside = false;
  for (const char c : page.substr(page.find("</style>"))) {
    inside = (inside || c == '<') && c != '>';
    words += inside || c == '>' ? ' ' : c;
  }
  return words;
}

std::string without_run_log(const std::string& page) {
  const auto begin = page.find(kRunLogBegin);
  const auto end = page.find(kRunLogEnd);
  return page.substr(0, begin) + page.substr(end);
}

void expect_sound(const std::string& page) {
  EXPECT_EQ(markup_problems(page), Problems{});
  static const std::regex kBadNumber(R"(\b(nan|inf|-nan|-inf)\b)");
  EXPECT_FALSE(std::regex_search(words_of(page), kBadNumber));
  for (const char* name : {"d", "points", "x", "y", "x1", "y1", "x2", "y2", "cx", "cy", "width", "height", "viewBox"}) {
    for (const auto& value : attribute_values(page, name)) {
      ASSERT_EQ(value.find("nan"), std::string::npos) << name;
      ASSERT_EQ(value.find("inf"), std::string::npos) << name;
      ASSERT_EQ(value.find("n/a"), std::string::npos) << name;
    }
  }
}

TEST(Report, IsOneSoundSelfContainedPage) {
  const std::string page = render_report(full());
  expect_sound(page);
  EXPECT_LT(page.size(), 3U << 20U);
  EXPECT_FALSE(contains(page, "<script"));
  EXPECT_FALSE(contains(page, "url("));
  EXPECT_FALSE(contains(page, "@import"));
  EXPECT_TRUE(attribute_values(page, "src").empty());
  const auto links = attribute_values(page, "href");
  const auto anchors = attribute_values(page, "id");
  EXPECT_GE(links.size(), 10U);
  for (const auto& link : links) {
    ASSERT_EQ(link.front(), '#');
    EXPECT_NE(std::find(anchors.begin(), anchors.end(), link.substr(1)), anchors.end()) << link;
  }
  const std::string namespace_name = "http://www.w3.org/2000/svg";
  for (std::size_t at = page.find("http"); at != std::string::npos; at = page.find("http", at + 1)) {
    ASSERT_EQ(page.substr(at, namespace_name.size()), namespace_name)
        << "only the SVG namespace, which is never fetched";
  }
}

TEST(Report, EqualInputGivesEqualBytes) { EXPECT_EQ(render_report(full()), render_report(synthetic_report())); }

TEST(Report, RunsDifferOnlyBetweenTheRunLogComments) {
  ReportInput later = small();
  later.run = RunPart{"2027-02-03 on another host", {{"synergy", 99.5}}, {}};
  const std::string a = render_report(small());
  const std::string b = render_report(later);
  EXPECT_NE(a, b);
  EXPECT_EQ(without_run_log(a), without_run_log(b));
  EXPECT_EQ(a.find(kRunLogBegin), a.rfind(kRunLogBegin));
  later.run.reset();
  expect_sound(render_report(later));
}

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

TEST(Report, BannerStandsExactlyWhenSomethingIsSimulated) {
  EXPECT_TRUE(contains(render_report(small()), "SIMULATED demonstrations."));
  EXPECT_TRUE(contains(render_report(small()), "proves nothing about humans"));
  ReportInput recorded = small();
  recorded.demonstrations->simulated = 0;
  recorded.demonstrations->example->origin = Origin::recorded;
  EXPECT_FALSE(contains(render_report(recorded), "SIMULATED demonstrations."));
  recorded.demonstrations->example->origin = Origin::simulated;
  EXPECT_TRUE(contains(render_report(recorded), "SIMULATED demonstrations."));
}

TEST(Report, EveryMissingPartBecomesASentence) {
  const std::vector<std::pair<std::function<void(ReportInput&)>, std::string>> cases{
      {[](ReportInput& i) { i.demonstrations.reset(); }, "No demonstrations are in the store"},
      {[](ReportInput& i) { i.transitions.reset(); }, "no transitions"},
      {[](ReportInput& i) { i.transitions->example.reset(); }, "All 180 recordings"},
      {[](ReportInput& i) { i.synergies.reset(); }, "no synergies"},
      {[](ReportInput& i) { i.hand.reset(); }, "its shape cannot be drawn"},
      {[](ReportInput& i) { i.robot.reset(); }, "no snapshots"},
      {[](ReportInput& i) { i.scene.reset(); }, "no pictures"},
      {[](ReportInput& i) { i.grasps.reset(); }, "No grasp has been found"},
      {[](ReportInput& i) { i.grasps->object = "absent"; }, "no pictures"},
      {[](ReportInput& i) { i.path.reset(); }, "No path has been planned"},
      {[](ReportInput& i) {
         i.path->path.waypoints.resize(0, 22);
         i.path->times.resize(0);
         i.path->pregrasp = -1;
       },
       "The planner found no path"},
      {[](ReportInput& i) { i.verification.reset(); }, "Nothing has been verified"},
      {[](ReportInput& i) { i.provenance.clear(); }, "No provenance"},
  };
  for (const auto& [remove, sentence] : cases) {
    ReportInput input = small();
    remove(input);
    const std::string page = render_report(input);
    EXPECT_EQ(markup_problems(page), Problems{}) << sentence;
    EXPECT_TRUE(contains(page, sentence)) << sentence;
  }
  const std::string empty = render_report(ReportInput{});
  expect_sound(empty);
  EXPECT_TRUE(contains(empty, "10. Run"));
}

TEST(Report, EveryPictureIsAFileOfItsOwn) {
  const std::string page = render_report(small());
  const auto files = svg_files(page);
  const std::string kPicture = "<svg xmlns=";  // a clipped region inside a picture is an <svg> too
  std::size_t drawn = 0;
  for (std::size_t at = page.find(kPicture); at != std::string::npos; at = page.find(kPicture, at + 1)) ++drawn;
  EXPECT_GT(drawn, 10u);
  ASSERT_EQ(files.size(), drawn);
  std::set<std::string> names;
  for (const SvgFile& file : files) {
    EXPECT_TRUE(names.insert(file.name).second) << file.name;
    EXPECT_TRUE(file.content.starts_with("<?xml")) << file.name;
    EXPECT_TRUE(contains(file.content, "xmlns=\"http://www.w3.org/2000/svg\"")) << file.name;
    EXPECT_TRUE(contains(file.content, "--fg:")) << file.name << " needs the colours";
    EXPECT_FALSE(contains(file.content, "@media")) << file.name;
  }
  EXPECT_TRUE(names.contains("synergies_1.svg"));
  EXPECT_TRUE(names.contains("shapes_1.svg"));
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

TEST(Report, HostileTextStaysText) {
  const std::string evil = "</style><script>alert(1)</script>\"'&\xFF";
  ReportInput input = small();
  input.title = evil;
  input.program_version = evil;
  input.demonstrations->grouped_by = evil;
  input.demonstrations->source = evil;
  input.demonstrations->mapping = evil;
  input.demonstrations->groups[0].name = evil;
  input.demonstrations->example->id = evil;
  input.demonstrations->example->labels[evil] = evil;
  input.demonstrations->example->joint_names[0] = evil;
  input.transitions->method = evil;
  input.transitions->example->demonstration = evil;
  input.synergies->grouped_by = evil;
  input.synergies->groups[1].cluster = evil;
  input.synergies->box_root = evil;
  input.synergies->groups[1].group.name = evil;
  input.synergies->groups[1].group.dropped_channels = {evil};
  input.grasps->items[0].id = evil;
  input.grasps->items[0].grasp.group = evil;
  input.grasps->items[0].grasp.contacts[0].link = evil;
  input.grasps->rejected[evil] = 3;
  input.scene->bodies[0].name = evil;
  input.grasps->object = evil;
  input.path->id = evil;
  input.path->goal_grasp = evil;
  input.path->runs[0].planner = evil;
  input.path->runs[0].result.detail = evil;
  input.path->runs[0].human_likeness[0].reference = evil;
  input.verification->checks = {evil};
  input.verification->worst_pair = evil;
  input.verification->verdicts[0] = {evil, evil, false, evil};
  using Member = std::string ProvenanceItem::*;
  for (const Member field : {&ProvenanceItem::id, &ProvenanceItem::kind, &ProvenanceItem::name,
                             &ProvenanceItem::command, &ProvenanceItem::parameters, &ProvenanceItem::program_version}) {
    input.provenance.push_back(input.provenance[0]);
    input.provenance.back().*field = evil;
  }
  input.provenance[0].inputs = {evil};
  input.provenance[0].files[evil] = evil;
  input.run->log = evil;
  const std::string page = render_report(input);
  expect_sound(page);
  EXPECT_FALSE(contains(page, "<script"));
  EXPECT_FALSE(contains(page, "\xFF"));
  EXPECT_TRUE(contains(page, "&lt;script&gt;alert(1)"));
  input.hand.reset();  // names that a robot lacks cannot be drawn
  input.robot.reset();
  input.synergies->joint_names[0] = evil;
  input.path->path.joint_names[0] = evil;
  const std::string undrawn = render_report(input);
  expect_sound(undrawn);
  EXPECT_FALSE(contains(undrawn, "<script"));
}

TEST(Report, SizesThatDisagreeAreRefused) {
  const std::vector<std::function<void(ReportInput&)>> breaks{
      [](ReportInput& i) { i.demonstrations->example->time.conservativeResize(3); },
      [](ReportInput& i) { i.transitions->example->log_likeness.conservativeResize(3); },
      [](ReportInput& i) { i.synergies->joint_names.pop_back(); },
      [](ReportInput& i) { i.synergies->groups[0].cumulative_low.conservativeResize(3); },
      [](ReportInput& i) { i.grasps->items[0].grasp.q_grasp.conservativeResize(3); },
      [](ReportInput& i) { i.path->times.conservativeResize(3); },
      [](ReportInput& i) { i.path->path.joint_names.pop_back(); },
      [](ReportInput& i) { i.path->path.joint_names[0] = "unknown"; },
      [](ReportInput& i) { i.synergies->joint_names[0] = "unknown"; },
      [](ReportInput& i) { i.path->pregrasp = 4000; },
  };
  for (std::size_t c = 0; c < breaks.size(); ++c) {
    ReportInput input = small();
    breaks[c](input);
    EXPECT_THROW(render_report(input), std::invalid_argument) << "case " << c;
  }
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

/// The figures embedded in the program against the published table as transcribed independently.
TEST(PaperTables, TableOneEqualsTheReference) {
  const std::filesystem::path file = std::filesystem::path(OPPONENS_SHARED_DATA) / "reference" / "paper_table1.csv";
  std::ifstream in(file);
  if (!in) GTEST_SKIP() << file << " is absent";
  std::string line;
  std::getline(in, line);
  for (int k = 1; k <= 9; ++k) {
    ASSERT_TRUE(std::getline(in, line));
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    int written = 0;
    ASSERT_TRUE(fields >> written);
    ASSERT_EQ(written, k);
    for (const auto& column : kPaperTable1) {
      double value = 0.0;
      ASSERT_TRUE(fields >> value);
      EXPECT_DOUBLE_EQ(value, column.percent[static_cast<std::size_t>(k - 1)]) << column.name;
    }
  }
  for (const auto& column : kPaperTable1) {
    const auto reached = std::find_if(column.percent.begin(), column.percent.end(), [](double p) { return p >= 95.0; });
    EXPECT_EQ(column.k, reached - column.percent.begin() + 1) << column.name;
  }
}

}  // namespace
}  // namespace opponens::report
