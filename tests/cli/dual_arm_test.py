# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""The dual-arm robot through the command line: each arm grasps and moves with the other one in the way; the arm is part of
what stored objects were made with."""
import json
import pathlib
import shutil
import tempfile
import unittest

from support import SOURCE, analysed_store, forge, must, run

ROBOT = "models/dual_ur5_allegro/dual_ur5_allegro.yaml"


def refuse(case, words, *arguments):
    code, out, err = run(*arguments)
    case.assertEqual((code, out, len(err.strip().splitlines())), (2, "", 1), err)
    for word in words:
        case.assertIn(word, err)


class DualArm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.store = pathlib.Path(cls.folder.name) / "store"
        analysed_store(cls.store)  # of the right hand: its synergies serve both

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def world(self, arm):
        return ("--store", self.store, "--robot", ROBOT + arm, "--scene", "models/scenes/dual_bookshelf.yaml")

    def test_each_arm_grasps_and_moves(self):
        # Without an arm's name the file's default is driven: the right one.
        for arm, side in (("", "right"), ("#left", "left")):
            refuse(self, ["opponens grasp"], "plan", *self.world(arm))  # no grasp of the other arm is taken for its own
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
        # Both hands at the one cylinder are in each other's way.
        code, out, err = run("plan", *self.world("#both"), "--json")
        self.assertEqual(code, 1, err)
        answer = json.loads(out)
        self.assertEqual(answer["runs"][0]["status"], "no_goals")
        self.assertEqual(answer["pairs"]["kept"], 0)
        self.assertEqual(answer["pairs"]["asked"], sum(one["count"] for one in answer["pairs"]["left_out"]))
        for words in ("no pair of grasps fits together", "in collision", "most often", "opponens grasp --count"):
            self.assertIn(words, answer["runs"][0]["detail"])
        self.assertIn("pairs of grasps left out", err)
        must("report", "--store", self.store, "--out", report)
        self.assertIn("no pair of grasps fits together", report.read_text())

    def test_refused(self):
        refuse(self, ["#both", "one arm", "#right", "#left"], "grasp", *self.world("#both"))
        refuse(self, [ROBOT, "arms", "'middle'", "right, left, both"], "grasp", *self.world("#middle"))
        refuse(self, ["#", "no arm"], "grasp", *self.world("#"))
        single = "models/ur5_allegro/ur5_allegro_right.yaml"
        refuse(self, [single, "'arms'", "'left'"], "grasp", "--store", self.store, "--robot", single + "#left")


class BothArms(unittest.TestCase):
    """Each arm at a cylinder of its own, both moving at once."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.store = pathlib.Path(cls.folder.name) / "store"
        analysed_store(cls.store)
        cls.grasps = {}
        for arm in ("right", "left"):
            found = must("grasp", *cls.world(cls.store, "#" + arm), "--object", f"{arm}_cylinder", "--group", "1",
                         "--count", 2, "--max-trials", 1500)["grasps"]
            cls.grasps[arm] = [one["id"] for one in found]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @staticmethod
    def world(store, arm="#both"):
        return ("--store", store, "--robot", ROBOT + arm, "--scene", "models/scenes/dual_bookshelf_two.yaml")

    objects = ("--object", "right=right_cylinder", "--object", "left=left_cylinder")

    def copied(self, name):
        store = pathlib.Path(self.folder.name) / name
        shutil.copytree(self.store, store)
        return store

    def test_both_plan_to_a_pair_of_grasps(self):
        store = self.copied("planned")
        planned = must("plan", *self.world(store), *self.objects, "--threads", 1)
        names = planned["path"]["joint_names"]
        self.assertEqual(len(names), 44)
        self.assertEqual([name.split("/")[0] for name in names],
                         ["right"] * 6 + ["left"] * 6 + ["right"] * 16 + ["left"] * 16)
        run_of = planned["runs"][0]
        self.assertEqual([one["arm"] for one in run_of["goals"]], ["right", "left"])
        for one in run_of["goals"]:
            self.assertIn(one["grasp"], self.grasps[one["arm"]])
        self.assertEqual(planned["pairs"]["kept"], 64)
        mean, right, left = run_of["human_likeness_all"][:3]
        self.assertEqual([one["hands"] for one in (mean, right, left)], [["right", "left"], ["right"], ["left"]])
        self.assertAlmostEqual(mean["value"], 0.5 * (right["value"] + left["value"]))
        self.assertEqual(run_of["human_likeness"], mean["value"])

        # The same seed gives the same objects, whatever the threads; an object for all, which both override, changes
        # nothing.
        again = self.copied("again")
        self.assertEqual(must("plan", *self.world(again), "--object", "shelf", *self.objects, "--threads", 2)["ids"],
                         planned["ids"])

        fields = must("show", "--store", store, planned["ids"][0])["object"]["fields"]
        self.assertEqual([fields["goal_grasp"], fields["goal_grasp.left"]], [one["grasp"] for one in run_of["goals"]])
        verdict = must("verify", "--store", store)
        self.assertEqual(verdict["failed"], [])
        self.assertIn(planned["ids"][0], [one["id"] for one in verdict["verdicts"]])
        report = pathlib.Path(self.folder.name) / "both.html"
        must("report", "--store", store, "--out", report)
        page = report.read_text()
        for words in ("reaching grasps", "(right) and ", "(left)", "Arm right", "Arm left", "Blue lines",
                      "mean over hands", "2 grasps of right_cylinder", "2 grasps of left_cylinder"):
            self.assertIn(words, page)
        for form in ("csv", "trajectory_json"):
            out = pathlib.Path(self.folder.name) / form
            must("export", "--store", store, planned["ids"][0], "--format", form, "--out", out)
        self.assertEqual(json.loads(out.read_text())["joint_names"], names)
        self.assertEqual(must("stale", "--store", store)["stale"], [])

    def test_both_hands_at_one_object(self):
        text = (SOURCE / self.world("")[-1]).read_text()
        bodies, shelf = text.index("  - name: right_cylinder"), text.index("  - name: shelf")
        scene = pathlib.Path(self.folder.name) / "bar.yaml"
        scene.write_text(text[:bodies].replace("object: right_cylinder", "object: bar") + """\
  - name: bar
    pose: {xyz: [-0.35, 0.9, 1.22], rpy: [0, 1.5707963267948966, 0]}
    geometry:
      - revolution: {profile: [[0.025, 0], [0.025, 0.2], [0.025, 0.5], [0.025, 0.7]], segments: 48}
""" + text[shelf:])
        store = self.copied("bar")
        for arm in ("right", "left"):
            must("grasp", *self.world(store, "#" + arm)[:-1], scene, "--group", "1", "--count", 4, "--max-trials", 1500)
        code, out, err = run("plan", *self.world(store)[:-1], scene, "--json")
        self.assertEqual(code, 0, err)
        planned = json.loads(out)
        self.assertEqual(planned["pairs"]["asked"], planned["pairs"]["kept"]
                         + sum(one["count"] for one in planned["pairs"]["left_out"]))
        self.assertEqual(must("verify", "--store", store)["failed"], [])

    def test_pairs_at_most(self):
        planned = must("plan", *self.world(self.copied("few")), *self.objects, "--pairs", 2, "--max-checks", 300,
                       code=1)
        self.assertEqual(planned["pairs"]["kept"], 2)
        self.assertEqual(len(planned["runs"][0]["diagnostics"]["goals"]), 2)
        for goal in planned["runs"][0]["diagnostics"]["goals"]:
            self.assertEqual([goal["grasps"][0] in self.grasps["right"], goal["grasps"][1] in self.grasps["left"]],
                             [True, True])

    def test_verify_sees_what_was_exchanged(self):
        sound = self.copied("sound")
        planned = must("plan", *self.world(sound), *self.objects)
        goals = {one["arm"]: one["grasp"] for one in planned["runs"][0]["goals"]}
        other_left = next(id for id in self.grasps["left"] if id != goals["left"])

        def grasp_of_left(id):
            def change(fields):
                fields.attrs["goal_grasp.left"] = id
            return change

        def no_grasp_of_left(fields):
            del fields.attrs["goal_grasp.left"]

        def exchanged(fields):
            right, left = (fields.attrs[name] for name in ("goal_grasp", "goal_grasp.left"))
            fields.attrs["goal_grasp"], fields.attrs["goal_grasp.left"] = left, right

        def left_fingers_closed_further(fields):
            fields["motion"][-1, 28:] += 0.02

        def left_arm_folded_into_itself(fields):
            elbow = list(fields["joint_names"].asstr()[...]).index("left/elbow_joint")
            fields["motion"][fields["motion"].shape[0] // 2, elbow] = 3.1

        for number, (words, change) in enumerate((
                ("differs from the pre-grasp", grasp_of_left(other_left)),
                ("is no grasp of left_cylinder of arm left", grasp_of_left(goals["right"])),
                ("names no grasp of arm left", grasp_of_left("0" * 64)),
                ("names no grasp of arm left", no_grasp_of_left),
                ("is no grasp of right_cylinder of arm right", exchanged),
                ("differs from the grasp", left_fingers_closed_further),
                ("collision of left/", left_arm_folded_into_itself))):
            with self.subTest(words=words, number=number):
                store = pathlib.Path(self.folder.name) / f"tampered_{number}"
                shutil.copytree(sound, store)
                forge(store, "path", change)
                failed = must("verify", "--store", store, code=1)["failed"]
                self.assertEqual(len(failed), 1)
                self.assertIn(words, failed[0]["reason"])

    def test_refused(self):
        world = self.world(self.store)
        refuse(self, ["'middle'", "right, left"], "plan", *world, "--object", "middle=left_cylinder")
        refuse(self, ["cup", "right_cylinder, left_cylinder, shelf"], "plan", *world, "--object", "left=cup")
        refuse(self, ["second object", "right"], "plan", *world, *self.objects, "--object", "right=shelf")
        # Without a choice both arms take the scene's object, of which the left one has no grasps.
        refuse(self, ["arm left", "opponens grasp --robot", ROBOT + "#left --scene", "--object right_cylinder"],
               "plan", *world)
        right = self.world(self.store, "#right")
        refuse(self, ["right=right_cylinder: no such body"], "plan", *right, "--object", "right=right_cylinder")
        refuse(self, ["second object"], "grasp", *right, "--object", "right_cylinder", "--object", "left_cylinder")


if __name__ == "__main__":
    unittest.main()
