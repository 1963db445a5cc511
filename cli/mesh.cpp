// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/mesh.hpp"

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/resources.hpp"
#include "core/require.hpp"
#include "robot/mesh_check.hpp"
#include "robot/mesh_repair.hpp"

namespace opponens::cli {
namespace {

namespace fs = std::filesystem;
using robot::MeshReport;
using robot::TriangleMesh;

double metres_of(const std::string& unit) {
  static const std::map<std::string, double> kUnits{{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}};
  return kUnits.at(unit);
}

std::string text(const char* format, double value) {
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, value);
  return buffer.data();
}

Json report_json(const MeshReport& report) {
  Json holes = Json::array();
  for (const robot::MeshHole& hole : report.holes) holes.push_back({{"edges", hole.edges}, {"length_m", hole.length}});
  return {{"triangles", report.triangles},
          {"vertices", report.vertices},
          {"extent_m", array(report.extent)},
          {"repeated_vertices", report.repeated_vertices},
          {"soup", report.soup},
          {"close_vertices", report.close_vertices},
          {"degenerate_triangles", report.degenerate_triangles},
          {"duplicate_triangles", report.duplicate_triangles},
          {"holes", std::move(holes)},
          {"nonmanifold_edges", report.nonmanifold_edges},
          {"nonmanifold_vertices", report.nonmanifold_vertices},
          {"flipped_triangles", report.flipped_triangles},
          {"orientable", report.orientable},
          {"components", report.components},
          {"open_components", report.open_components},
          {"cavities", report.cavities},
          {"inside_out", report.inside_out},
          {"self_intersections", report.self_intersections ? Json(*report.self_intersections) : Json(nullptr)},
          {"likely_scales", report.likely_scales},
          {"closed", report.closed()},
          {"defects", robot::defects(report)}};
}

void say_report(const std::string& name, const MeshReport& report, const Console& console) {
  console.say(name + ": " + std::to_string(report.triangles) + " triangles, " + std::to_string(report.vertices) +
              " vertices, " + text("%.4g", report.extent.x()) + " x " + text("%.4g", report.extent.y()) + " x " +
              text("%.4g", report.extent.z()) + " m, " + std::to_string(report.components) +
              (report.components == 1 ? " part" : " parts") + ", " +
              (report.closed() ? "closed" : std::to_string(report.open_components) + " of them not closed") +
              (report.cavities > 0
                   ? ", " + std::to_string(report.cavities) + (report.cavities == 1 ? " cavity" : " cavities")
                   : ""));
  const std::vector<std::string> found = robot::defects(report);
  for (const std::string& defect : found) console.say("  " + defect);
  if (found.empty()) console.say("  no defect");
}

/// Binary STL in metres, single precision.
void write_stl(const fs::path& file, const TriangleMesh& mesh) {
  std::string bytes(80, '\0');
  const std::string title = "triangle mesh, m";
  std::copy(title.begin(), title.end(), bytes.begin());
  const auto append = [&bytes](const auto& value) {
    std::array<char, sizeof(value)> raw{};
    std::memcpy(raw.data(), &value, sizeof(value));
    bytes.append(raw.data(), raw.size());
  };
  append(static_cast<std::uint32_t>(mesh.triangles.cols()));
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    const auto corner = [&](int k) -> Eigen::Vector3d { return mesh.vertices.col(mesh.triangles(k, f)); };
    const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
    for (const Eigen::Vector3d& v : {normal, corner(0), corner(1), corner(2)}) {
      for (int i = 0; i < 3; ++i) append(static_cast<float>(v[i]));
    }
    append(std::uint16_t{0});
  }
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw InputError(file.string() + ": cannot be written");
}

TriangleMesh repaired(const TriangleMesh& written, const MeshOptions& options, std::vector<std::string>& changes) {
  auto result = robot::repair_mesh(written);
  if (!result) throw InputError(written.source + ": cannot be repaired: " + result.error().detail);
  changes = result->changes;
  if (options.simplify == 0) return std::move(result->mesh);
  const Eigen::Index before = result->mesh.triangles.cols();
  auto simple = robot::simplify_mesh(result->mesh, options.simplify);
  if (!simple) throw InputError(written.source + ": cannot be simplified: " + simple.error().detail);
  changes.push_back("simplified from " + std::to_string(before) + " to " + std::to_string(simple->triangles.cols()) +
                    " triangles");
  return std::move(*simple);
}

/// Volume of what a closed mesh encloses.
Json litres(const TriangleMesh& mesh, const MeshReport& report) {
  return report.closed() ? Json(1000.0 * robot::mass_properties(mesh).volume) : Json(nullptr);
}

/// Repairs, writes, and judges what stands in the file: single precision can close a gap or flatten a triangle.
Json repair_file(const TriangleMesh& written, const MeshReport& before, const MeshOptions& options,
                 const Console& console, bool& sound) {
  std::vector<std::string> changes;
  write_stl(options.repair, repaired(written, options, changes));
  const TriangleMesh after = robot::read_mesh(options.repair);
  const MeshReport report = robot::check_mesh(after, options.intersections);
  const TriangleMesh merged = robot::merge_equal_vertices(after);
  const robot::SurfaceChange change = robot::surface_change(written, merged);
  sound = report.closed() && robot::defects(report).empty();
  for (const std::string& done : changes) console.say("  done: " + done);
  say_report("wrote " + options.repair.string(), report, console);
  console.say("  surface moved by at most " + text("%.3g", change.bound()) + " m (" +
              text("%.3g", std::max(change.from_before, change.from_after)) + " at samples every " +
              text("%.3g", change.spacing) + " m)");
  console.say(report.closed() ? "  no point of the old surface lies more than " + text("%.3g", change.shrunk_bound()) +
                                    " m outside of the new solid (" + text("%.3g", change.shrunk) + " at the samples)"
                              : "  the result is not closed: it has no inside");
  return {{"file", options.repair.string()},
          {"changes", changes},
          {"check", report_json(report)},
          {"from_before_m", change.from_before},
          {"from_after_m", change.from_after},
          {"bound_m", change.bound()},
          {"shrunk_m", report.closed() ? Json(change.shrunk) : Json(nullptr)},
          {"shrunk_bound_m", report.closed() ? Json(change.shrunk_bound()) : Json(nullptr)},
          {"spacing_m", change.spacing},
          {"litres_before", litres(robot::merge_equal_vertices(written), before)},
          {"litres_after", litres(merged, report)}};
}

void require_wanted(const MeshOptions& options) {
  if (options.simplify > 0 && options.repair.empty()) throw InputError("--simplify needs --repair: the file to write");
  if (options.repair.empty()) return;
  if (options.files.size() != 1)
    throw InputError("--repair takes one FILE, found " + std::to_string(options.files.size()));
  if (options.repair.extension() != ".stl")
    throw InputError(options.repair.string() + ": expected a name ending in .stl");
}

}  // namespace

int mesh(const MeshOptions& options, const Console& console) {
  require_wanted(options);
  Json result = document("mesh");
  result["meshes"] = Json::array();
  bool sound = true;
  for (const std::string& name : options.files) {
    const TriangleMesh written = robot::read_mesh(find_file(name), Eigen::Vector3d::Constant(metres_of(options.unit)));
    const MeshReport report = robot::check_mesh(written, options.intersections);
    say_report(name, report, console);
    Json entry = report_json(report);
    entry["file"] = name;
    if (!options.repair.empty()) entry["repaired"] = repair_file(written, report, options, console, sound);
    result["meshes"].push_back(std::move(entry));
  }
  console.document(result.dump());
  return sound ? kDone : kNoAnswer;
}

}  // namespace opponens::cli
