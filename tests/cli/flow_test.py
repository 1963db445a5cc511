# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""The whole flow through the command line, small: twice, byte-identical, whatever the thread count; the documents of
docs/cli.md; the chain of `why`; h5py reads what was stored."""
import json
import math
import pathlib
import re
import shutil
import signal
import tempfile
import time
import unittest
from html.parser import HTMLParser

import h5py

from support import (HEADER, SOURCE, data_set, forge, must, rows, run, snapshot, start, wait_for_cpu_time, without_run_log,
                     written_since)

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
            self.assertIn(one["certified"], (True, False))
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
        certified = sum(one["certified"] for one in grasp["grasps"])
        self.assertEqual(verify["certificates"], certified)
        self.assertEqual(verify["without_certificate"], len(grasp["grasps"]) - certified)
        self.assertGreater(verify["worst_clearance_m"], 0.0)
        self.assertIn(" and ", verify["worst_pair"])
        self.assertRegex(verify["worst_place"], r"waypoint.* of path [0-9a-f]{12}$")
        self.assertLessEqual(verify["clearance_m"], verify["proven_clearance_m"])
        self.assertLessEqual(verify["proven_clearance_m"], verify["worst_clearance_m"])
        self.assertGreaterEqual(verify["proven_contact_penetration_m"], verify["worst_contact_penetration_m"])
        self.assertLessEqual(verify["proven_contact_penetration_m"], verify["max_penetration_m"])

    def test_both_planners_answer(self):
        with tempfile.TemporaryDirectory() as folder:
            store = pathlib.Path(folder) / "store"
            shutil.copytree(self.two / "store", store)
            document = must("plan", "--store", store, "--scene", SCENE, "--planner", "rrtconnect")
            self.assertEqual(document["runs"][0]["status"], "solved")
            self.assertEqual(must("verify", "--store", store)["failed"], [])

    def copied(self, folder):
        store = pathlib.Path(folder) / "store"
        shutil.copytree(self.two / "store", store)
        return store

    def test_a_coarsely_planned_path_is_proven_all_the_same(self):
        with tempfile.TemporaryDirectory() as folder:
            store = self.copied(folder)
            must("plan", "--store", store, "--scene", SCENE, "--resolution", 1.0, "--runs", 10)
            self.assertEqual(must("verify", "--store", store)["failed"], [])
            # Nor does verify accept whatever it is given: of twice the clearance that is planned for, it is not true.
            document = must("verify", "--store", store, "--clearance", 0.0012, code=1)
            for one in document["failed"]:
                self.assertRegex(one["reason"], "mm apart")

    def test_every_run_is_recorded_the_failed_ones_too(self):
        with tempfile.TemporaryDirectory() as folder:
            store = self.copied(folder)
            world = ("--store", store, "--scene", SCENE, "--runs", 50)  # shares are whole percents: no tie to round
            for limit in (100, 60, 150):  # asked once a pass: some runs end within it, some do not
                code, out, err = run("plan", *world, "--planner", "rrtconnect", "--max-checks", limit, "--json")
                self.assertIn(code, (0, 1), err)
                limited = json.loads(out)
                statuses = [one["status"] for one in limited["runs"]]
                if len(set(statuses)) == 2:
                    break
            self.assertEqual(code, 1)
            self.assertEqual(set(statuses), {"solved", "check_limit"})
            record = must("show", limited["plan_runs"], "--store", store)["object"]
            self.assertEqual(record["kind"], "plan_runs")
            runs = json.loads(record["fields"]["runs"])
            self.assertEqual([one["status"] for one in runs], statuses)
            self.assertEqual([one["path"] for one in runs if one["path"]], limited["ids"])
            self.assertFalse(any("seconds" in key for one in runs for key in one))
            page = store.parent / "report.html"
            must("report", "--store", store, "--out", page)
            text = page.read_text()
            share = f"{100 * statuses.count('solved') / 50:.0f} %"
            row = text[text.index("here, rrtconnect (50 runs"):]
            self.assertIn(share, row[:row.index("</tr>")])
            self.assertIn("here, synergy (2 runs, step 0.4 rad, resolution 0.02 rad)", text)
            self.assertIn(limited["ids"][-1], text)  # the newest path is the one that is shown
            log = (store / "runs.jsonl").read_text().splitlines()
            seconds = [json.loads(line) for line in log if "planner_cpu_seconds" in line][-1]
            self.assertEqual(seconds["planner"], "rrtconnect")
            self.assertEqual(len(seconds["planner_cpu_seconds"]), 50)
            mean = sum(seconds["planner_cpu_seconds"]) / 50
            self.assertIn(f"rrtconnect: {mean:.3f} s of CPU per run", text)

    def test_an_interrupted_plan_keeps_its_finished_runs(self):
        with tempfile.TemporaryDirectory() as folder:
            store = self.copied(folder)
            before = {one["id"] for one in must("show", "--store", store)["objects"]}
            program = start("plan", "--store", store, "--scene", SCENE, "--runs", 100000, "--seed", 100, "--threads", 2)
            wait_for_cpu_time(program, seconds=10)  # setting up the worlds takes 2 to 3, a run some ms
            program.send_signal(signal.SIGINT)
            _, err = program.communicate(timeout=120)
            self.assertEqual(program.returncode, 130, err)
            self.assertIn("finished is kept", err)
            new = [one for one in must("show", "--store", store)["objects"] if one["id"] not in before]
            kept = [one["id"] for one in new if one["kind"] == "path"]
            self.assertTrue(kept)
            record = must("show", [one["id"] for one in new if one["kind"] == "plan_runs"][0], "--store", store)
            runs = json.loads(record["object"]["fields"]["runs"])
            self.assertEqual([one["path"] for one in runs if one["path"]], kept)
            self.assertNotIn("interrupted", {one["status"] for one in runs})

    def test_goals_that_the_hand_cannot_close_from_are_left_out(self):
        def close_further(fields):
            fields["q_grasp"][...] += 0.5 * (fields["q_grasp"][...] - fields["q_pregrasp"][...])

        with tempfile.TemporaryDirectory() as folder:
            store = self.copied(folder)
            forge(store, "grasp", close_further)
            code, out, err = run("plan", "--store", store, "--scene", SCENE, "--json")
            self.assertEqual(code, 1, err)
            document = json.loads(out)
            self.assertEqual(document["runs"][0]["status"], "no_goals")
            self.assertIn("none has a valid closing segment", document["runs"][0]["detail"])
            self.assertIn("goals left out", document["warnings"][-1])
            self.assertIn("goals left out", err)

    def test_a_grasp_that_the_arm_does_not_reach_fails(self):
        def turn_the_arm(fields):
            fields["arm.q_grasp"][:, 0] += 0.01

        with tempfile.TemporaryDirectory() as folder:
            store = self.copied(folder)
            forge(store, "grasp", turn_the_arm)
            failed = must("verify", "--store", store, code=1)["failed"]
            kinds = {one["id"]: one["kind"] for one in must("show", "--store", store)["objects"]}
            self.assertEqual({kinds[one["id"]] for one in failed}, {"grasp", "path"})
            for one in failed:  # the paths were made from the grasps as they were
                self.assertIn("palm" if kinds[one["id"]] == "grasp" else "which is not in the store", one["reason"])

    def test_an_open_mesh_is_told(self):
        with tempfile.TemporaryDirectory() as folder:
            store = self.copied(folder)
            scene = pathlib.Path(folder) / SCENE
            scene.parent.mkdir(parents=True)
            (scene.parent / "sheet.obj").write_text("v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nf 1 2 3\n")
            scene.write_text((SOURCE / SCENE).read_text() + "  - name: sheet\n    pose: {xyz: [2, 2, 2]}\n    geometry:\n"
                             "      - mesh: {file: sheet.obj, unit: m}\n")
            for command, *options in (("grasp", "--group", 4, "--count", 1, "--min-trials", 64), ("plan",)):
                arguments = (command, "--store", store, "--scene", scene, *options, "--json")
                code, out, err = run(*arguments)
                self.assertEqual(code, 0, err)
                self.assertTrue(any("sheet: its mesh is open" in one for one in json.loads(out)["warnings"]))
                self.assertIn("note: sheet: its mesh is open", err)
            code, out, err = run(*arguments, "--quiet")
            self.assertEqual(code, 0, err)
            self.assertEqual(err, "")

    def test_a_plan_with_a_wrong_robot_is_refused_on_every_thread(self):
        # Not by an exception that ends the program on a worker thread.
        with tempfile.TemporaryDirectory() as folder:
            store = self.copied(folder)
            models = pathlib.Path(folder) / "models"
            shutil.copytree(SOURCE / "models" / "ur5_allegro", models / "ur5_allegro")
            urdf = next(file for file in (models / "ur5_allegro").glob("*.urdf") if "ur5" in file.name)
            text = urdf.read_text()
            at = text.index('velocity="')
            urdf.write_text(text[:at] + 'velocity="0" was="' + text[at + 10:])
            for threads in (1, 2):
                code, _, err = run("plan", "--store", store, "--scene", SCENE, "--runs", 4, "--threads", threads, cwd=folder)
                self.assertEqual(code, 2, err)
                self.assertIn(urdf.name, err)
                self.assertIn("velocity", err)

    def test_why_leads_back_to_the_recordings(self):
        path = self.documents["plan"]["ids"][0]
        chain = must("why", path, "--store", self.one / "store")["chain"]
        kinds = [item["kind"] for item in chain]
        self.assertEqual(kinds[0], "path")
        for kind in ("grasp", "synergy_set", "hand_demonstration", "demonstration"):
            self.assertIn(kind, kinds)
        self.assertEqual(kinds.count("demonstration"), kinds.count("hand_demonstration"))

    def test_synergy_sets_are_compared(self):
        with tempfile.TemporaryDirectory() as folder:
            store = self.copied(folder)
            same = must("compare", "--store", store, "--with", self.one / "store")
            self.assertEqual(same["a"], same["b"])
            self.assertEqual([group["name"] for group in same["groups"]], ["pre-grasp", "1", "2", "3", "4"])
            for group in same["groups"]:
                self.assertLess(group["distance_rad"], 1e-6)
                self.assertLess(abs(group["bhattacharyya"]), 1e-9)
            first = same["a"]
            must("analyze", "--store", store, "--transition", "changepoint")
            second = must("compare", "--store", store, "--with", self.one / "store")["a"]
            other = must("compare", first[:12], second[:12], "--store", store)
            self.assertEqual((other["a"], other["b"]), (first, second))
            self.assertGreater(min(group["bhattacharyya"] for group in other["groups"]), 1e-3)
            back = must("compare", second, first, "--store", store)
            for one, two in zip(other["groups"], back["groups"]):
                self.assertEqual(one["k"], two["k"][::-1])
                self.assertAlmostEqual(one["distance_rad"], two["distance_rad"], places=9)
            for arguments, said in (((), "name two synergy sets"), ((first,), "name two synergy sets"),
                                    ((first, self.documents["plan"]["ids"][0]), "no synergy set")):
                code, _, err = run("compare", *arguments, "--store", store)
                self.assertEqual(code, 2)
                self.assertIn(said, err)

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
            must("plan", "--store", store, "--scene", SCENE, "--seed", 3, "--runs", 2)
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

    def test_rejections_are_told_in_short(self):
        with tempfile.TemporaryDirectory() as folder:
            store = self.copied(folder)
            code, out, _ = run("grasp", "--store", store, "--scene", SCENE, "--group", 1, "--max-trials", 64, "--min-trials", 0,
                               "--seed", 77, "--count", 1000)
            self.assertIn(code, (0, 1))
            self.assertLess(max(len(line) for line in out.splitlines()), 400)


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


class Demo(unittest.TestCase):
    def test_leaves_a_store_of_others_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            precious = pathlib.Path(folder) / "store" / "precious.h5"
            precious.parent.mkdir()
            precious.write_text("mine")
            code, _, err = run("demo", "--out", folder)
            self.assertEqual(code, 2)
            self.assertIn("was not made by opponens demo", err)
            self.assertEqual([file.name for file in pathlib.Path(folder).iterdir()], ["store"])
            self.assertEqual(precious.read_text(), "mine")

    def test_whole_and_again_in_its_own_folder(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "out"
            document = must("demo", "--out", out)
            self.assertEqual(document["report"], str(out / "report.html"))
            self.assertGreater((out / "report.html").stat().st_size, 100000)
            self.assertTrue((out / ".opponens-demo").exists())
            stale = out / "store" / "stale.txt"
            stale.write_text("of the demo before")
            begin = time.time()
            program = start("demo", "--out", out)
            while program.poll() is None and not written_since(out / "store", begin):
                time.sleep(0.1)
            program.send_signal(signal.SIGINT)
            program.communicate(timeout=120)
            self.assertEqual(program.returncode, 130)
            self.assertFalse(stale.exists())


if __name__ == "__main__":
    unittest.main()
