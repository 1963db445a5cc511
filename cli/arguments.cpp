// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/arguments.hpp"

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/declare.hpp"

namespace opponens::cli {
namespace {

/// Registers subcommands: each owns its options, which live until the command runs.
class Builder {
 public:
  Builder(CLI::App& app, Invocation& invocation) : app_(app), invocation_(invocation) {}

  template <typename Options>
  CLI::App* command(const std::string& name, const std::string& help, int (*run)(const Options&, const Console&),
                    const std::function<void(CLI::App&, Options&)>& declare) {
    auto options = std::make_shared<Options>();
    CLI::App* sub = app_.add_subcommand(name, help);
    declare(*sub, *options);
    sub->add_flag("--json", invocation_.json, "Print one JSON document on stdout and nothing else");
    sub->add_flag("--quiet", invocation_.quiet, "No progress and no text; errors only");
    sub->callback([this, options, run] {
      invocation_.run = [options, run](const Console& console) { return run(*options, console); };
    });
    return sub;
  }

 private:
  CLI::App& app_;
  Invocation& invocation_;
};

void declare_simulate(CLI::App& app, SimulateOptions& options) {
  add_store(app, options.common);
  add_seed(app, options.common.seed);
  app.add_option("--repetitions", options.repetitions, "Recordings per grasp type")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
}

void declare_ingest(CLI::App& app, IngestOptions& options) {
  app.add_option("PATH", options.paths, "Recordings, or the folder that holds them")->required();
  add_store(app, options.common);
  app.add_option("--source", options.source, "YAML that describes the recordings (docs/ingest.md)");
  app.add_flag("--dry-run", options.dry_run, "Say what would be stored; store nothing");
}

void declare_retarget(CLI::App& app, RetargetOptions& options) {
  add_store(app, options.common);
  app.add_option("--hand", options.hand, "hand.yaml of the robot hand")->capture_default_str();
  app.add_option("--urdf", options.urdf, "URDF of the hand, in place of the one that the hand.yaml names");
  app.add_option("--mapping", options.mapping,
                 "joint: joint to joint; fingertip: all joints by fingertips; paper: flexion joint to joint, abduction "
                 "and thumb by fingertips")
      ->check(CLI::IsMember({"joint", "fingertip", "paper"}))
      ->capture_default_str();
  app.add_option("--hand-length", options.hand_length,
                 "Length of the wearer's hand, m, for recordings without a label hand_length; not with --mapping paper")
      ->check(CLI::Range(0.1, 0.3));
  add_threads(app, options.common.threads);
}

void declare_analyze(CLI::App& app, AnalyzeOptions& options) {
  const CLI::Range fraction(1e-6, 0.999999);
  add_store(app, options.common);
  add_seed(app, options.common.seed);
  add_threads(app, options.common.threads);
  app.add_option("--alpha", options.alpha, "Share of configurations left outside a box")
      ->check(fraction)
      ->capture_default_str();
  app.add_option("--beta", options.beta, "Share of variance left out by keeping k synergies")
      ->check(fraction)
      ->capture_default_str();
  app.add_option("--transition", options.transition, "Rule for the end of the pre-grasp phase; default: likeness")
      ->check(CLI::IsMember({"likeness", "changepoint"}));
  app.add_option("--resolution", options.resolution, "Of the sensors, rad: below it nothing moves")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--min-window", options.min_window,
                 "Samples on each side of a transition; 0: as many as joints that move + 1")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  app.add_option("--box-root", options.box_root, "Root of 1 - alpha that sizes the box")
      ->check(CLI::IsMember({"n", "k", "literal"}))
      ->capture_default_str();
  app.add_option("--group-by", options.group_by, "Label that groups the grasp phases; several: subject,object")
      ->capture_default_str();
  app.add_option("--order", options.order, "0: synergies of joint positions; 1: of joint velocities")
      ->check(CLI::IsMember({0, 1}))
      ->capture_default_str();
  app.add_option("--space", options.space, "Unit of the joints: rad, or their ranges")
      ->check(CLI::IsMember({"rad", "normalized"}))
      ->capture_default_str();
  app.add_option("--phase", options.phase, "both: split each recording in two phases; none: all samples per group")
      ->check(CLI::IsMember({"both", "none"}))
      ->capture_default_str();
  app.add_option("--input", options.input,
                 "Which motions: hand (retargeted) or glove; default: hand when there are any")
      ->check(CLI::IsMember({"hand", "glove"}));
}

void declare_compare(CLI::App& app, CompareOptions& options) {
  app.add_option("ID", options.ids, "Two synergy sets, or the beginnings of their ids; default: the newest")
      ->expected(0, 2);
  add_store(app, options.common);
  app.add_option("--with", options.with, "Store of the second set; default: the same store");
}

void declare_mesh(CLI::App& app, MeshOptions& options) {
  app.add_option("FILE", options.files, "STL, OBJ or DAE")->required();
  app.add_option("--unit", options.unit, "Of the numbers in the files")
      ->check(CLI::IsMember({"m", "cm", "mm", "in"}))
      ->capture_default_str();
  app.add_flag("--intersections", options.intersections, "Count pairs of triangles that cross as well");
  app.add_option("--repair", options.repair, "STL to write, in metres: the one FILE repaired");
  app.add_option("--simplify", options.simplify, "Triangles that the repaired mesh shall have")
      ->check(CLI::Range(4, 100000000));
}

void declare_show(CLI::App& app, ShowOptions& options) {
  app.add_option("ID", options.id, "Object id, or the beginning of one");
  add_store(app, options.common);
}

void declare_export(CLI::App& app, ExportOptions& options) {
  app.add_option("ID", options.ids, "Objects, by id or the beginning of one; default: all");
  add_store(app, options.common);
  app.add_option("--kind", options.kind, "Only objects of this kind (opponens show lists them)");
  app.add_option("--single-file", options.single_file,
                 "HDF5 file to write: the objects and all they were made from; opponens ingest takes it back");
  app.add_option("--format", options.format, "Form of the objects alone")
      ->check(CLI::IsMember({"csv", "json", "robomimic", "trajectory_csv", "trajectory_json", "trajectory_yaml"}));
  app.add_option("--out", options.out, "File to write with --format; of csv: the folder");
  app.add_option("--period", options.period, "Seconds between a trajectory's points; 0 = as stored")
      ->check(CLI::Range(0.0, 1e3))
      ->capture_default_str();
}

void declare_robot(CLI::App& app, RobotOptions& options) {
  app.add_option("FILE", options.file, "robot.yaml, hand.yaml, or a URDF without either")->required();
  add_seed(app, options.seed);
  app.add_option("--samples", options.samples, "Random configurations checked for self-collision; 0 = none")
      ->check(CLI::Range(0, 10000000))
      ->capture_default_str();
  app.add_option("--packages", options.packages, "Folders searched for package://NAME; of a URDF without YAML");
  CLI::Option* const skeleton =
      app.add_flag("--skeleton", options.skeleton, "Print a hand.yaml to start from, made from a URDF; nothing else");
  CLI::Option* const contacts = app.add_flag("--propose-contacts", options.propose_contacts,
                                             "Print tips and contact points found on the hand's surface, as YAML");
  CLI::Option* const allowed = app.add_flag("--allowed-collisions", options.allowed_collisions,
                                            "Print the link pairs that need no checking, as YAML");
  skeleton->excludes(contacts)->excludes(allowed);
  contacts->excludes(allowed);
  app.add_option("--picture", options.picture, "SVG file to write: the robot from several sides");
}

/// The commands that look after a store.
void add_store_commands(Builder& add) {
  add.command<ExportOptions>("export", "Write objects to one file, or in the form of other programs", export_objects,
                             declare_export);
  add.command<MergeOptions>("merge", "Copy what other stores hold into one", merge,
                            [](CLI::App& app, MergeOptions& options) {
                              app.add_option("STORE", options.stores, "Stores to copy from")->required();
                              add_store(app, options.common);
                            });
  add.command<RepairOptions>("repair", "List what is damaged and set it aside", repair,
                             [](CLI::App& app, RepairOptions& options) {
                               add_store(app, options.common);
                               app.add_flag("--dry-run", options.dry_run, "Only list");
                             });
  add.command<StaleOptions>(
      "stale", "List what upstream changes made old", stale, [](CLI::App& app, StaleOptions& options) {
        add_store(app, options.common);
        app.add_option("--files", options.files, "Folders that hold the outside files recorded by name alone");
      });
}

void declare_verify(CLI::App& app, VerifyOptions& options) {
  add_store(app, options.common);
  app.add_option("--clearance", options.clearance, "That paths have to keep, m")
      ->check(CLI::Range(1e-5, 1.0))
      ->capture_default_str();
  app.add_option("--max-penetration", options.max_penetration, "Of the grasp's contacts while the hand closes, m")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
}

void add_commands(Builder& add) {
  add.command<DemoOptions>(
      "demo", "The whole flow on built-in simulated demonstrations", demo, [](CLI::App& app, DemoOptions& options) {
        app.add_option("--out", options.out, "Folder for the store and the report")->capture_default_str();
        add_seed(app, options.seed);
        add_threads(app, options.threads);
      });
  add.command<SimulateOptions>("simulate", "Make simulated human-hand recordings", simulate, declare_simulate);
  add.command<IngestOptions>("ingest", "Read recordings into a store", ingest, declare_ingest);
  add.command<RetargetOptions>("retarget", "Map glove recordings to a robot hand", retarget, declare_retarget);
  add.command<AnalyzeOptions>("analyze", "Phases, synergies and boxes", analyze, declare_analyze);
  add.command<CompareOptions>("compare", "Distance and principal angles between two synergy sets", compare,
                              declare_compare);
  add.command<GraspOptions>("grasp", "Search force-closure grasps along the synergies", grasp, declare_grasp);
  add.command<PlanOptions>("plan", "Plan a hand-arm path to one of the grasps", plan, declare_plan);
  add.command<CheckOptions>("check", "Collision verdict, clearance and colliding pairs of given configurations", check,
                            declare_check);
  add.command<QualityOptions>("quality", "Epsilon, volume, l* and certificate of given contact sets", quality,
                              declare_quality);
  add.command<MeshOptions>("mesh", "Say what is wrong with triangle meshes; repair one", mesh, declare_mesh);
  add.command<VerifyOptions>("verify", "Check grasps and paths again by code of its own, all else by hash", verify,
                             declare_verify);
  add.command<ReportOptions>(
      "report", "Write one HTML file about what is stored", report, [](CLI::App& app, ReportOptions& options) {
        add_store(app, options.common);
        app.add_option("--out", options.out, "File to write")->capture_default_str();
        app.add_option("--svg", options.svg, "Folder for every picture of the report as an SVG file of its own");
      });
  add.command<ShowOptions>("show", "List a store, or print one object of it", show,
                           [](CLI::App& app, ShowOptions& options) {
                             declare_show(app, options);
                             app.add_option("--kind", options.kind, "List objects of this kind only");
                           });
  add.command<ShowOptions>("why", "Print what an object was made from, back to the recordings", why,
                           [](CLI::App& app, ShowOptions& options) {
                             declare_show(app, options);
                             app.get_option("ID")->required();
                           });
  add.command<RobotOptions>("robot", "Say what is understood of a robot's or a hand's files", robot, declare_robot);
  add_store_commands(add);
}

/// The first argument when it stands for a command and is none. CLI11 would only say that a subcommand is required, or
/// print the general help when --help follows.
std::string unknown_command(const CLI::App& app, int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  if (first.empty() || first.front() == '-') return "";
  const auto named = app.get_subcommands([&](const CLI::App* sub) { return sub->get_name() == first; });
  return named.empty() ? first : "";
}

}  // namespace

Invocation parse_arguments(int argc, char** argv) {
  Invocation invocation;
  CLI::App app("opponens plans human-like grasping motions from recorded hand synergies.", "opponens");
  app.set_version_flag("--version", OPPONENS_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done; 1 no answer found; 2 wrong use or invalid input; 3 store damaged or newer;\n"
      "130 interrupted (what was finished is kept). docs/cli.md is the full reference.");
  Builder builder(app, invocation);
  add_commands(builder);
  if (const std::string name = unknown_command(app, argc, argv); !name.empty()) {
    invocation.exit_code = kInvalid;
    invocation.text = name + ": no such command; opponens --help lists them\n";
    return invocation;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream out;
    std::ostringstream err;
    const int code = app.exit(error, out, err);
    invocation.exit_code = code == 0 ? 0 : kInvalid;
    invocation.text = code == 0 ? out.str() : err.str();
  }
  return invocation;
}

}  // namespace opponens::cli
