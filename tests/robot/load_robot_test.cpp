// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/load_robot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

#include <gtest/gtest.h>

#include "core/require.hpp"
#include "core/rng.hpp"
#include "robot/collision.hpp"
#include "robot_files.hpp"
#include "robot_test.hpp"

namespace opponens::robot {
namespace {

namespace fs = std::filesystem;

using LoadRobot = RobotFiles;

TEST_F(LoadRobot, ErrorsNameFileAndElement) {
  EXPECT_EQ(urdf_error(robot(links("ab") + joint("j", "a", "b"))), "no error");
  expect_contains(urdf_error(robot(links("ab") + joint("j", "a", "b", "wobbly"))), {"hand.urdf", "j", "wobbly"});
  expect_contains(urdf_error(robot(links("ab") + joint("j", "a", "b", "floating"))), {"hand.urdf", "'j'", "floating"});
  expect_contains(urdf_error(robot(links("ab") + joint("j", "a", "b", "revolute", ""))), {"hand.urdf", "j", "limit"});
  expect_contains(urdf_error(robot(links("ab") + joint("j", "a", "b", "revolute",
                                                       "<limit lower='nan' upper='1' effort='1' velocity='1'/>"))),
                  {"hand.urdf"});
  expect_contains(urdf_error(robot(links("ab") + joint("j", "a", "b", "revolute",
                                                       "<limit lower='2' upper='1' effort='1' velocity='1'/>"))),
                  {"hand.urdf", "'j'", "lower limit is above"});
  expect_contains(
      urdf_error(robot(links("ab") + joint("j", "a", "b", "revolute", kLimit + "<origin xyz='nan 0 0' rpy='0 0 0'/>"))),
      {"hand.urdf"});
  expect_contains(urdf_error(robot(links("ab") + joint("j", "a", "b", "revolute", kLimit + "<axis xyz='0 0 0'/>"))),
                  {"hand.urdf", "'j'", "axis"});
  expect_contains(urdf_error(robot(links("ab") + joint("j", "a", "b", "revolute", kLimit + "<mimic joint='k'/>"))),
                  {"hand.urdf", "'j'", "'k'"});
  expect_contains(urdf_error(robot(links("abc") + joint("j", "a", "b"))), {"hand.urdf", "root"});
  expect_contains(urdf_error(robot(links("abc") + joint("j", "b", "c") + joint("k", "c", "b"))), {"hand.urdf", "loop"});
  expect_contains(urdf_error(robot(links("ab") + joint("j", "a", "b") + joint("k", "b", "a"))), {"hand.urdf", "loop"});
  expect_contains(urdf_error(robot(links("abc") + joint("i", "a", "b") + joint("j", "a", "c") + joint("k", "b", "c"))),
                  {"hand.urdf", "'c'", "'j'", "'k'"});
  expect_contains(urdf_error(robot(links("ab") + "<joint name='j' type='fixed'><parent link='a'/></joint>")),
                  {"hand.urdf", "'j'", "child"});
  expect_contains(urdf_error("<robot name='r'>"), {"hand.urdf"});
  expect_contains(urdf_error("not xml"), {"hand.urdf"});
  expect_contains(urdf_error(""), {"hand.urdf"});
}

TEST_F(LoadRobot, GeometryErrorsNameTheLink) {
  const auto with_shape = [&](const std::string& shape) {
    return urdf_error(robot("<link name='a'><collision><geometry>" + shape + "</geometry></collision></link>" +
                            links("b") + joint("j", "a", "b")));
  };
  EXPECT_EQ(with_shape("<box size='1 1 1'/>"), "no error");
  expect_contains(with_shape("<mesh filename='absent.stl'/>"), {"hand.urdf", "'a'", "absent.stl", "does not exist"});
  expect_contains(with_shape("<mesh filename='package://nowhere/x.stl'/>"), {"hand.urdf", "'a'", "'nowhere'"});
  expect_contains(with_shape("<box size='1 -1 1'/>"), {"hand.urdf", "'a'", "box"});
  expect_contains(with_shape("<sphere radius='0'/>"), {"hand.urdf", "'a'", "sphere"});
  expect_contains(with_shape("<cylinder radius='1' length='-1'/>"), {"hand.urdf", "'a'", "cylinder"});
}

TEST_F(LoadRobot, YamlErrorsNameFileLineAndField) {
  write("hand.urdf", robot(links("abc") + joint("j", "a", "b") + joint("f", "b", "c", "fixed", "")));
  const std::string start = "urdf: hand.urdf\npalm_link: a\n";
  const auto yaml_error = [&](const std::string& text) { return error_of(write("hand.yaml", text)); };
  EXPECT_EQ(yaml_error(start + "joints: [j]\n"), "no error");
  expect_contains(yaml_error(start + "joints: [j, absent]\n"), {"hand.yaml:3", "joints[1]", "'absent'"});
  expect_contains(yaml_error(start + "joints: [j, f]\n"), {"hand.yaml:3", "'f'", "fixed"});
  expect_contains(yaml_error(start + "joints: [j, j]\n"), {"hand.yaml:3", "'j'", "repeats"});
  expect_contains(yaml_error(start + "joints: []\n"), {"hand.yaml:3", "joints"});
  expect_contains(yaml_error(start), {"hand.yaml", "'joints'"});
  expect_contains(yaml_error(start + "joints: [j]\njiont: 3\n"), {"hand.yaml:4", "jiont", "unknown"});
  expect_contains(yaml_error(start + "joints: [j]\njoints: [j]\n"), {"hand.yaml:4", "joints", "occurs twice"});
  EXPECT_EQ(yaml_error(start + "joints: [j]\nwithout_geometry: [c, a]\n"), "no error");
  expect_contains(yaml_error(start + "joints: [j]\nwithout_geometry: [c, z]\n"),
                  {"hand.yaml:4", "without_geometry[1]", "no link 'z'"});
  expect_contains(yaml_error(start + "joints: [j]\ncollision: both\n"), {"hand.yaml:4", "'both'"});
  expect_contains(yaml_error("urdf: hand.urdf\npalm_link: z\njoints: [j]\n"), {"hand.yaml:2", "palm_link", "'z'"});
  expect_contains(yaml_error("urdf: gone.urdf\npalm_link: a\njoints: [j]\n"), {"gone.urdf", "cannot be opened"});
  expect_contains(yaml_error("urdf: ${NO_SUCH_VARIABLE_7}/x\npalm_link: a\njoints: [j]\n"), {"NO_SUCH_VARIABLE_7"});
  expect_contains(yaml_error("urdf: [\n"), {"hand.yaml", "YAML"});
  const std::string tip = "joints: [j]\ntips:\n  - {finger: i, link: b, point: [0, 0, 0], normal: [1, 0, 0]}\n";
  EXPECT_EQ(yaml_error(start + tip), "no error");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = start + tip;
    return yaml_error(text.replace(text.find(from), from.size(), to));
  };
  expect_contains(with("link: b", "link: z"), {"hand.yaml:5", "tips[0].link", "'z'"});
  expect_contains(with("[0, 0, 0]", "[0, 0]"), {"hand.yaml:5", "point", "3 numbers"});
  expect_contains(with("[0, 0, 0]", "[0, .nan, 0]"), {"hand.yaml:5", "point[1]", "finite"});
  expect_contains(with("[0, 0, 0]", "[0, x, 0]"), {"hand.yaml:5", "point[1]", "'x'"});
  expect_contains(with("[1, 0, 0]", "[0, 0, 0]"), {"hand.yaml:5", "normal", "zero"});
  expect_contains(error_of(folder_ / "gone.yaml"), {"gone.yaml", "cannot be opened"});
  expect_contains(error_of(folder_), {"directory"});
}

TEST_F(LoadRobot, RobotYamlErrors) {
  write("hand.urdf", robot(links("ab") + joint("j", "a", "b")));
  write("arm.urdf", robot(links("pq") + joint("s", "p", "q")));
  write("hand.yaml", "urdf: hand.urdf\npalm_link: a\njoints: [j]\n");
  const std::string arm = "arm: {urdf: arm.urdf, joints: [s]}\nhand: hand.yaml\n";
  const std::string mount = "mount: {parent: q, xyz: [0, 0, 0.1]}\n";
  const auto yaml_error = [&](const std::string& text) {
    return error_of(write("r.yaml", text), [](const std::filesystem::path& file) { return load_robot(file); });
  };
  EXPECT_EQ(yaml_error(arm + mount), "no error");
  expect_contains(yaml_error(arm), {"r.yaml", "'mount'"});
  expect_contains(yaml_error(arm + "mount: {parent: z}\n"), {"r.yaml:3", "mount.parent", "'z'"});
  expect_contains(yaml_error(arm + mount + "weights: {z: 1}\n"), {"r.yaml:4", "weights.z"});
  expect_contains(yaml_error(arm + mount + "weights: {j: 0}\n"), {"r.yaml:4", "weights.j", "positive"});
  expect_contains(yaml_error(arm + mount + "allowed_collisions: [[a, z]]\n"), {"r.yaml:4", "'z'"});
  expect_contains(yaml_error(arm + mount + "weights: {j: 1, j: 2}\n"), {"r.yaml:4", "weights.j", "occurs twice"});
  EXPECT_EQ(yaml_error(arm + mount + "without_geometry: [q, b]\n"), "no error");
  expect_contains(yaml_error(arm + mount + "without_geometry: [z]\n"), {"r.yaml:4", "without_geometry[0]", "'z'"});
  write("hand.yaml", "urdf: hand.urdf\npalm_link: a\njoints: [j]\nwithout_geometry: [z]\n");
  expect_contains(yaml_error(arm + mount), {"hand.yaml:4", "without_geometry[0]", "'z'"});
  write("hand.yaml", "urdf: hand.urdf\npalm_link: a\njoints: [j]\n");
  expect_contains(yaml_error("arm: {urdf: arm.urdf, joints: [t]}\nhand: hand.yaml\n" + mount), {"r.yaml:1", "'t'"});
  write("arm.urdf", robot(links("pb") + joint("s", "p", "b")));
  expect_contains(yaml_error(arm + "mount: {parent: b}\n"), {"r.yaml:3", "'b'", "both"});
}

TEST_F(LoadRobot, TreeOrderMimicNotesAndSupport) {
  // Joints of the file out of order, siblings c before b; a tag that nobody reads.
  write("hand.urdf", robot("<gazebo/>" + links("dcba") + joint("k", "b", "d", "continuous", "") +
                           joint("m", "a", "c", "revolute", kLimit + "<mimic joint='j' multiplier='2' offset='.1'/>") +
                           joint("j", "a", "b")));
  write("arm.urdf", robot(links("pq") + joint("s", "p", "q", "prismatic")));
  write("hand.yaml", "urdf: hand.urdf\npalm_link: a\njoints: [k, j]\n");
  const RobotDescription loaded = load_robot(
      write("r.yaml",
            "arm: {urdf: arm.urdf, joints: [s]}\nhand: hand.yaml\nmount: {parent: q, xyz: [0, 0, 0.1], "
            "support: {name: u, radius: 0.1, length: 0.2}}\nweights: {j: 3}\nallowed_collisions: [[d, c]]\n"));
  std::string order;
  for (const Link& link : loaded.links) order += link.name;
  EXPECT_EQ(order, "pquacbd");
  const RobotModel model(loaded);
  EXPECT_EQ(model.joint_names(), (std::vector<std::string>{"s", "k", "j"}));
  EXPECT_EQ(loaded.weights, Eigen::Vector3d(1, 1, 3));
  EXPECT_EQ(loaded.arm_tip_link, "q");
  EXPECT_EQ(model.palm(), 3);
  EXPECT_NEAR(model.upper()[1], 6.283185307, 1e-9);
  const auto m = std::find_if(loaded.joints.begin(), loaded.joints.end(), [](const Joint& j) { return j.name == "m"; });
  ASSERT_TRUE(m->mimic.has_value());
  EXPECT_EQ(m->mimic->multiplier, 2.0);
  EXPECT_TRUE(std::any_of(loaded.notes.begin(), loaded.notes.end(),
                          [](const std::string& note) { return note.find("<gazebo> ignored (1)") != note.npos; }));
  // q, support and palm are one rigid body; c-d is allowed by the file, b-c is not.
  EXPECT_EQ(loaded.allowed_collisions,
            (std::set<std::pair<int, int>>{{0, 1}, {1, 2}, {1, 3}, {2, 3}, {3, 4}, {3, 5}, {4, 6}, {5, 6}}));
}

TEST_F(LoadRobot, PrefixTellsTheArmsLinksFromTheHands) {
  const std::string box = "<collision><geometry><box size='1 1 1'/></geometry></collision>";
  write("hand.urdf", robot("<link name='a'>" + box + "</link>" + links("b") + joint("j", "a", "b")));
  write("arm.urdf", robot("<link name='a'>" + box + "</link><link name='b'>" + box + "</link>" + joint("s", "a", "b")));
  write("hand.yaml", "urdf: hand.urdf\npalm_link: a\njoints: [j]\n");
  const std::string end = "hand: hand.yaml\nmount: {parent: arm_b}\n";
  const std::string arm = "arm: {urdf: arm.urdf, joints: [s], link_prefix: arm_}\n";
  const RobotDescription loaded = load_robot(write("r.yaml", arm + end + "without_geometry: [arm_b, a]\n"));
  std::vector<std::string> names;
  std::vector<std::size_t> shapes;
  for (const Link& link : loaded.links) {
    names.push_back(link.name);
    shapes.push_back(link.collision.size());
  }
  EXPECT_EQ(names, (std::vector<std::string>{"arm_a", "arm_b", "a", "b"}));
  EXPECT_EQ(shapes, (std::vector<std::size_t>{1, 0, 0, 0})) << "of the arm's b and the hand's a";
  EXPECT_EQ(loaded.arm_tip_link, "arm_b");
  const auto yaml_error = [&](const std::string& text) {
    return error_of(write("r.yaml", text), [](const std::filesystem::path& file) { return load_robot(file); });
  };
  expect_contains(yaml_error("arm: {urdf: arm.urdf, joints: [s]}\nhand: hand.yaml\nmount: {parent: b}\n"),
                  {"r.yaml:3", "'a'", "arm.link_prefix"});
  expect_contains(yaml_error("arm: {urdf: hand.urdf, joints: [s], link_prefix: arm_}\nhand: hand.yaml\n"),
                  {"r.yaml:1", "link_prefix", "two files"});
}

/// Signed distance to the surface of a link's primitive shapes: the least over them.
double surface_distance(const Link& link, const Eigen::Vector3d& p_L) {
  double least = 1e9;
  for (const Geometry& geometry : link.collision) {
    const Eigen::Vector3d p = geometry.X_BG.inverse() * p_L;
    if (const auto* sphere = std::get_if<Sphere>(&geometry.shape)) least = std::min(least, p.norm() - sphere->radius);
    if (const auto* box = std::get_if<Box>(&geometry.shape)) {
      least = std::min(least, (p.cwiseAbs() - 0.5 * box->size).maxCoeff());
    }
    if (const auto* cylinder = std::get_if<Cylinder>(&geometry.shape)) {
      least =
          std::min(least, std::max(p.head<2>().norm() - cylinder->radius, std::abs(p.z()) - 0.5 * cylinder->length));
    }
  }
  return least;
}

void check_hand(const RobotDescription& hand, int thumb_points) {
  std::map<std::string, int> per_finger;
  for (const SurfacePoint& point : hand.contact_points) ++per_finger[point.finger];
  EXPECT_EQ(per_finger["index"], 4);
  EXPECT_EQ(per_finger["middle"], 4);
  EXPECT_EQ(per_finger["ring"], 4);
  EXPECT_EQ(per_finger["thumb"], thumb_points);
  EXPECT_EQ(per_finger["palm"], 3);
  std::vector<SurfacePoint> points = hand.contact_points;
  points.insert(points.end(), hand.tips.begin(), hand.tips.end());
  for (const SurfacePoint& point : points) {
    const Link& link = hand.links[static_cast<std::size_t>(point.link)];
    EXPECT_NEAR(surface_distance(link, point.p_L), 0.0, 1e-9) << point.name << " is not on " << link.name;
    EXPECT_GT(surface_distance(link, point.p_L + 1e-4 * point.n_L), 5e-5) << point.name << ": normal does not leave";
  }
}

TEST_F(LoadRobot, OurHandsHaveTheirContactPointsOnTheSurface) {
  const RobotDescription allegro = load_hand(ours("ur5_allegro/allegro_right.yaml"));
  EXPECT_EQ(allegro.contact_points.size(), 18u) << "Fig. 5 of the paper";
  check_hand(allegro, 3);
  check_hand(load_robot(ours("ur5_allegro/ur5_allegro_right.yaml")), 3);
  check_hand(load_hand(ours("human_hand/human_hand.yaml")), 3);
}

TEST_F(LoadRobot, RealRobotsLoadWithTheirPointsOnTheSurface) {
  if (!fs::exists(OPPONENS_SHARED_DATA "/data/robots")) GTEST_SKIP() << "no " OPPONENS_SHARED_DATA;
  setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 1);
  const std::string folder = OPPONENS_SOURCE_DIR "/tests/data/robots/";
  check_hand(load_robot(folder + "example_ur5_allegro_right.yaml"), 3);
  check_hand(load_robot(folder + "example_ur5_allegro_left.yaml"), 3);
  check_hand(load_robot(folder + "paper_lab_ur5_allegro_right_urdf.yaml"), 3);
  check_hand(load_robot(folder + "paper_lab_ur5_allegro_left_urdf.yaml"), 3);
  const RobotDescription visual = load_robot(folder + "paper_lab_ur5_allegro_right_visual.yaml");
  std::size_t triangles = 0;
  for (const Link& link : visual.links) {
    for (const Geometry& geometry : link.collision) {
      triangles +=
          static_cast<std::size_t>(std::get<std::shared_ptr<const TriangleMesh>>(geometry.shape)->triangles.cols());
    }
  }
  EXPECT_GT(triangles, 200000u);
  EXPECT_EQ(load_hand(folder + "dex_allegro_right.yaml").hand_joints.size(), 16u);
}

/// A pair that touches wherever the joints are would make every configuration useless: it belongs in the YAML.
TEST_F(LoadRobot, NoPairAlwaysCollides) {
  for (const RobotDescription& description :
       {load_robot(ours("ur5_allegro/ur5_allegro_right.yaml")), load_hand(ours("human_hand/human_hand.yaml"))}) {
    const RobotModel model(description);
    const CollisionChecker checker(model, Scene{});
    Rng rng(31);
    std::map<BodyPair, int> count;
    int free = 0;
    const int samples = 300;
    for (int sample = 0; sample < samples; ++sample) {
      Eigen::VectorXd q(model.dof());
      for (int i = 0; i < model.dof(); ++i) q[i] = rng.uniform(model.lower()[i], model.upper()[i]);
      const std::vector<BodyPair> pairs = checker.colliding_pairs(q);
      for (const BodyPair& pair : pairs) ++count[pair];
      free += pairs.empty() ? 1 : 0;
    }
    for (const auto& [pair, times] : count) EXPECT_LT(times, samples / 2) << pair.first << " " << pair.second;
    EXPECT_GT(free, samples / 20) << description.name;
  }
}

TEST_F(LoadRobot, HumanHandIsAsPublished) {
  const RobotDescription hand = load_hand(ours("human_hand/human_hand.yaml"));
  const RobotModel model(hand);
  ASSERT_EQ(model.dof(), 23);
  EXPECT_EQ(model.joint_names().front(), "T_ROT");
  EXPECT_EQ(model.joint_names().back(), "W_YAW");
  // Straight middle finger: 0.266 + 0.170 + 0.108 of 0.19 m in front of the palm frame, the ball's end on the axis.
  const auto X = model.link_poses(Eigen::VectorXd::Zero(23));
  const auto tip = std::find_if(hand.tips.begin(), hand.tips.end(),
                                [](const SurfacePoint& point) { return point.name == "middle"; });
  const Link& last = hand.links[static_cast<std::size_t>(tip->link)];
  const Eigen::Vector3d end = X[static_cast<std::size_t>(tip->link)] * last.collision.back().X_BG.translation();
  EXPECT_NEAR(end.z() + std::get<Sphere>(last.collision.back().shape).radius, 0.544 * 0.19, 1e-9);
  const auto moved = [&](const std::string& channel, const std::string& name, double angle) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(23);
    const auto& names = model.joint_names();
    q[std::find(names.begin(), names.end(), channel) - names.begin()] = angle;
    const auto Y = model.link_poses(q);
    const auto point = std::find_if(hand.tips.begin(), hand.tips.end(),
                                    [&](const SurfacePoint& candidate) { return candidate.name == name; });
    const auto link = static_cast<std::size_t>(point->link);
    return (Y[link] * point->p_L - X[link] * point->p_L).eval();
  };
  for (const char* finger : {"index", "middle", "ring", "little"}) {
    const std::string letter(1, static_cast<char>(std::toupper(finger[0])));
    EXPECT_GT(moved(letter + "_MCP", finger, 0.5).x(), 0.02) << "flexion goes to the palm's side";
    EXPECT_GT(moved(letter + "_DIP", finger, 0.5).x(), 0.005);
    const double out = moved(letter + "_ABD", finger, 0.2).y();
    EXPECT_GT((letter == "R" || letter == "L") ? -out : out, 0.01) << finger << ": abduction leaves the middle finger";
    EXPECT_EQ(moved("W_PITCH", finger, 0.5).norm(), 0.0);
    EXPECT_EQ(moved("W_YAW", finger, 0.5).norm(), 0.0);
  }
  EXPECT_GT(moved("T_ABD", "thumb", 0.5).y(), 0.02);
  EXPECT_GT(moved("PALM_ARCH", "little", 0.3).x(), 0.01);
}

}  // namespace
}  // namespace opponens::robot
