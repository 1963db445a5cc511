# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""opponens grasp: every option has its effect, grasps made elsewhere are held to the same checks, and what cannot be
answered ends with a sentence."""
import copy
import json
import pathlib
import re
import tempfile
import unittest

from support import SOURCE, analysed_store, forge, must, run

HAND = SOURCE / "models/ur5_allegro/allegro_right.yaml"
TRIALS = 64  # one batch
SCENE = {"name": "box_on_table", "robot_base": {"xyz": [0, 0, 0.75]}, "object": "box", "support": "table", "bodies": [
    {"name": "box", "pose": {"xyz": [0.62, 0.02, 0.70], "rpy": [0, 0, 0.35]},
     "geometry": [{"box": {"size": [0.06, 0.1, 0.18]}, "pose": {"xyz": [0, 0, 0.09]}}]},
    {"name": "table", "pose": {"xyz": [0.85, 0, 0.68]}, "geometry": [{"box": {"size": [0.9, 1.4, 0.04]}}]}]}


class Grasp(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.directory.name)
        cls.store = cls.root / "store"
        cls.groups = [group["name"] for group in analysed_store(cls.store, 3)["groups"][1:]]
        # The search that the others differ from by one option.
        cls.plain = cls.grasp(cls)

    @classmethod
    def tearDownClass(cls):
        cls.directory.cleanup()

    def grasp(self, *options, code=0, samples=10):
        """The document of a small search."""
        given = [str(option) for option in options]
        more = []
        for name, value in [("--group", "all"), ("--trials", TRIALS), ("--noise-samples", samples),
                            ("--scene", "models/scenes/box_table.yaml")]:
            if name not in given and not (name == "--trials" and "--max-trials" in given):
                more += [name, value]
        return must("grasp", "--store", self.store, *options, *more, code=code)

    def refuse(self, code, words, *options):
        """Ends with that exit code and one line that has these words."""
        got, out, err = run("grasp", "--store", self.store, "--trials", TRIALS, *options)
        said = out + err
        self.assertEqual(got, code, said)
        for word in words:
            self.assertIn(word, said)
        return said

    def write(self, name, content):
        file = self.root / name
        file.write_text(content if isinstance(content, str) else json.dumps(content))
        return file

    def scene(self, name, change):
        """A box on a table, changed; JSON is YAML."""
        content = copy.deepcopy(SCENE)
        change(content)
        return self.write(name, content)

    def body(self, content, name):
        return next(body for body in content["bodies"] if body["name"] == name)


class Options(Grasp):
    def test_plain_search(self):
        plain = self.plain
        self.assertTrue(plain["grasps"])
        self.assertIsNone(plain["answer"])
        self.assertEqual(plain["object"], "box")
        self.assertEqual({group["name"] for group in plain["groups"]}, set(self.groups))
        for group in plain["groups"]:
            self.assertEqual(group["trials"], TRIALS)
            self.assertEqual(group["found"] + sum(group["rejected"].values()), TRIALS)
            self.assertEqual(sum(cause["trials"] for cause in group["causes"]), sum(group["rejected"].values()))
            counts = [cause["trials"] for cause in group["causes"]]
            self.assertEqual(counts, sorted(counts, reverse=True))
            for cause in group["causes"]:
                self.assertEqual(cause["trials"], sum(cause["reasons"].values()))
                self.assertAlmostEqual(cause["percent"], 100 * cause["trials"] / TRIALS)
        for grasp in plain["grasps"]:
            self.assertEqual(grasp["origin"], "searched")
            robust = grasp["robust"]
            self.assertEqual(robust["noise"], {"position": 0.005, "angle": 0.05, "friction": 0.05, "samples": 10})
            self.assertLessEqual(robust["interval"][0], robust["force_closure"])
            self.assertGreaterEqual(robust["interval"][1], robust["force_closure"])
            self.assertLessEqual(robust["epsilon_low"], robust["epsilon_mean"])

    def test_friction_and_edges(self):
        rough = self.grasp("--mu", 1.0)
        self.assertEqual({contact["mu"] for grasp in rough["grasps"] for contact in grasp["contacts"]}, {1.0})
        self.assertGreater(max(g["epsilon"] for g in rough["grasps"]), max(g["epsilon"] for g in self.plain["grasps"]))
        few = self.grasp("--edges", 3)
        self.assertLess(max(g["epsilon"] for g in few["grasps"]), max(g["epsilon"] for g in self.plain["grasps"]))

    def test_improvements(self):
        plain = self.grasp("--improvements", 0)
        best = {group: max(g["epsilon"] for g in self.plain["grasps"] if g["group"] == group) for group in self.groups
                if any(g["group"] == group for g in self.plain["grasps"])}
        for group, epsilon in best.items():
            self.assertGreaterEqual(epsilon, max(g["epsilon"] for g in plain["grasps"] if g["group"] == group))
        self.assertGreater(sum(best.values()), sum(
            max(g["epsilon"] for g in plain["grasps"] if g["group"] == group) for group in best))

    def test_slack_bound_labels(self):
        self.assertFalse(any(g["synergy_grasp"] for g in self.grasp("--slack-bound", 0)["grasps"]))
        wide = self.grasp("--slack-bound", 100)["grasps"]
        self.assertTrue(all(g["synergy_grasp"] for g in wide))
        for grasp in self.plain["grasps"]:
            self.assertEqual(grasp["synergy_grasp"], grasp["slack"] <= 0.3)
        self.assertEqual(must("verify", "--store", self.store)["failed"], [])  # by the bound that they were made with

    def test_limits_reject(self):
        def counted(document, words):
            return sum(count for reason, count in document["rejected"].items() if words in reason)
        tight = self.grasp("--max-penetration", 1e-5, "--count", 1000)
        loose = self.grasp("--max-penetration", 0.005, "--count", 1000)
        self.assertGreater(counted(tight, "penetrates"), counted(loose, "penetrates"))
        clear = self.grasp("--clearance", 0.06, "--count", 1000)
        near = self.grasp("--clearance", 0.0, "--count", 1000)
        self.assertGreater(counted(clear, "no clear pre-grasp"), counted(near, "no clear pre-grasp"))

    def test_tips(self):
        pinched = self.grasp("--tips", "--free-joints", "--trials", 60, "--count", 2)
        self.assertGreater(len(pinched["grasps"]), 0)
        for one in pinched["grasps"]:
            links = [contact["link"] for contact in one["contacts"]]
            self.assertEqual(len(links), len(set(links)))  # a tip each, and nothing else
            self.assertEqual(len(links), 4)
            self.assertTrue(one["certified"])
            self.assertGreater(one["arm_solutions"], 0)
        other = self.grasp("--tips", "--free-joints", "--trials", 60, "--count", 2, "--goal", "epsilon")
        self.assertGreater(len(other["grasps"]), 0)
        # Each goal is served best by its own optimisation, or as well.
        best = lambda document, what: max(one[what] for one in document["grasps"])
        self.assertGreaterEqual(best(other, "epsilon"), best(pinched, "epsilon"))
        self.assertLessEqual(best(other, "min_weight"), best(pinched, "min_weight"))

    def test_free_joints(self):
        free = self.grasp("--free-joints", "--trials", 192)
        self.assertEqual([group["name"] for group in free["groups"]], ["free joints"])
        self.assertTrue(free["grasps"])
        self.assertLessEqual({grasp["group"] for grasp in free["grasps"]}, set(self.groups))
        self.assertGreater(max(g["slack"] for g in free["grasps"]), 0.3)
        one = self.grasp("--free-joints", "--trials", 192, "--group", self.groups[0])
        self.assertEqual({grasp["group"] for grasp in one["grasps"]}, {self.groups[0]})

    def test_noise(self):
        group = self.plain["grasps"][0]["group"]
        base = self.grasp("--group", group, samples=40)["grasps"][0]["robust"]
        again = self.grasp("--group", group, samples=40)["grasps"][0]["robust"]
        self.assertEqual(base, again)
        for option, key, value in [("--noise-position", "position", 0.02), ("--noise-angle", "angle", 0.4),
                                   ("--noise-friction", "friction", 0.3)]:
            other = self.grasp("--group", group, option, value, samples=40)["grasps"][0]["robust"]
            self.assertEqual(other["noise"][key], value)
            self.assertNotEqual(other["epsilon_mean"], base["epsilon_mean"], option)
        self.assertIsNone(self.grasp("--group", group, samples=0)["grasps"][0]["robust"])

    def test_trials(self):
        self.assertEqual(self.grasp("--group", self.groups[0], "--trials", 70, "--count", 1000)["trials"], 70)
        self.refuse(2, ["--trials"], "--max-trials", 10)
        for option in ("--trials", "--max-trials"):
            got, _, err = run("grasp", "--store", self.store, option, 0)
            self.assertEqual(got, 2)
            self.assertIn(option, err)


class Import(Grasp):
    def take(self, content, *options, code=0, name="grasps.json"):
        file = content if isinstance(content, pathlib.Path) else self.write(name, content)
        return self.grasp("--import", file, *options, code=code)

    def assert_same(self, imported):
        self.assertEqual(len(imported["grasps"]), len(self.plain["grasps"]))
        self.assertEqual(imported["refused"], [])
        for old, new in zip(self.plain["grasps"], imported["grasps"]):
            self.assertEqual(new["origin"], "imported")
            self.assertEqual(new["joints"], old["joints"])
            for a, b in zip(new["X_OH"], old["X_OH"]):
                self.assertAlmostEqual(a, b, delta=1e-9)
            self.assertAlmostEqual(new["epsilon"], old["epsilon"], delta=1e-6)
            self.assertGreater(new["arm_solutions"], 0)

    def frogger(self, grasps):
        """The same grasps in FRoGGeR's form, joints in another order than the hand's, eight digits."""
        names = sorted(grasps[0]["joints"], reverse=True)
        return {"object": "box", "hand_joint_order": names, "handbase_frame": "palm_link of allegro_right_hand.urdf",
                "grasps": [{"hand_q": [round(one["joints"][name], 8) for name in names],
                            "X_object_handbase": [[round(value, 8) for value in one["X_OH"][row:row + 4]]
                                                  for row in (0, 4, 8, 12)]} for one in grasps]}

    def test_own_document(self):
        self.assert_same(self.take(self.plain))

    def test_own_export(self):
        out = self.root / "export.json"
        must("export", "--store", self.store, "--format", "json", "--out", out)
        exported = json.loads(out.read_text())
        order = [grasp["id"] for grasp in self.plain["grasps"]]
        documents = {one["id"]: one for one in exported.pop("grasps")}
        self.assert_same(self.take({"schema": exported["schema"], "grasps": [documents[id] for id in order]}))
        # The stored objects alone, as exports of before had them.
        keep = set(order) | {
            one["id"] for one in exported["objects"] if one["kind"] == "synergy_set"}
        exported["objects"] = [one for one in exported["objects"] if one["id"] in keep]
        exported["objects"].sort(key=lambda one: order.index(one["id"]) if one["id"] in order else -1)
        self.assert_same(self.take(exported))
        # Without the synergies the joints have no names: taken for the same robot, refused for another.
        exported["objects"] = [one for one in exported["objects"] if one["kind"] == "grasp"]
        self.assert_same(self.take(exported))
        for one in exported["objects"]:
            one["provenance"]["parameters"]["world"]["robot"] = "other.yaml"
        self.refuse(2, ["other.yaml", "synergy_set"], "--import", self.write("other.json", exported))

    def test_frogger(self):
        taken = self.take(self.frogger(self.plain["grasps"]))
        self.assertGreaterEqual(len(taken["grasps"]), 1)
        for one in taken["grasps"]:
            twin = min(self.plain["grasps"], key=lambda old: abs(old["epsilon"] - one["epsilon"]))
            for name, value in twin["joints"].items():
                self.assertAlmostEqual(one["joints"][name], value, delta=1e-7)

    def test_refused_ones_are_told(self):
        content = json.loads(json.dumps(self.plain))
        content["grasps"][0]["X_OH"][11] += 0.5  # away from the object
        taken = self.take(content)
        self.assertEqual(taken["refused"], [{"name": "grasp 0", "reason": "fewer than three contacts"}])
        self.assertEqual(len(taken["grasps"]), len(self.plain["grasps"]) - 1)
        content["grasps"] = content["grasps"][:1]
        file = self.write("away.json", content)
        said = self.refuse(1, ["grasp 0 refused: fewer than three contacts", "0 of 1 grasps"], "--import", file,
                           "--scene", "models/scenes/box_table.yaml")
        self.assertIn("100 %", said)

    def test_planned_with(self):
        store = self.root / "other"
        analysed_store(store, 3)
        scene = ("--scene", "models/scenes/box_table.yaml")
        must("grasp", "--store", store, *scene, "--import", self.write("planned.json", self.plain))
        self.assertEqual(must("verify", "--store", store)["failed"], [])
        run_ = must("plan", "--store", store, *scene)["runs"][0]
        self.assertEqual(run_["status"], "solved")

    def test_bad_files(self):
        def bad(words, content):
            self.refuse(2, words, "--scene", "models/scenes/box_table.yaml", "--import", self.write("bad.json", content))
        bad(["bad.json", "not JSON"], "{grasps: [")
        bad(["bad.json", "grasps"], {"something": 1})
        bad(["bad.json", "holds no grasps"], {"grasps": []})
        bad(["bad.json", "grasp 0", "X_OH"], {"grasps": [{"joints": {}}]})
        one = self.frogger(self.plain["grasps"][:1])
        bad(["joint thumb", "joint_0.0"], {**one, "hand_joint_order": ["thumb"] + one["hand_joint_order"][1:]})
        bad(["15 numbers for 16 joints"], {**one, "grasps": [{**one["grasps"][0], "hand_q": [0.0] * 15}]})
        bad(["base is 'hand'", "no link"], {**one, "handbase_frame": "hand of x.urdf"})
        bad(["link_3.0", "moves against the palm"], {**one, "handbase_frame": "link_3.0"})
        bad(["handbase_frame"], {key: value for key, value in one.items() if key != "handbase_frame"})
        skew = [[2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
        bad(["X_object_handbase", "rigid"], {**one, "grasps": [{**one["grasps"][0], "X_object_handbase": skew}]})
        bad(["X_object_handbase", "numbers"], {**one, "grasps": [{**one["grasps"][0], "X_object_handbase": "here"}]})
        self.refuse(2, ["nowhere.json"], "--import", self.root / "nowhere.json")

    def test_another_object_is_warned_about(self):
        file = self.write("teapot.json", {**self.plain, "object": "teapot"})
        got, _, err = run("grasp", "--store", self.store, "--scene", "models/scenes/box_table.yaml", "--import", file)
        self.assertEqual(got, 0)
        self.assertIn("teapot", err)


class Answers(Grasp):
    def test_wrong_unit(self):
        for size, words in [([60.0, 100.0, 80.0], ["60 x 100 x 80 m", "unit: mm"]), ([6e-5, 1e-4, 8e-5], ["0.0001", "(unit: m)"])]:
            def change(content, size=size):
                self.body(content, "box")["geometry"] = [{"box": {"size": size}}]
            self.refuse(2, ["box", *words], "--scene", self.scene("unit.yaml", change))

    def test_open_mesh(self):
        lines = ["v 0 0 0", "v 0.06 0 0", "v 0 0.06 0", "v 0 0 0.1", "f 1 3 2", "f 1 2 4", "f 1 4 3"]  # no fourth face
        self.write("open.obj", "\n".join(lines) + "\n")

        def change(content):
            self.body(content, "box")["geometry"] = [{"mesh": {"file": "open.obj"}}]
        self.refuse(2, ["box", "open.obj", "open", "opponens mesh"], "--scene", self.scene("open.yaml", change))

    def test_out_of_reach(self):
        def change(content):
            self.body(content, "box")["pose"]["xyz"] = [4.0, 0.0, 0.7]
        scene = self.scene("far.yaml", change)
        self.refuse(1, ["box is out of reach"], "--scene", scene)
        document = self.grasp("--scene", scene, code=1)
        self.assertIn("out of reach", document["answer"])
        self.assertEqual(document["trials"], 0)

        def nearer(content):  # beyond the arm, not beyond all doubt
            for body in content["bodies"]:
                body["pose"]["xyz"][0] += 0.65 if body["name"] in ("box", "table") else 0.0
        said = self.grasp("--scene", self.scene("far2.yaml", nearer), "--group", self.groups[0], code=1)
        self.assertIn("no grasp: ", said["answer"])
        self.assertIn("out of the arm's reach", said["answer"])

    def test_inside_an_obstacle(self):
        def change(content):
            self.body(content, "box")["pose"]["xyz"][2] -= 0.015
        self.refuse(2, ["box stands 15 mm deep in table"], "--scene", self.scene("sunk.yaml", change))

    def test_in_a_cage(self):
        """Nothing gets in: no room, and from outside fingers that do not get through."""
        def change(content):
            walls = [{"box": {"size": [0.3, 0.3, 0.01]}, "pose": {"xyz": [0, 0, 0.2]}}]
            for x, y in ((0.05, 0), (-0.05, 0), (0, 0.07), (0, -0.07)):
                size = [0.01, 0.3, 0.2] if x else [0.3, 0.01, 0.2]
                walls.append({"box": {"size": size}, "pose": {"xyz": [x, y, 0.101]}})
            content["bodies"].append({"name": "cage", "pose": self.body(content, "box")["pose"], "geometry": walls})
        document = self.grasp("--scene", self.scene("cage.yaml", change), "--group", self.groups[0], code=1)
        self.assertEqual(document["grasps"], [])
        advice = {cause["cause"]: cause["advice"] for cause in document["causes"]}
        self.assertIn("make room", advice["no room for the palm"])
        self.assertIn("no room for the palm", document["answer"])

    def test_no_friction(self):
        said = self.refuse(1, ["no grasp in 64 trials", "not force closure", "--mu 0"], "--mu", 0, "--group",
                           self.groups[0])
        self.assertIn("seven contacts", said)

    def test_groups(self):
        self.refuse(2, ["nobody", *self.groups], "--group", "nobody")
        self.refuse(2, ["teapot"], "--object", "teapot")
        empty = self.root / "still"
        analysed_store(empty, 3)

        def without_synergies(fields):
            for name in ("box_axes", "box_half_width"):
                key = f"grasp.000.{name}"
                value = fields[key][()]
                del fields[key]
                fields[key] = value[..., :0]
        forge(empty, "synergy_set", without_synergies)
        got, _, err = run("grasp", "--store", empty, "--group", self.groups[0], "--trials", TRIALS)
        self.assertEqual(got, 2, err)
        self.assertIn("has no synergies (dimension 0)", err)

    def test_hand_without_contact_points(self):
        text = re.sub(r"contact_points:\n(  - .*\n)+", "", HAND.read_text())
        text = text.replace("urdf: ", f"urdf: {HAND.parent}/")
        self.assertNotIn("contact_points", text)
        robot = (HAND.parent / "ur5_allegro_right.yaml").read_text()
        robot = robot.replace("  urdf: ", f"  urdf: {HAND.parent}/").replace(
            "hand: allegro_right.yaml", f"hand: {self.write('hand.yaml', text)}")
        self.refuse(2, ["contact_points", "--propose-contacts"], "--robot", self.write("robot.yaml", robot))


if __name__ == "__main__":
    unittest.main()
