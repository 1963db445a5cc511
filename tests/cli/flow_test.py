# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""The whole flow through the command line, small: twice, byte-identical, whatever the thread count; the documents of
docs/cli.md; the chain of `why`; h5py reads what was stored."""
import json
import math
import pathlib
import re
import shutil
import tempfile
import unittest
from html.parser import HTMLParser

import h5py

from support import HEADER, SOURCE, data_set, must, rows, run, snapshot, without_run_log

SCENE = "models/scenes/cylinder_shelf.yaml"


def flow(folder, threads, seed=3):
    """Runs every stage; returns the documents by command."""
    store = folder / "store"
    documents = {
        "simulate": must("simulate", "--store", store, "--repetitions", 3, "--seed", seed),
        "retarget": must("retarget", "--store", store),
        "analyze": must("analyze", "--store", store, "--seed", seed),
    }
    world = ("--store", store, "--scene", SCENE, "--seed", seed, "--threads", threads)
    documents["grasp"] = must("grasp", *world, "--count", 2, "--max-trials", 400)
    documents["plan"] = must("plan", *world, "--runs", 2)
    documents["verify"] = must("verify", "--store", store)
    must("report", "--store", store, "--out", folder / "report.html")
    return documents


class Pipeline(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        root = pathlib.Path(cls.folder.name)
        cls.one, cls.two = root / "one", root / "two"
        cls.documents = flow(cls.one, 1)
        cls.again = flow(cls.two, 2)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_equal_seeds_give_equal_bytes_at_any_thread_count(self):
        first, second = snapshot(self.one / "store"), snapshot(self.two / "store")
        self.assertGreater(len(first), 4)
        self.assertEqual(first, second)
        pages = [without_run_log((folder / "report.html").read_text()) for folder in (self.one, self.two)]
        self.assertEqual(*pages)

    def test_another_seed_gives_other_bytes(self):
        with tempfile.TemporaryDirectory() as folder:
            store = pathlib.Path(folder) / "store"
            must("simulate", "--store", store, "--repetitions", 3, "--seed", 4)
            self.assertFalse(set(snapshot(store).values()) & set(snapshot(self.one / "store").values()))

    def test_documents_hold_the_contract(self):
        groups = self.documents["analyze"]["groups"]
        self.assertEqual([group["name"] for group in groups], ["pre-grasp", "1", "2", "3", "4"])
        for group in groups:
            self.assertLessEqual({"name", "phase", "samples", "dof_effective", "dropped_channels", "cumulative_variance",
                                  "k", "half_width", "coverage"}, set(group))
            self.assertLessEqual({"in_sample", "held_out", "interval", "nominal"}, set(group["coverage"]))
            self.assertEqual(len(group["half_width"]), group["k"])
            self.assertAlmostEqual(group["cumulative_variance"][-1], 1.0, places=12)
        for transition in self.documents["analyze"]["transitions"]:
            self.assertLessEqual({"demonstration", "index", "time_s", "fraction", "method"}, set(transition))
        grasp = self.documents["grasp"]
        self.assertLessEqual({"grasps", "trials", "evaluations", "cpu_seconds", "rejected"}, set(grasp))
        for one in grasp["grasps"]:
            self.assertTrue(one["force_closure"])
            self.assertGreater(one["epsilon"], 0.0)
            self.assertIsNone(one["certified"])
            self.assertEqual(len(one["X_OH"]), 16)
            self.assertEqual(set(one["joints"]), set(one["pregrasp"]))
            for contact in one["contacts"]:
                self.assertAlmostEqual(math.hypot(*contact["n"]), 1.0, places=9)
        plan = self.documents["plan"]
        self.assertEqual([one["seed"] for one in plan["runs"]], [3, 4])
        for one in plan["runs"]:
            self.assertEqual(one["status"], "solved")
            self.assertTrue(0.0 < one["human_likeness"] <= 100.0)
            self.assertIn("simulated", one["human_likeness_reference"])
            self.assertGreater(one["collision_checks"], 0)
        times = plan["path"]["times"]
        self.assertTrue(all(a < b for a, b in zip(times, times[1:])))
        self.assertEqual(len(plan["path"]["waypoints"]), len(times))
        verify = self.documents["verify"]
        self.assertEqual(verify["failed"], [])
        self.assertGreater(verify["checked"], 4)
        self.assertGreater(verify["worst_clearance_m"], 0.0)

    def test_both_planners_answer(self):
        with tempfile.TemporaryDirectory() as folder:
            store = pathlib.Path(folder) / "store"
            shutil.copytree(self.two / "store", store)
            document = must("plan", "--store", store, "--scene", SCENE, "--planner", "rrtconnect")
            self.assertEqual(document["runs"][0]["status"], "solved")
            self.assertEqual(must("verify", "--store", store)["failed"], [])

    def test_why_leads_back_to_the_recordings(self):
        path = self.documents["plan"]["ids"][0]
        chain = must("why", path, "--store", self.one / "store")["chain"]
        kinds = [item["kind"] for item in chain]
        self.assertEqual(kinds[0], "path")
        for kind in ("grasp", "synergy_set", "hand_demonstration", "demonstration"):
            self.assertIn(kind, kinds)
        self.assertEqual(kinds.count("demonstration"), kinds.count("hand_demonstration"))

    def test_h5py_reads_the_store(self):
        kinds = set()
        for file in (self.one / "store").glob("*.h5"):
            with h5py.File(file, "r") as handle:
                handle.visititems(lambda name, item: kinds.add(item.attrs["kind"]) if "kind" in item.attrs else None)
        kinds = {kind.decode() if isinstance(kind, bytes) else str(kind) for kind in kinds}
        self.assertLessEqual({"demonstration", "hand_demonstration", "synergy_set", "grasp", "path"}, kinds)

    def test_the_report_is_whole(self):
        page = (self.one / "report.html").read_text()
        stack = []

        class Balance(HTMLParser):
            VOID = {"meta", "br", "hr", "img", "link", "input", "line", "circle", "rect", "polyline", "path", "use"}

            def handle_starttag(self, tag, attrs):
                if tag not in self.VOID:
                    stack.append(tag)

            def handle_endtag(self, tag):
                if tag not in self.VOID:
                    assert stack.pop() == tag, tag

        Balance().feed(page)
        self.assertEqual(stack, [])
        self.assertIn("SIMULATED", page.upper())
        for word in ("nan", "inf", "null"):
            self.assertNotIn(f">{word}<", page)
        self.assertNotIn("http://", page.replace("http://www.w3.org", ""))

    def test_the_report_tells_the_residual_that_retarget_told(self):
        told = re.search(r"distance of the fingertips[^:]*: ([0-9.]+) mm", (self.one / "report.html").read_text()).group(1)
        self.assertEqual(told, f"{1e3 * self.documents['retarget']['tip_residual_rms_m']:.1f}")

    def test_progress_and_text_stay_off_a_json_stdout(self):
        code, out, err = run("show", "--store", self.one / "store", "--json")
        self.assertEqual(code, 0)
        self.assertEqual(err, "")
        json.loads(out)

    def test_what_is_made_again_is_the_newest_again(self):
        """Identical objects are not written again, yet the command that made them last decides."""
        with tempfile.TemporaryDirectory() as folder:
            store, page = pathlib.Path(folder) / "store", pathlib.Path(folder) / "report.html"
            shutil.copytree(self.one / "store", store)
            before = (self.one / "report.html").read_text()
            must("analyze", "--store", store, "--seed", 3, "--transition", "changepoint")
            code, _, err = run("plan", "--store", store, "--scene", SCENE)
            self.assertEqual(code, 2)
            self.assertIn("opponens grasp", err)
            must("report", "--store", store, "--out", page)
            self.assertIn("path length</th><td>not available", page.read_text())  # those there are of other synergies
            must("analyze", "--store", store, "--seed", 3)
            must("plan", "--store", store, "--scene", SCENE, "--seed", 4)
            must("report", "--store", store, "--out", page)
            self.assertEqual(without_run_log(page.read_text()), without_run_log(before))
            # Another hand in between, with other limits, outside the data folder.
            shutil.copytree(SOURCE / "models/ur5_allegro", pathlib.Path(folder) / "hand")
            urdf = pathlib.Path(folder) / "hand" / "allegro_right.urdf"
            urdf.write_text(urdf.read_text().replace('upper="1.61', 'upper="1.51'))
            objects = snapshot(store)
            must("retarget", "--store", store, "--hand", urdf.with_suffix(".yaml"))
            self.assertNotEqual(snapshot(store), objects)
            must("retarget", "--store", store)
            objects = snapshot(store)
            must("analyze", "--store", store, "--seed", 3)
            self.assertEqual(snapshot(store), objects)

    def test_verify_again_is_the_same_object(self):
        with tempfile.TemporaryDirectory() as folder:
            store = pathlib.Path(folder) / "store"
            shutil.copytree(self.one / "store", store)
            before = snapshot(store)
            self.assertEqual(must("verify", "--store", store)["checked"], self.documents["verify"]["checked"])
            self.assertEqual(snapshot(store), before)

    def test_a_world_is_its_files_not_their_paths(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder).resolve()
            store, scene = folder / "store", folder / "scenes" / "shelf.yaml"
            shutil.copytree(self.one / "store", store)
            scene.parent.mkdir()
            shutil.copy(SOURCE / SCENE, scene)
            # The same bytes under another name: the grasps are found. From there, by a relative path, a grasp is made.
            must("plan", "--store", store, "--scene", scene)
            must("grasp", "--store", "../store", "--scene", "shelf.yaml", "--group", "1", "--count", 1, "--max-trials", 400,
                 "--seed", 5, cwd=scene.parent)
            must("plan", "--store", store, "--scene", "scenes/../scenes/shelf.yaml", cwd=folder)
            self.assertEqual(must("verify", "--store", store, cwd="/")["failed"], [])
            # Other bytes are another scene, whatever the name.
            scene.write_text(scene.read_text() + "\n# moved\n")
            code, _, err = run("plan", "--store", store, "--scene", scene)
            self.assertEqual(code, 2, err)


class Recordings(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        self.store = self.root / "store"
        self.data = data_set(self.root / "data", {"a": [HEADER, *rows()], "b": [HEADER, *rows(rate=90.0)]})

    def tearDown(self):
        self.folder.cleanup()

    def ingest(self, folder, addition=""):
        source = self.root / folder / "source.yaml"
        source.parent.mkdir(exist_ok=True)
        source.write_text((SOURCE / "models/sources/west_r2g.yaml").read_text() + addition)
        return must("ingest", self.data, "--store", self.store, "--source", source)["ids"]

    def object(self, identity):
        return must("show", identity, "--store", self.store)["object"]

    def test_the_path_of_the_source_does_not_matter_and_an_edited_one_supersedes(self):
        first = self.ingest("one")
        self.assertEqual(self.ingest("two"), first)
        self.assertEqual(set(self.object(first[0])["provenance"]["files"]), {"a.csv", "index.csv", "source.yaml"})
        second = self.ingest("two", "\n# edited\n")
        self.assertFalse(set(second) & set(first))
        code, out, err = run("retarget", "--store", self.store)
        self.assertEqual(code, 0, err)
        self.assertIn("2 recordings are superseded", out)
        self.assertIn("mapped 2 recordings", out)
        motions = must("retarget", "--store", self.store)["ids"]
        self.assertEqual([self.object(motion)["provenance"]["inputs"][0] for motion in motions], second)
        # Ingested again, the first ones are the newest.
        self.assertEqual(self.ingest("one"), first)
        motions = must("retarget", "--store", self.store)["ids"]
        self.assertEqual([self.object(motion)["provenance"]["inputs"][0] for motion in motions], first)

    def test_recorded_and_simulated_motions_are_told_apart(self):
        page = self.root / "report.html"
        self.ingest("one")
        must("report", "--store", self.store, "--out", page)
        self.assertIn("<p>Recorded from people.</p>", page.read_text())
        must("simulate", "--store", self.store, "--repetitions", 2)
        must("report", "--store", self.store, "--out", page)
        self.assertIn("<p>2 recorded from people, 36 made by opponens simulate", page.read_text())
        self.assertNotIn("no human was recorded", page.read_text())

    def test_a_mapped_motion_names_all_that_it_was_made_from(self):
        recordings = self.ingest("one")
        for recording, motion in zip(recordings, must("retarget", "--store", self.store)["ids"]):
            origin = self.object(motion)["provenance"]
            # Calibrated by the ranges of all recordings of the subject; its own recording comes first.
            self.assertEqual(origin["inputs"][0], recording)
            self.assertEqual(set(origin["inputs"]), set(recordings))
            self.assertLessEqual({"models/ur5_allegro/allegro_right.urdf", "models/ur5_allegro/allegro_right.yaml",
                                  "models/human_hand/human_hand.urdf", "models/human_hand/human_hand.yaml"},
                                 set(origin["files"]))


if __name__ == "__main__":
    unittest.main()
