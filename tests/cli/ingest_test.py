# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Ingest commits in batches: what is said to be committed stays, whatever comes after."""
import pathlib
import signal
import tempfile
import unittest

import h5py

from support import SOURCE, must, run, start

YAML = """name: batches
recordings: {files: '([0-9]+)\\.txt', parts: [number]}
labels: {object: number}
table: {format: text, columns: 2}
time: {column: '1'}
channels: [{column: '2', joint: I_MCP}]
"""


def committed(text):
    """The numbers in brackets of "committed N recordings (M so far)"."""
    return [int(line.split("(")[1].split()[0]) for line in text.splitlines() if line.startswith("committed ")]


class Batches(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "source.yaml").write_text(YAML)
        self.store = self.folder / "store"

    def record(self, count, rows=2):
        (self.folder / "data").mkdir(exist_ok=True)
        for number in range(count):
            lines = [f"{row} {0.001 * number + row}" for row in range(rows)]
            (self.folder / "data" / f"{number:05}.txt").write_text("\n".join(lines) + "\n")

    def arguments(self):
        return "ingest", self.folder / "data", "--source", self.folder / "source.yaml", "--store", self.store

    def stored(self):
        return len(must("show", "--store", self.store)["objects"])

    def test_batches_are_said_as_they_are_committed(self):
        self.record(600)
        code, out, err = run(*self.arguments())
        self.assertEqual((code, err), (0, ""))
        self.assertEqual(committed(out), [256, 512, 600])
        self.assertEqual(self.stored(), 600)
        self.assertEqual(len(must(*self.arguments())["ids"]), 600)
        self.assertEqual(self.stored(), 600, "again: the same objects")

    def test_an_error_later_keeps_what_was_said(self):
        self.record(600)
        (self.folder / "data" / "00300.txt").write_text("0 1\n1 x\n")
        code, out, err = run(*self.arguments())
        self.assertEqual(code, 2)
        self.assertIn("00300.txt:2: field '2' is 'x'", err)
        self.assertEqual(committed(out), [256])
        self.assertEqual(self.stored(), 256)
        (self.folder / "data" / "00300.txt").write_text("0 1\n1 2\n")
        self.assertEqual(len(must(*self.arguments())["ids"]), 600)
        self.assertEqual(self.stored(), 600)

    def test_an_error_in_the_first_batch_leaves_nothing(self):
        self.record(3)
        (self.folder / "data" / "00002.txt").write_text("")
        self.assertEqual(run(*self.arguments())[0], 2)
        self.assertFalse(self.store.exists())

    def test_an_interruption_keeps_what_was_said(self):
        self.record(3000)
        process = start(*self.arguments())
        first = process.stdout.readline()
        process.send_signal(signal.SIGINT)
        rest, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 130, err)
        self.assertEqual(self.stored(), committed(first + rest)[-1])
        self.assertLess(self.stored(), 3000)

    def test_a_dry_run_tells_and_stores_nothing(self):
        self.record(3, rows=10)
        (self.folder / "data" / "00002.txt").write_text("0 1\n1 1\n2 1\n9 1\n")
        code, out, _ = run(*self.arguments(), "--dry-run")
        self.assertEqual(code, 0)
        self.assertIn("1 gaps", out)
        self.assertIn("stuck in 1 recordings", out)
        summary = must(*self.arguments(), "--dry-run")["summary"]
        self.assertEqual((summary["gaps"], summary["largest_step_s"], summary["recordings"]), (1, 7.0, 3))
        self.assertFalse(self.store.exists())

    def test_a_robot_hand_goes_out_as_robomimic_and_comes_back(self):
        (self.folder / "data").mkdir()
        names = [f"joint_{joint}.0" for joint in range(16)]
        lines = [",".join(["t_s", *names])]
        lines += [",".join(f"{value:.6f}" for value in [row / 300, *(0.1 + 0.001 * row * (joint + 1)
                                                                     for joint in range(16))]) for row in range(90)]
        (self.folder / "data" / "allegro_ros_jointstates.csv").write_text("\n".join(lines) + "\n")
        sources = SOURCE / "models" / "sources"
        first = must("ingest", self.folder / "data", "--source", sources / "allegro_rosbag.yaml", "--store", self.store)
        out = self.folder / "out.hdf5"
        must("export", *first["ids"], "--store", self.store, "--format", "robomimic", "--out", out)
        second = must("ingest", out, "--source", sources / "robomimic.yaml", "--store", self.folder / "other")
        for key in ("samples", "channels"):
            self.assertEqual(second["summary"][key], first["summary"][key])
        self.assertEqual(must("show", "--store", self.folder / "other")["objects"][0]["kind"], "hand_demonstration")

    def test_a_joint_that_the_hand_has_not_is_refused(self):
        self.record(1)
        text = YAML + "kind: hand_demonstration\nhand: models/ur5_allegro/allegro_right.yaml\n"
        (self.folder / "source.yaml").write_text(text)
        code, _, err = run(*self.arguments())
        self.assertEqual(code, 2)
        self.assertIn("joint is 'I_MCP': expected a joint of models/ur5_allegro/allegro_right.yaml: joint_0.0", err)
        self.assertFalse(self.store.exists())

    def test_postures_have_no_phases(self):
        self.record(4, rows=30)
        yaml = YAML.replace("{column: '1'}", "none").replace("[{column: '2', joint: I_MCP}]",
                                                              "[{column: '1', joint: I_MCP}, {column: '2', joint: I_PIP}]")
        (self.folder / "source.yaml").write_text(yaml)
        summary = must(*self.arguments())["summary"]
        self.assertIsNone(summary["duration_s"])
        self.assertIsNone(summary["highest_rate_hz"])
        code, _, err = run("analyze", "--store", self.store, "--group-by", "source")
        self.assertEqual(code, 2)
        self.assertIn("holds postures without time: it has no phases to split", err)
        must("analyze", "--store", self.store, "--group-by", "source", "--phase", "none")

    def test_foreign_files_that_are_none_are_refused(self):
        (self.folder / "data").mkdir()
        yaml = self.folder / "source.yaml"
        yaml.write_text("name: a\nrecordings: {files: '.*'}\ntable: {format: hdf5}\ntime: {rate: 5}\n"
                        "channels: [{column: q, joint: I_MCP}]\n")
        (self.folder / "data" / "a.h5").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(range(256)) * 4)
        code, _, err = run(*self.arguments())
        self.assertEqual(code, 2, err)
        self.assertIn("a.h5: not an intact HDF5 file", err)
        self.assertEqual(len(err.splitlines()), 1)
        with h5py.File(self.folder / "data" / "a.h5", "w") as file:
            file["q"] = [0.0, 1.0, 2.0]
        self.assertEqual(len(must(*self.arguments())["ids"]), 1)


if __name__ == "__main__":
    unittest.main()
