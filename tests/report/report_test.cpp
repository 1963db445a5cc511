// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/report.hpp"

#include <algorithm>
#include <functional>
#include <set>

#include <gtest/gtest.h>

#include "tests/report/made_reports.hpp"

namespace opponens::report {
namespace {

std::string without_run_log(const std::string& page) {
  const auto begin = page.find(kRunLogBegin);
  const auto end = page.find(kRunLogEnd);
  return page.substr(0, begin) + page.substr(end);
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
    EXPECT_EQ(markup_problems(page), std::vector<std::string>{}) << sentence;
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
  input.grasps->grouped_by = evil;
  input.grasps->searches[0].group = evil;
  input.grasps->searches[0].rejected[evil] = 3;
  input.scene->bodies[0].name = evil;
  input.grasps->object = evil;
  input.path->id = evil;
  input.path->reached = {{evil, evil}};
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

}  // namespace
}  // namespace opponens::report
