# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""opponens check and opponens mesh: verdicts that are known beforehand, and bad input."""
import json
import pathlib
import struct
import tempfile
import unittest

from support import SHARED, SOURCE, must, run

SCENE = "models/scenes/cylinder_shelf.yaml"
UR5 = SOURCE / "experiments/motion_bench_maker/ur5.yaml"
PROBLEMS = SHARED / "data/scenes/ur5_problems"
BASE = "0,0,0.9144,0,0,1.5707963267948966"


def start_of_scene():
    """Joint positions of the scene's start, by name."""
    text = (SOURCE / SCENE).read_text().split("start:")[1].split("bodies:")[0]
    body = text[text.index("{") + 1:text.index("}")]
    return {name.strip(): float(value) for name, value in (item.split(":") for item in body.split(","))}


def cube(triangles, edge=0.1):
    """Binary STL of some of a cube's twelve triangles."""
    corner = [[edge * (i >> k & 1) for k in range(3)] for i in range(8)]
    faces = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2),
             (1, 3, 7), (1, 7, 5)]
    faces = faces[:triangles]
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *corner[a], *corner[b], *corner[c], 0) for a, b, c in faces)
    return bytes(80) + struct.pack("<I", len(faces)) + body


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def write(self, name, content):
        path = self.root / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def refuse(self, words, *arguments):
        code, out, err = run(*arguments)
        self.assertEqual(code, 2, out + err)
        self.assertEqual(out, "")
        self.assertEqual(len(err.strip().splitlines()), 1, err)
        for word in words:
            self.assertIn(word, err)


class Check(Files):
    def table(self, configurations, extra=""):
        names = sorted(configurations[0])  # not the robot's order
        lines = [",".join(names) + extra] + [",".join(repr(q[n]) for n in names) + (",7" if extra else "")
                                             for q in configurations]
        return self.write("q.csv", "\n".join(lines) + "\n")

    def test_free_and_colliding(self):
        start = start_of_scene()
        table = self.table([start, {**start, "shoulder_lift_joint": 0.9}])
        result = must("check", "--scene", SCENE, "--configs", table)
        free, hit = result["configs"]
        self.assertTrue(free["free"])
        self.assertEqual(free["pairs"], [])
        self.assertGreater(free["clearance_m"], 0.001)
        self.assertEqual(len(free["nearest"]), 2)
        self.assertFalse(hit["free"])
        self.assertEqual(hit["clearance_m"], 0)
        self.assertTrue(any("shelf" in pair or "floor" in pair or "bookcase" in pair or "pedestal" in pair
                            for pair in hit["pairs"]), hit)
        code, out, _ = run("check", "--scene", SCENE, "--configs", table)
        self.assertEqual(code, 0)
        self.assertIn("2 configurations: 1 free, 1 colliding", out)

    def test_base_moves_the_robot(self):
        table = self.table([start_of_scene()])
        sunk = must("check", "--scene", SCENE, "--configs", table, "--base", "0,0,-0.05")["configs"][0]
        self.assertTrue(any("floor" in pair for pair in sunk["pairs"]), sunk)

    def test_columns(self):
        start = start_of_scene()
        result = must("check", "--scene", SCENE, "--configs", self.table([start], ",time"))
        self.assertTrue(any("time" in note for note in result["notes"]), result["notes"])
        missing = {name: value for name, value in start.items() if name != "elbow_joint"}
        self.refuse(["elbow_joint"], "check", "--scene", SCENE, "--configs", self.table([missing]))
        table = self.table([start])
        text = table.read_text()
        table.write_text(text.replace("0.25", "nan", 1))
        self.refuse(["q.csv:2", "nan"], "check", "--scene", SCENE, "--configs", table)
        table.write_text(text.replace("joint_1.0", "joint_0.0", 1))
        self.refuse(["joint_0.0", "once"], "check", "--scene", SCENE, "--configs", table)

    def test_wrong_use(self):
        table = self.table([start_of_scene()])
        self.refuse(["--configs or --requests"], "check", "--scene", SCENE)
        self.refuse(["--scene"], "check", "--configs", table)
        self.refuse(["--base", "2 numbers"], "check", "--scene", SCENE, "--configs", table, "--base", "0,0")
        self.refuse(["absent.csv"], "check", "--scene", SCENE, "--configs", self.root / "absent.csv")

    def arm(self):
        """Our UR5 without its hand."""
        urdf = SOURCE / "models/ur5_allegro/ur5.urdf"
        joints = "[shoulder_pan_joint, shoulder_lift_joint, elbow_joint, wrist_1_joint, wrist_2_joint, wrist_3_joint]"
        return self.write("arm.yaml", f"name: arm\narm: {{urdf: {urdf}, joints: {joints}}}\n")

    def test_requests_of_an_arm_alone(self):
        # A wall before and behind: the arm stands upright between, and meets one when it lies down.
        board = "{type: box, dimensions: [0.1, 3, 3]}"
        pose = "{position: [%s, 0, 0.5], orientation: [0, 0, 0, 1]}"
        scene = ("world: {collision_objects: [{id: walls, primitives: [" + board + ", " + board + "], primitive_poses: ["
                 + pose % "0.5" + ", " + pose % "-0.5" + "]}]}\n")
        self.write("scene0001.yaml", scene)
        joints = ["shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint", "gripper"]
        goal = [{"joint_name": "shoulder_pan_joint", "position": 0}, {"joint_name": "shoulder_lift_joint", "position": 0}]
        # YAML is a superset of JSON.
        request = self.write("request0001.yaml", json.dumps({
            "start_state": {"joint_state": {"name": joints, "position": [0, -1.5707, 0, -1.5707, 0, 0]}},
            "goal_constraints": [{"joint_constraints": goal}]}))
        result = must("check", "--robot", self.arm(), "--requests", request)
        self.assertEqual(result["summary"], {"requests": 1, "start_free": 1, "start_colliding": 0, "goal_free": 0,
                                             "goal_colliding": 1})
        one = result["requests"][0]
        self.assertEqual(one["joints_the_robot_lacks"], ["gripper"])
        self.assertEqual(one["joints_assumed"], ["wrist_3_joint"])
        self.assertTrue(all("walls" in pair for pair in one["goals"][0]["pairs"]), one)
        self.refuse(["has no 'request' in its name"], "check", "--robot", self.arm(), "--requests",
                    self.write("problem.yaml", request.read_text()))
        self.refuse(["surprise"], "check", "--robot", self.arm(), "--scene",
                    self.write("bad.yaml", scene + "surprise: 1\n"), "--requests", request)

    @unittest.skipUnless(PROBLEMS.exists(), f"needs {PROBLEMS}")
    def test_motion_bench_maker(self):
        requests = sorted(PROBLEMS.glob("*/request*.yaml"))
        self.assertEqual(len(requests), 60)
        result = must("check", "--robot", UR5, "--base", BASE, "--requests", *requests,
                      env={"OPPONENS_ROBOT_DATA": str(SHARED / "data/robots")})
        self.assertEqual(result["summary"]["requests"], 60)
        self.assertEqual(len(result["requests"]), 60)
        for request in result["requests"]:
            self.assertEqual(len(request["goals"]), 1)
            self.assertEqual(len(request["joints_the_robot_lacks"]), 6)
            self.assertEqual(request["joints_assumed"], [])
            for verdict in [request["start"], *request["goals"]]:
                self.assertEqual(verdict["free"], verdict["clearance_m"] > 0, request["file"])
        # Who made the problems checked them, with a gripper: free ends are the answer.
        self.assertEqual(result["summary"], {"requests": 60, "start_free": 60, "start_colliding": 0, "goal_free": 60,
                                             "goal_colliding": 0})
        elsewhere = must("check", "--robot", UR5, "--base", "0,0,0.75", "--requests", *requests,
                         env={"OPPONENS_ROBOT_DATA": str(SHARED / "data/robots")})
        self.assertGreater(elsewhere["summary"]["goal_colliding"], 0)


class Mesh(Files):
    def test_report_and_repair(self):
        broken = self.write("open.stl", cube(10))
        entry = must("mesh", broken)["meshes"][0]
        self.assertEqual(entry["defects"], ["1 hole (the longest rim has 4 edges, 0.4 m)"])
        self.assertFalse(entry["closed"])
        fixed = self.root / "fixed.stl"
        repaired = must("mesh", broken, "--repair", fixed)["meshes"][0]["repaired"]
        self.assertEqual(repaired["check"]["defects"], [])
        self.assertAlmostEqual(repaired["litres_after"], 1.0, places=6)
        self.assertIsNone(repaired["litres_before"])
        self.assertLess(repaired["shrunk_m"], 1e-8)
        self.assertEqual(must("mesh", fixed)["meshes"][0]["defects"], [])
        code, out, _ = run("mesh", broken, "--repair", fixed)
        self.assertEqual(code, 0)
        self.assertIn("holes filled", out)

    def test_unit(self):
        wide = self.write("wide.stl", cube(12, 200.0))
        entry = must("mesh", wide)["meshes"][0]
        self.assertEqual(entry["likely_scales"], [0.001, 0.01])
        self.assertIn("millimetres read as metres", entry["defects"][0])
        self.assertEqual(must("mesh", wide, "--unit", "mm")["meshes"][0]["defects"], [])

    def test_crossing_parts_are_told_and_stay(self):
        one = cube(12)
        moved = bytearray(one[84:])
        for i in range(12):
            values = list(struct.unpack_from("<12fH", moved, 50 * i))
            values[3:12] = [v + 0.03 for v in values[3:12]]
            struct.pack_into("<12fH", moved, 50 * i, *values)
        both = self.write("both.stl", bytes(80) + struct.pack("<I", 24) + one[84:] + bytes(moved))
        self.assertGreater(must("mesh", both, "--intersections")["meshes"][0]["self_intersections"], 0)
        must("mesh", both, "--intersections", "--repair", self.root / "out.stl", code=1)

    def test_a_scene_with_a_broken_mesh_is_told(self):
        self.write("open.stl", cube(10))
        scene = self.write("s.yaml", "name: s\nbodies: [{name: mug, pose: {xyz: [9, 0, 0]}, geometry: [{mesh: "
                                     "{file: open.stl}}]}]\n")
        start = start_of_scene()
        table = self.write("q.csv", ",".join(start) + "\n" + ",".join(map(str, start.values())) + "\n")
        notes = must("check", "--scene", scene, "--configs", table)["notes"]
        self.assertTrue(any("body 'mug'" in note and "1 hole" in note for note in notes), notes)

    def test_bad_input(self):
        huge = self.write("huge.stl", bytes(80) + struct.pack("<I", 21474836))
        self.refuse(["huge.stl", "announces 21474836 triangles"], "mesh", huge)
        self.refuse(["absent.stl"], "mesh", self.root / "absent.stl")
        good = self.write("good.stl", cube(12))
        self.refuse(["--simplify needs --repair"], "mesh", good, "--simplify", 8)
        self.refuse([".stl"], "mesh", good, "--repair", self.root / "out.obj")
        self.refuse(["one FILE"], "mesh", good, good, "--repair", self.root / "out.stl")
        self.refuse(["cannot be written"], "mesh", good, "--quiet", "--repair", "/proc/nowhere/out.stl")


if __name__ == "__main__":
    unittest.main()
