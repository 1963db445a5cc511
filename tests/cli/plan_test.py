# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""opponens plan: a defined answer to every question, the reasons of a failure, equal bytes at any thread count."""
import json
import pathlib
import re
import shutil
import tempfile
import unittest

from support import SOURCE, analysed_store, forge, must, run, snapshot

SCENE = SOURCE / "models/scenes/cylinder_shelf.yaml"
INTO_THE_PEDESTAL = ("shoulder_lift_joint: -1.15", "shoulder_lift_joint: 1.0")


def changed_scene(folder, old, new):
    text = SCENE.read_text()
    assert old in text, old
    scene = pathlib.Path(folder) / "scene.yaml"
    scene.write_text(text.replace(old, new))
    return scene


class Plan(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        root = pathlib.Path(cls.folder.name)
        cls.empty = root / "empty"
        analysed_store(cls.empty, 3)
        cls.store = root / "store"
        shutil.copytree(cls.empty, cls.store)
        must("grasp", "--store", cls.store, "--scene", SCENE, "--count", 1, "--max-trials", 200)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def copied(self, folder, store=None):
        copy = pathlib.Path(folder) / "store"
        shutil.copytree(store or self.store, copy)
        return copy

    def refused(self, *arguments, words):
        code, _, err = run("plan", *arguments)
        self.assertEqual(code, 2, err)
        for word in words:
            self.assertIn(word, err)

    def failed(self, *arguments):
        """The first run of a plan that finds no path, and what is told to a person."""
        code, out, err = run("plan", *arguments, "--json")
        self.assertEqual(code, 1, err)
        code, said, err = run("plan", *arguments)
        self.assertEqual(code, 1, err)
        return json.loads(out)["runs"][0], said

    def test_no_grasps(self):
        self.refused("--store", self.empty, "--scene", SCENE, words=["no grasps of", "opponens grasp"])

    def test_a_time_limit_of_zero_is_refused(self):
        for limit, word in (("0", "for no limit leave the option out"), ("-1", "--time-limit"), ("nan", "leave the option out")):
            self.refused("--store", self.store, "--scene", SCENE, f"--time-limit={limit}", words=[word])

    def test_unknown_and_missing_joints_of_the_start(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = changed_scene(folder, "shoulder_pan_joint:", "sholder_pan_joint:")
            self.refused("--store", self.store, "--scene", scene, words=["sholder_pan_joint", "does not have"])
            scene = changed_scene(folder, "shoulder_pan_joint: -0.1,", "")
            self.refused("--store", self.store, "--scene", scene, words=["lacks joint shoulder_pan_joint"])

    def test_swapped_limits(self):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(SOURCE / "models", pathlib.Path(folder) / "models")
            urdf = pathlib.Path(folder) / "models/ur5_allegro/ur5.urdf"
            text = urdf.read_text()
            lower = re.search(r'lower="([^"]*)" upper="([^"]*)"', text)
            urdf.write_text(text.replace(lower[0], f'lower="{lower[2]}" upper="{lower[1]}"', 1))
            code, _, err = run("plan", "--store", self.store, "--robot",
                               pathlib.Path(folder) / "models/ur5_allegro/ur5_allegro_right.yaml", "--scene", SCENE)
            self.assertEqual(code, 2, err)
            self.assertIn("lower limit is above", err)
            self.assertIn("ur5.urdf", err)

    def test_a_start_in_collision_names_pair_and_depth(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = changed_scene(folder, *INTO_THE_PEDESTAL)
            store = self.copied(folder, self.empty)
            must("grasp", "--store", store, "--scene", scene, "--count", 1, "--max-trials", 200)
            failed, said = self.failed("--store", store, "--scene", scene)
            self.assertEqual(failed["status"], "start_in_collision")
            pairs = failed["diagnostics"]["start_pairs"]
            self.assertTrue(pairs)
            self.assertGreater(max(one["depth_m"] for one in pairs), 1e-4)
            for one in pairs:
                self.assertIn(" with ".join(one["pair"]), said)
            self.assertRegex(said, r"[0-9.]+ mm deep")

    def test_goals_in_collision_are_named(self):
        def into_the_robot(fields):
            fields["arm.q_pregrasp"][:, 2] = 3.1  # the elbow folds the forearm onto the upper arm

        with tempfile.TemporaryDirectory() as folder:
            store = self.copied(folder)
            forge(store, "grasp", into_the_robot)
            failed, said = self.failed("--store", store, "--scene", SCENE)
            self.assertEqual(failed["status"], "no_goals")
            goals = failed["diagnostics"]["goals"]
            self.assertTrue(goals)
            self.assertEqual({one["fate"] for one in goals}, {"in_collision"})
            self.assertEqual(failed["goals_refused"], len(goals))
            self.assertTrue(all(one["pairs"] for one in goals))
            self.assertIn("in collision: ", said)

    def test_goals_outside_the_limits_are_named(self):
        def beyond(fields):
            fields["arm.q_pregrasp"][:, 2] = 7.0

        with tempfile.TemporaryDirectory() as folder:
            store = self.copied(folder)
            forge(store, "grasp", beyond)
            failed, said = self.failed("--store", store, "--scene", SCENE)
            self.assertEqual({one["fate"] for one in failed["diagnostics"]["goals"]}, {"outside_limits"})
            outside = failed["diagnostics"]["goals"][0]["outside"]
            self.assertEqual(outside[0]["joint"], "elbow_joint")
            self.assertGreater(outside[0]["excess_rad"], 0.5)
            self.assertRegex(said, "elbow_joint is above its upper limit by [0-9.]+ rad")

    def test_limits_tell_how_near_the_search_came(self):
        hard = ("--store", self.store, "--scene", SCENE, "--step", 0.02)
        for limit, status in ((("--max-checks", 200), "check_limit"), (("--time-limit", 1e-6), "time_limit")):
            failed, said = self.failed(*hard, *limit)
            self.assertEqual(failed["status"], status)
            self.assertIsNotNone(failed["diagnostics"])
            self.assertIn("stopped after", said)
        failed, said = self.failed(*hard, "--max-checks", 200)
        self.assertGreater(failed["diagnostics"]["gap_rad"], 0.02)
        self.assertIn("the trees came within", said)
        solved = must("plan", "--store", self.store, "--scene", SCENE)["runs"][0]
        self.assertIsNone(solved["diagnostics"])
        told = must("plan", "--store", self.store, "--scene", SCENE, "--diagnose")["runs"][0]
        self.assertGreater(told["diagnostics"]["start_vertices"], 1)

    def test_every_planner_answers_and_groups_keep_their_lengths(self):
        for planner in ("synergy", "rrtconnect", "synergy_sampling", "pregrasp_box"):
            with self.subTest(planner=planner), tempfile.TemporaryDirectory() as folder:
                document = must("plan", "--store", self.copied(folder), "--scene", SCENE, "--planner", planner,
                                "--arm-step", 0.3, "--hand-step", 0.1, "--arm-resolution", 0.02, "--hand-resolution", 0.05)
                self.assertEqual(document["runs"][0]["status"], "solved")

    def test_equal_bytes_at_1_2_and_4_threads(self):
        with tempfile.TemporaryDirectory() as folder:
            stores = []
            for threads in (1, 2, 4):
                stores.append(self.copied(pathlib.Path(folder) / str(threads)))
                code, _, err = run("plan", "--store", stores[-1], "--scene", SCENE, "--runs", 8, "--max-checks", 1500,
                                   "--threads", threads)
                self.assertIn(code, (0, 1), err)  # runs that fail, with their reasons, are stored too
            first = snapshot(stores[0])
            self.assertGreater(len(first), len(snapshot(self.store)))
            for store in stores[1:]:
                self.assertEqual(snapshot(store), first)


if __name__ == "__main__":
    unittest.main()
