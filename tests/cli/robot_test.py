# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""opponens robot: what it says of every robot that we know, and what it makes of a URDF alone."""
import pathlib
import re
import tempfile
import unittest
import xml.dom.minidom

from support import SHARED, SOURCE, must, run

ROBOTS = SHARED / "data/robots"
ENVIRONMENT = {"OPPONENS_SHARED_DATA": str(SHARED), "DEX_URDF": str(ROBOTS / "dex-urdf")}
LAYOUT = {"index": 4, "middle": 4, "ring": 4, "thumb": 3, "palm": 3}

# file -> joints of arm and hand, contact points per finger
OURS = {"models/ur5_allegro/ur5_allegro_right.yaml": (6, 16, LAYOUT),
        "models/ur5_allegro/allegro_right.yaml": (0, 16, LAYOUT),
        "models/human_hand/human_hand.yaml": (0, 23, {**LAYOUT, "little": 4})}
REAL = {**{f"tests/data/robots/{name}.yaml": (6, 16, LAYOUT) for name in (
    "paper_lab_ur5_allegro_right_urdf", "paper_lab_ur5_allegro_right_visual", "paper_lab_ur5_allegro_left_urdf",
    "paper_lab_ur5_allegro_left_visual", "example_ur5_allegro_right", "example_ur5_allegro_left",
    "ur5_dex_allegro_right", "ur5_dex_allegro_left")},
    **{f"tests/data/robots/{name}.yaml": (0, 16, LAYOUT) for name in (
        "dex_allegro_right", "dex_allegro_left", "example_allegro_right", "example_allegro_left")},
    "models/shadow_hand/shadow_right.yaml": (0, 22, {**LAYOUT, "little": 4}),
    "tests/data/robots/ur5_shadow_right.yaml": (6, 22, {**LAYOUT, "little": 4}),
    "models/barrett_hand/barrett_right.yaml": (0, 8, {"index": 4, "middle": 4, "thumb": 3, "palm": 3}),
    "tests/data/robots/ur5_barrett_right.yaml": (6, 8, {"index": 4, "middle": 4, "thumb": 3, "palm": 3})}


def per_finger(points):
    fingers = [point["finger"] for point in points]
    return {finger: fingers.count(finger) for finger in fingers}


class Robots(unittest.TestCase):
    def check(self, file, arm, hand, contacts, **options):
        found = must("robot", file, "--samples", 60, **options)
        groups = {group["name"]: group["joints"] for group in found["groups"]}
        self.assertEqual([len(groups["arm"]), len(groups["hand"])], [arm, hand])
        moving = [joint for joint in found["joints"] if joint["group"]]
        self.assertEqual(len(moving), arm + hand)
        for joint in moving:
            self.assertLess(joint["lower"], joint["upper"], joint["name"])
            self.assertGreater(joint["velocity"], 0)
        self.assertEqual(per_finger(found["contact_points"]), contacts)
        self.assertEqual({tip["finger"] for tip in found["tips"]}, set(contacts) - {"palm"})
        self.assertEqual(found["missing_meshes"], [])
        self.assertGreater(sum(link["triangles"] + link["boxes"] + link["cylinders"] + link["spheres"]
                               for link in found["links"]), 10)
        collision = found["self_collision"]
        self.assertEqual(collision["samples"], 60)
        self.assertLessEqual(collision["interval"][0], collision["share"])
        self.assertLessEqual(collision["share"], collision["interval"][1])
        self.assertLess(collision["share"], 1, "a robot that always collides with itself cannot plan")
        self.assertEqual(collision["suggested"]["always"], [])
        return found

    def test_ours(self):
        for file, expected in OURS.items():
            with self.subTest(file=file):
                self.check(file, *expected)

    @unittest.skipUnless(ROBOTS.exists(), f"no {ROBOTS}")
    def test_real(self):
        for file, expected in REAL.items():
            with self.subTest(file=file):
                self.check(file, *expected, env=ENVIRONMENT)

    def test_words(self):
        code, out, err = run("robot", "models/ur5_allegro/ur5_allegro_right.yaml", "--samples", 50)
        self.assertEqual((code, err), (0, ""))
        for words in ("Arm: 6 joints, ends at tool0", "Hand: 16 joints, palm palm_link", "shoulder_pan_joint",
                      "Joints that move: 22", "index 4, middle 4, ring 4, thumb 3, palm 3",
                      "of 50 random configurations (95 % interval", "with 95 % confidence a pair does in at most 5.82 %"):
            self.assertIn(words, out)
        self.assertEqual(run("robot", "models/ur5_allegro/ur5_allegro_right.yaml", "--samples", 50)[1], out)

    def test_samples_and_seed_count(self):
        one, two = (must("robot", "models/human_hand/human_hand.yaml", "--samples", 80, "--seed", seed)["self_collision"]
                    for seed in (1, 2))
        self.assertNotEqual([pair["share"] for pair in one["pairs"]], [pair["share"] for pair in two["pairs"]])
        self.assertIsNone(must("robot", "models/human_hand/human_hand.yaml", "--samples", 0)["self_collision"])


class Urdf(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def skeleton(self, urdf, *more, name="hand.yaml"):
        code, out, err = run("robot", urdf, "--skeleton", "--samples", 50, *more)
        self.assertEqual((code, err), (0, ""))
        file = self.folder / name
        file.write_text(out)
        return file

    def test_skeleton_is_a_hand_file(self):
        file = self.skeleton("models/ur5_allegro/allegro_right.urdf")
        found = must("robot", file, "--samples", 50)
        self.assertEqual(per_finger(found["contact_points"]), LAYOUT)
        store = self.folder / "store"
        must("simulate", "--store", store, "--repetitions", 2)
        mapped = must("retarget", "--store", store, "--hand", file)
        self.assertEqual({tip["name"] for tip in mapped["tips"]}, {"index", "middle", "ring", "thumb"})

    @unittest.skipUnless(ROBOTS.exists(), f"no {ROBOTS}")
    def test_skeletons_of_real_hands_retarget(self):
        store = self.folder / "store"
        must("simulate", "--store", store, "--repetitions", 2)
        hands = ROBOTS / "dex-urdf/robots/hands"
        for urdf in (hands / "shadow_hand/shadow_hand_right.urdf", hands / "barrett_hand/bhand_model.urdf",
                     hands / "allegro_hand/allegro_hand_right.urdf"):
            with self.subTest(urdf=urdf.name):
                file = self.skeleton(urdf)
                must("robot", file, "--samples", 20)
                must("retarget", "--store", store, "--hand", file)

    def test_points_and_pairs_can_be_pasted(self):
        hand = self.folder / "hand.yaml"
        urdf = SOURCE / "models/ur5_allegro/allegro_right.urdf"
        start = f"urdf: {urdf}\npalm_link: palm_link\njoints: [{', '.join(f'joint_{i}.0' for i in range(16))}]\n"
        hand.write_text(start)
        code, points, err = run("robot", hand, "--propose-contacts")
        self.assertEqual((code, err), (0, ""))
        code, pairs, err = run("robot", hand, "--allowed-collisions", "--samples", 200)
        self.assertEqual((code, err), (0, ""))
        before = must("robot", hand, "--samples", 200)
        hand.write_text(start + points + pairs)
        after = must("robot", hand, "--samples", 200)
        self.assertEqual(per_finger(after["contact_points"]), LAYOUT)
        self.assertEqual(len(after["tips"]), 4)
        suggested = before["self_collision"]["suggested"]
        self.assertTrue(suggested["never"])
        self.assertEqual(after["self_collision"]["suggested"]["never"], [])
        allowed = {frozenset(pair["links"]) for pair in after["self_collision"]["pairs"] if pair["allowed"]}
        self.assertLessEqual({frozenset(pair) for pair in suggested["default"]}, allowed)

    def test_an_arm_alone(self):
        found = must("robot", "models/ur5_allegro/ur5.urdf", "--samples", 20)
        groups = {group["name"]: group["joints"] for group in found["groups"]}
        self.assertEqual((len(groups["arm"]), groups["hand"]), (6, []))
        self.assertTrue(any("there is no hand" in note for note in found["notes"]))

    def test_all_missing_meshes_are_listed(self):
        urdf = self.folder / "robot.urdf"
        text = (SOURCE / "models/ur5_allegro/allegro_right.urdf").read_text()
        for gone in ("one.stl", "two.stl", "package://nowhere/three.stl"):
            text = text.replace("<geometry>\n", "<geometry>", 1)
            text = re.sub(r"<(box|cylinder|sphere) [^>]*/>", f'<mesh filename="{gone}"/>', text, count=1)
        urdf.write_text(text)
        found = must("robot", urdf, "--samples", 20, code=1)
        self.assertEqual([missing["mesh"] for missing in found["missing_meshes"]],
                         ["one.stl", "two.stl", "package://nowhere/three.stl"])
        code, out, _ = run("robot", urdf, "--samples", 20)
        self.assertEqual(code, 1)
        self.assertIn("Missing meshes: 3; other commands refuse this robot", out)
        self.assertIn("without the missing meshes", out)

    def test_picture(self):
        picture = self.folder / "robot.svg"
        must("robot", "models/ur5_allegro/ur5_allegro_right.yaml", "--samples", 0, "--picture", picture)
        text = picture.read_text()
        xml.dom.minidom.parseString(text)
        for name in ("shoulder_pan_joint", "joint_15.0", "thumb_tip", "palm_3"):
            self.assertEqual(text.count(f">{name}<"), 1, name)
        again = self.folder / "again.svg"
        must("robot", "models/ur5_allegro/ur5_allegro_right.yaml", "--samples", 0, "--picture", again)
        self.assertEqual(again.read_text(), text)
        bare = self.folder / "bare.svg"
        must("robot", "models/ur5_allegro/allegro_right.urdf", "--propose-contacts", "--picture", bare)
        self.assertIn(">palm_3<", bare.read_text(), "the proposed points are drawn")

    def refuse(self, words, *arguments):
        code, out, err = run("robot", *arguments)
        self.assertEqual((code, out), (2, ""), err)
        self.assertEqual(len(err.strip().splitlines()), 1, err)
        for word in words:
            self.assertIn(word, err)

    def test_wrong_use(self):
        model = "models/ur5_allegro/ur5_allegro_right.yaml"
        self.refuse(["--skeleton", "YAML"], model, "--skeleton")
        self.refuse(["--packages", "key packages"], model, "--packages", self.folder)
        self.refuse(["--samples 0"], model, "--allowed-collisions", "--samples", 0)
        self.refuse(["nowhere.urdf"], "nowhere.urdf")
        self.refuse(["cannot write"], model, "--samples", 0, "--picture", self.folder / "no/such/folder.svg")
        self.refuse(["neither a robot.yaml"], "models/scenes/box_table.yaml")
        self.refuse(["directory"], self.folder)
        (self.folder / "robot.xacro").write_text("<robot/>")
        self.refuse(["robot.xacro", "xacro"], self.folder / "robot.xacro")


if __name__ == "__main__":
    unittest.main()
