# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""The flow on real input: the West and Hogan glove recordings, and the paper laboratory's UR5 + Allegro with its visual
meshes (268,000 triangles), from ingest to verify."""
import os
import pathlib
import sys
import tempfile
import unittest

from support import SHARED, SOURCE, must

RECORDINGS = SHARED / "data/demos/west_r2g"
ROBOTS = SOURCE / "tests/data/robots"
# Names of the laboratory's joints. Its shoulder pan is zero 45 degrees away from ours.
JOINTS = {"shoulder_pan_joint: -0.1": "ShoulderPanJoint: -0.885398", "shoulder_lift_joint": "ShoulderLiftJoint",
          "elbow_joint": "ElbowJoint", "wrist_1_joint": "Wrist1Joint", "wrist_2_joint": "Wrist2Joint",
          "wrist_3_joint": "Wrist3Joint"}


def laboratory_scene(folder):
    text = (SOURCE / "models/scenes/bottle_shelf.yaml").read_text()
    for ours, theirs in JOINTS.items():
        assert ours in text, ours
        text = text.replace(ours, theirs)
    scene = pathlib.Path(folder) / "bottle_shelf.yaml"
    scene.write_text(text)
    return scene


class RealData(unittest.TestCase):
    def test_from_ingest_to_verify(self):
        with tempfile.TemporaryDirectory() as folder:
            store = pathlib.Path(folder) / "store"
            shared = {"OPPONENS_SHARED_DATA": str(SHARED)}
            ingested = must("ingest", RECORDINGS, "--store", store, "--source", "models/sources/west_r2g.yaml")
            self.assertEqual(ingested["summary"]["recordings"], 100)
            must("retarget", "--store", store, "--hand", ROBOTS / "paper_lab_allegro_right.yaml", env=shared)
            analysis = must("analyze", "--store", store, "--group-by", "object")
            self.assertEqual(len(analysis["groups"]), 6)
            self.assertEqual(len(analysis["transitions"]), 200)
            world = ("--store", store, "--robot", ROBOTS / "paper_lab_ur5_allegro_right_visual.yaml",
                     "--scene", laboratory_scene(folder))
            grasps = must("grasp", *world, "--count", 2, "--max-trials", 320, env=shared)["grasps"]
            self.assertGreater(len(grasps), 0)
            plan = must("plan", *world, env=shared)
            self.assertEqual(plan["runs"][0]["status"], "solved")
            self.assertIsNone(plan["runs"][0]["human_likeness"])  # there are no free motions among these recordings
            verdict = must("verify", "--store", store, env=shared)
            self.assertEqual(verdict["failed"], [])
            must("report", "--store", store, "--out", pathlib.Path(folder) / "report.html", env=shared)


if __name__ == "__main__":
    if not RECORDINGS.exists():
        print(f"skipped: {RECORDINGS} is absent (set OPPONENS_SHARED_DATA)")
        sys.exit(77)
    os.environ["OPPONENS_SHARED_DATA"] = str(SHARED)
    unittest.main()
