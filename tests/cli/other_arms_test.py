# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Grasps and paths of arms that are not of the UR family (seven joints; three slides and a wrist), whose inverse kinematics
is damped least squares: found, planned and verified, the same bytes whatever the thread count."""
import pathlib
import re
import shutil
import tempfile
import unittest

from support import SOURCE, must, snapshot

ROBOTS = SOURCE / "tests/data/robots"
STARTS = {
    "seven_joint": "arm_joint_1: 0, arm_joint_2: -0.6, arm_joint_3: 0, arm_joint_4: -1.9, arm_joint_5: 0,\n"
                   "   arm_joint_6: -0.3, arm_joint_7: 0,\n   ",
    "gantry": "slide_x: 0, slide_y: 0, slide_z: 0.75, yaw: 0, pitch: -1.5, roll: 0,\n   ",
}


def scene(folder, name):
    """The cylinder on its shelf, for another arm's joints."""
    text = (SOURCE / "models/scenes/cylinder_shelf.yaml").read_text()
    text, count = re.subn(r"shoulder_pan_joint.*?wrist_3_joint: -1.6,\s*", STARTS[name], text, flags=re.DOTALL)
    assert count == 1
    path = folder / f"{name}.yaml"
    path.write_text(text)
    return path


class OtherArm:
    """name: of the robot's file."""
    name = ""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.folder.name)
        must("simulate", "--store", cls.root / "one", "--repetitions", 3, "--seed", 3)
        must("retarget", "--store", cls.root / "one")
        must("analyze", "--store", cls.root / "one", "--seed", 3)
        shutil.copytree(cls.root / "one", cls.root / "two")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_grasps_and_paths_are_found_and_verified(self):
        for copy, threads in (("one", 1), ("two", 2)):
            world = ("--store", self.root / copy, "--robot", ROBOTS / f"{self.name}_allegro_right.yaml", "--scene",
                     scene(self.root, self.name), "--seed", 3, "--threads", threads)
            grasps = must("grasp", *world, "--count", 1, "--min-trials", 128, "--max-trials", 400)
            self.assertGreater(len(grasps["grasps"]), 0, grasps["rejected"])
            plan = must("plan", *world, "--runs", 2)
            self.assertEqual([run["status"] for run in plan["runs"]], ["solved", "solved"])
        self.assertEqual(snapshot(self.root / "one"), snapshot(self.root / "two"))
        self.assertEqual(must("verify", "--store", self.root / "one")["failed"], [])


class SevenJoints(OtherArm, unittest.TestCase):
    name = "seven_joint"


class Gantry(OtherArm, unittest.TestCase):
    name = "gantry"


if __name__ == "__main__":
    unittest.main()
