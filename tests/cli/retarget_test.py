# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""retarget: the mappings, what they report and store, and what they refuse."""
import json
import pathlib
import shutil
import tempfile
import unittest

from support import HEADER, SHARED, SOURCE, data_set, forge, must, rows, run

SHADOW = SHARED / "data/robots/dex-urdf/robots/hands/shadow_hand/shadow_hand_right.urdf"


class Retarget(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.store = self.folder / "store"
        self.assertEqual(run("simulate", "--store", self.store, "--repetitions", 2, "--quiet")[0], 0)

    def retarget(self, *more):
        store = self.folder / "copy"
        shutil.rmtree(store, ignore_errors=True)
        shutil.copytree(self.store, store)
        return must("retarget", "--store", store, *more)

    def test_same_whatever_the_threads(self):
        one = self.retarget("--mapping", "fingertip", "--threads", 1)
        two = self.retarget("--mapping", "fingertip", "--threads", 2)
        self.assertEqual(one, two, "ids are hashes of all that is stored")
        self.assertEqual({tip["name"] for tip in one["tips"]}, {"index", "middle", "ring", "thumb"})
        self.assertLess(one["tip_residual_rms_m"], 0.02)
        self.assertEqual(len(one["clamped_share"]), 16)
        self.assertGreater(one["alignment"]["scale"], 1.0)
        paper = self.retarget("--mapping", "paper")
        self.assertGreater(paper["tip_residual_rms_m"], 2 * one["tip_residual_rms_m"])
        larger = self.retarget("--mapping", "fingertip", "--hand-length", 0.21)
        self.assertEqual(larger["alignment"], one["alignment"], "it belongs to the robot")
        self.assertNotEqual(larger["ids"], one["ids"])

    def test_refuses_what_has_no_effect(self):
        code, _, said = run("retarget", "--store", self.store, "--hand-length", 0.2)
        self.assertEqual(code, 2)
        self.assertIn("--hand-length", said)

    def test_an_unusable_recording_does_not_stop_the_others(self):
        before = len(self.retarget()["ids"])
        lacking = self.folder / "lacking"
        data_set(lacking, {"one": [HEADER.replace("I_PIP", "other"), *rows()]})
        source = self.folder / "source.yaml"
        text = (SOURCE / "models/sources/west_r2g.yaml").read_text()
        source.write_text("\n".join(line for line in text.splitlines() if "column: I_PIP" not in line) + "\nignore: [other]\n")
        must("ingest", lacking, "--source", source, "--store", self.store)
        code, out, said = run("retarget", "--store", self.store, "--json")
        self.assertEqual(code, 0, said)
        found = json.loads(out)
        self.assertEqual(len(found["ids"]), before)
        self.assertEqual(len(found["skipped"]), 1)
        self.assertIn("no channel 'I_PIP'", found["skipped"][0]["reason"])
        self.assertIn("skipped", said)
        alone = self.folder / "alone"
        must("ingest", lacking, "--source", source, "--store", alone)
        code, _, said = run("retarget", "--store", alone)
        self.assertEqual(code, 2)
        self.assertIn("no recording could be mapped", said)

    def test_an_error_on_any_thread_ends_the_command_in_words(self):
        def turn_back(fields):
            fields["time"][...] = fields["time"][...][::-1]

        forge(self.store, "demonstration", turn_back)
        code, _, said = run("retarget", "--store", self.store, "--threads", 2)
        self.assertGreater(code, 0, "ended by a signal")
        self.assertIn("time does not increase", said)

    def test_a_hand_without_its_urdf_says_so(self):
        code, _, said = run("retarget", "--store", self.store, "--hand", "models/shadow_hand/shadow_right.yaml",
                            env={"DEX_URDF": "/nowhere"})
        self.assertEqual(code, 2)
        self.assertIn("/nowhere/robots/hands/shadow_hand/shadow_hand_right.urdf: cannot be opened", said)

    @unittest.skipUnless(SHADOW.exists(), f"{SHADOW} is absent")
    def test_another_hand_from_its_own_urdf(self):
        found = self.retarget("--hand", "models/shadow_hand/shadow_right.yaml", "--urdf", SHADOW, "--mapping", "joint")
        self.assertEqual(len(found["tips"]), 5)
        self.assertEqual(len(found["clamped_share"]), 22)


if __name__ == "__main__":
    unittest.main()
