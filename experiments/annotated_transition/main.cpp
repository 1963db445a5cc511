// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Where both transition rules split the one recording of GraspDB14 whose phases a person annotated. Prints one sentence
// and writes one picture.

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "analysis/phase_transition.hpp"
#include "core/require.hpp"
#include "report/line_plot.hpp"
#include "report/report.hpp"
#include "report/svg.hpp"
#include "storage/readers/source.hpp"

namespace opponens {
namespace {

struct Phase {
  int first = 0;  ///< frame, counted from 1
  int last = 0;
  std::string name;
};

/// Lines "FIRST LAST NAME"; a # begins a remark.
std::vector<Phase> read_phases(const std::filesystem::path& file) {
  std::ifstream input(file);
  if (!input) throw InputError(file.string() + ": cannot be read");
  std::vector<Phase> phases;
  for (std::string line; std::getline(input, line);) {
    std::istringstream cells(line);
    Phase phase;
    if (line.starts_with('#') || line.find_first_not_of(" \r\t") == std::string::npos) continue;
    if (!(cells >> phase.first >> phase.last >> phase.name) || phase.first < 1 || phase.last < phase.first) {
      throw InputError(file.string() + ": '" + line + "': expected: first frame, last frame, name");
    }
    phases.push_back(phase);
  }
  return phases;
}

const Phase& phase_with(const std::vector<Phase>& phases, const std::string& part) {
  for (const Phase& phase : phases) {
    if (phase.name.find(part) != std::string::npos) return phase;
  }
  throw InputError("no annotated phase is named like '" + part + "'");
}

/// The rows of the annotated frames [first, last].
Demonstration frames(const Demonstration& recording, int first, int last) {
  if (last > recording.q_h.rows()) throw InputError(recording.id + ": has fewer rows than the annotation has frames");
  Demonstration result = recording;
  result.q_h = recording.q_h.middleRows(first - 1, last - first + 1);
  result.time = recording.time.segment(first - 1, last - first + 1);
  return result;
}

Eigen::VectorXd unit_range(const Eigen::VectorXd& values) {
  const double low = values.minCoeff();
  const double high = values.maxCoeff();
  return ((values.array() - low) / (high > low ? high - low : 1.0)).matrix();
}

struct Split {
  analysis::TransitionCurves curves;
  analysis::Transition likeness;
  analysis::Transition changepoint;
};

Split split(const Demonstration& recording) {
  auto curves = analysis::transition_curves(recording, {});
  if (!curves) throw InputError(curves.error().detail);
  const auto likeness = analysis::transition(recording, *curves, analysis::TransitionRule::likeness);
  const auto changepoint = analysis::transition(recording, *curves, analysis::TransitionRule::changepoint);
  return {std::move(*curves), likeness, changepoint};
}

std::string picture(const Demonstration& movement, const Split& found, double annotated) {
  report::LinePlot plot;
  plot.title = "Costs of both transition rules on the annotated recording of GraspDB14";
  plot.x.label = "time in the recording (s)";
  plot.y.label = "cost, scaled to 0 ... 1";
  const Eigen::VectorXd x = movement.time.segment(found.curves.first, found.curves.log_likeness.size());
  const auto add = [&](const char* label, const Eigen::VectorXd& cost, double at, int color) {
    report::Series series;
    series.label = label;
    series.x = x;
    series.y = unit_range(cost);
    series.color = report::series_color(color);
    plot.series.push_back(series);
    plot.marks.push_back({std::string(label) + ": its least", at, report::series_color(color), false, true});
  };
  add("likeness", found.curves.log_likeness, found.likeness.time_s, 0);
  add("change point", found.curves.changepoint, found.changepoint.time_s, 1);
  plot.marks.push_back({"annotated: reach ends, grasp begins", annotated, "#444444", false, false});
  plot.width = 760.0;
  plot.height = 340.0;
  return report::svg_files(report::render(plot)).front().content;
}

void run(const std::filesystem::path& source, const std::filesystem::path& recording_file,
         const std::filesystem::path& annotation, const std::filesystem::path& out) {
  storage::SourceDescription description = storage::load_source(source);
  description.resample_rate.reset();  // frames are rows of the file
  const auto recordings = storage::read_source({recording_file}, description);
  const Demonstration& recording = recordings.at(0).demonstration;
  const std::vector<Phase> phases = read_phases(annotation);
  const Phase& reach = phase_with(phases, "reach");
  const Phase& grasp = phase_with(phases, "grasp");
  const Demonstration movement = frames(recording, reach.first, grasp.last);
  const Split found = split(movement);
  const Split whole = split(recording);
  const double annotated = recording.time[grasp.first - 1];
  std::printf(
      "%s: annotated, the reach (frames %d-%d) ends and the grasp (%d-%d) begins at %.2f s; from reach to grasp the "
      "likeness "
      "rule splits at %.2f s (%+.2f s) and the change-point rule at %.2f s (%+.2f s), and of the whole recording with "
      "rest "
      "and release at %.2f s and %.2f s.\n",
      recording.id.c_str(), reach.first, reach.last, grasp.first, grasp.last, annotated, found.likeness.time_s,
      found.likeness.time_s - annotated, found.changepoint.time_s, found.changepoint.time_s - annotated,
      whole.likeness.time_s, whole.changepoint.time_s);
  std::ofstream file(out);
  file << picture(movement, found, annotated);
  if (!file.flush()) throw InputError(out.string() + ": cannot be written");
}

}  // namespace
}  // namespace opponens

int main(int count, char** arguments) {
  if (count != 5) {
    std::fprintf(stderr, "usage: annotated_transition SOURCE.yaml RECORDING.txt ANNOTATION.txt OUT.svg\n");
    return 2;
  }
  try {
    opponens::run(arguments[1], arguments[2], arguments[3], arguments[4]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "annotated_transition: %s\n", error.what());
    return 2;
  }
  return 0;
}
