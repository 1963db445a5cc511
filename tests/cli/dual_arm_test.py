# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""The dual-arm robot through the command line: each arm grasps and moves with the other one in the way; the arm is part of
what stored objects were made with."""
import pathlib
import tempfile
import unittest

from support import must, run

ROBOT = "models/dual_ur5_allegro/dual_ur5_allegro.yaml"


class DualArm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.store = pathlib.Path(cls.folder.name) / "store"
        must("simulate", "--store", cls.store, "--repetitions", 2)
        must("retarget", "--store", cls.store)  # to the right hand: its synergies serve both
        must("analyze", "--store", cls.store)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def world(self, arm):
        return ("--store", self.store, "--robot", ROBOT + arm, "--scene", "models/scenes/dual_bookshelf.yaml")

    def refuse(self, words, *arguments):
        code, out, err = run(*arguments)
        self.assertEqual((code, out, len(err.strip().splitlines())), (2, "", 1), err)
        for word in words:
            self.assertIn(word, err)

    def test_each_arm_grasps_and_moves(self):
        # Without an arm's name the file's default is driven: the right one.
        for arm, side in (("", "right"), ("#left", "left")):
            self.refuse(["opponens grasp"], "plan", *self.world(arm))  # no grasp of the other arm is taken for its own
            found = must("grasp", *self.world(arm), "--group", "1", "--count", 1, "--max-trials", 1500)["grasps"]
            self.assertGreaterEqual(len(found), 1)
            for contact in found[0]["contacts"]:
                self.assertTrue(contact["link"].startswith(side + "/"), contact)
            self.assertIn("joint_0.0", found[0]["joints"])
            path = must("plan", *self.world(arm))["path"]
            self.assertEqual(len(path["joint_names"]), 22)
            self.assertTrue(all(name.startswith(side + "/") for name in path["joint_names"]))
        verdict = must("verify", "--store", self.store)
        self.assertEqual(verdict["failed"], [])
        self.assertGreaterEqual(verdict["checked"], 4)
        report = pathlib.Path(self.folder.name) / "report.html"
        must("report", "--store", self.store, "--out", report)
        self.assertIn("left/", report.read_text())
        # The default arm and its own name are one world; the other arm's grasps are not taken.
        must("plan", *self.world("#right"))

    def test_refused(self):
        self.refuse(["#both", "one arm", "#right", "#left"], "grasp", *self.world("#both"))
        self.refuse([ROBOT, "arms", "'middle'", "right, left, both"], "grasp", *self.world("#middle"))
        self.refuse(["#", "no arm"], "grasp", *self.world("#"))
        single = "models/ur5_allegro/ur5_allegro_right.yaml"
        self.refuse([single, "'arms'", "'left'"], "grasp", "--store", self.store, "--robot", single + "#left")


if __name__ == "__main__":
    unittest.main()
