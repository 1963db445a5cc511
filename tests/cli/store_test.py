# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""export, ingest of a single file, merge, repair, stale, show and why, on a store made by the program itself."""
import csv
import json
import pathlib
import resource
import signal
import subprocess
import tempfile
import unittest

import h5py
import numpy

from support import HEADER, PROGRAM, content_hash, data_set, must, read_object, run, snapshot

SOURCE_YAML = "models/sources/west_r2g.yaml"


def lines(count, change=0.0):
    """A movement of all 23 channels, each in its own way."""
    moved = [[f"{i / 100:.3f}"] + [f"{numpy.sin(0.004 * i * (1 + j / 7) + j) + change * (i == 50):.6f}" for j in range(23)]
             for i in range(count)]
    return [HEADER] + [",".join(row) for row in moved]


def objects(store):
    return {item["id"]: item for item in must("show", "--store", store)["objects"]}


def of_kind(store, kind):
    return [item["id"] for item in must("show", "--store", store, "--kind", kind)["objects"]]


class StoreCommands(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.data = data_set(cls.folder / "data", {f"r{i}": lines(200 + 10 * i) for i in range(4)})
        cls.store = cls.folder / "store"
        must("ingest", cls.data, "--store", cls.store, "--source", SOURCE_YAML)
        must("analyze", "--store", cls.store, "--input", "glove", "--phase", "none", "--group-by", "object")
        cls.recordings = of_kind(cls.store, "demonstration")
        cls.synergies = of_kind(cls.store, "synergy_set")[0]

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def copy(self, name):
        """A store of the test's own with the same objects."""
        target = self.folder / name
        must("merge", self.store, "--store", target)
        return target

    def record(self, identifier, store=None):
        return must("show", identifier, "--store", store or self.store)["object"]

    def test_single_file_goes_and_comes_back(self):
        out = self.folder / "one.h5"
        document = must("export", self.synergies[:10], "--store", self.store, "--single-file", out)
        self.assertEqual(set(document["ids"]), set(self.recordings) | {self.synergies})  # with all it was made from
        self.assertEqual(document["missing"], [])
        with h5py.File(out) as file:  # a batch file like any other, for h5py too
            for group in file["objects"].values():
                self.assertEqual(content_hash(read_object(group)), group.attrs["id"])
        back = self.folder / "back"
        self.assertEqual(must("ingest", out, "--store", back)["new"], 5)
        self.assertEqual(must("ingest", out, "--store", back)["new"], 0)
        for identifier in document["ids"]:
            self.assertEqual(self.record(identifier, back), self.record(identifier))
        self.assertEqual(must("why", self.synergies, "--store", back), must("why", self.synergies, "--store", self.store))
        must("verify", "--store", back)

    def test_single_file_that_is_damaged(self):
        out = self.folder / "damaged.h5"
        must("export", "--store", self.store, "--single-file", out)
        good = out.read_bytes()
        target = self.folder / "from_damaged"
        out.write_bytes(good[:-100])
        code, _, err = run("ingest", out, "--store", target)
        self.assertEqual(code, 2)
        self.assertIn("cut off", err)
        self.assertFalse(target.exists())
        values = numpy.array(self.record(self.recordings[0])["fields"]["q_h"], dtype="<f8").tobytes()
        at = good.index(values) + 805
        out.write_bytes(good[:at] + bytes([good[at] ^ 8]) + good[at + 1:])
        code, _, err = run("ingest", out, "--store", target)
        self.assertEqual(code, 3)
        self.assertIn("content hash", err)
        out.write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(5000))
        code, _, err = run("ingest", out, "--store", target)
        self.assertEqual(code, 2)
        self.assertIn("--source is missing", err)

    def test_csv(self):
        out = self.folder / "tables"
        must("export", "--store", self.store, "--format", "csv", "--out", out)
        with open(out / "index.csv") as file:
            index = list(csv.DictReader(file))
        self.assertEqual({line["id"] for line in index}, set(self.recordings) | {self.synergies})
        line = next(line for line in index if line["id"] == self.recordings[1])
        fields = self.record(self.recordings[1])["fields"]
        table = numpy.genfromtxt(out / line["file"], delimiter=",", names=True)
        self.assertEqual(line["object"], "cup")
        self.assertTrue(numpy.array_equal(table["time_s"], fields["time"]))  # bit for bit
        for j, joint in enumerate(fields["joint_names"]):
            self.assertTrue(numpy.array_equal(table[joint], numpy.array(fields["q_h"])[:, j]), joint)
        line = next(line for line in index if line["id"] == self.synergies and line["group"] == "cup")
        with open(out / line["file"]) as file:
            table = {row[0]: [float(value) for value in row[1:] if value] for row in list(csv.reader(file))[1:]}
        fields = self.record(self.synergies)["fields"]
        self.assertEqual(table["variance"], fields["grasp.000.basis_variance"])
        self.assertEqual([table[joint][1:] for joint in fields["joint_names"]], fields["grasp.000.basis_axes"])
        code, _, err = run("export", "--store", self.store, "--format", "csv", "--out", out)
        self.assertEqual((code, "not empty" in err), (2, True))

    def test_json(self):
        out = self.folder / "all.json"
        must("export", "--store", self.store, "--format", "json", "--out", out)
        document = json.loads(out.read_text())
        self.assertEqual(document["schema"], 1)
        for item in document["objects"]:
            self.assertEqual(item, self.record(item["id"]))
        self.assertEqual(len(document["objects"]), 5)

    def test_robomimic(self):
        out = self.folder / "robomimic.hdf5"
        must("export", "--store", self.store, "--kind", "demonstration", "--format", "robomimic", "--out", out)
        with h5py.File(out) as file:
            data = file["data"]
            self.assertEqual(set(data), {f"demo_{i}" for i in range(4)})
            self.assertEqual(data.attrs["total"], sum(demo.attrs["num_samples"] for demo in data.values()))
            self.assertIn("env_name", json.loads(data.attrs["env_args"]))
            for demo in data.values():
                fields = self.record(demo.attrs["id"])["fields"]
                q = numpy.array(fields["q_h"])
                self.assertEqual(demo.attrs["num_samples"], len(q))
                self.assertEqual(json.loads(demo.attrs["joint_names"]), fields["joint_names"])
                self.assertEqual(json.loads(demo.attrs["labels"])["object"], "cup")
                for name in ("obs/hand_qpos", "states"):
                    self.assertTrue(numpy.array_equal(demo[name], q))
                self.assertTrue(numpy.array_equal(demo["obs/time"], fields["time"]))
                self.assertTrue(numpy.array_equal(demo["actions"][:-1], q[1:]))
                self.assertTrue(numpy.array_equal(demo["actions"][-1], q[-1]))
                self.assertEqual((demo["dones"][-1], numpy.sum(demo["dones"])), (1, 1))
        code, _, err = run("export", self.synergies, "--store", self.store, "--format", "robomimic", "--out", out)
        self.assertEqual((code, "synergy_set" in err), (2, True))

    def test_export_to_a_full_disk(self):
        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))

        for name, options in (("full.h5", ["--single-file"]), ("full.hdf5", ["--kind", "demonstration", "--format",
                                                                             "robomimic", "--out"])):
            folder = self.folder / ("disk_" + name)
            folder.mkdir()
            done = subprocess.run([PROGRAM, "export", "--store", self.store, *options, folder / name], preexec_fn=limit,
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
            self.assertIn("cannot write", done.stderr)
            self.assertEqual(list(folder.iterdir()), [])

    def test_export_wrong_use(self):
        for arguments in ([], ["--format", "json"], ["--single-file", "a", "--format", "json"],
                          ["--single-file", "a", "--out", "b"], ["--format", "json", "--out", "x", "--kind", "none"],
                          ["feed", "--single-file", "a"], [self.synergies, "--kind", "demonstration", "--single-file", "a"],
                          [self.synergies, "--kind", "demonstration", "--format", "json", "--out", "x"], ["--single-file", "/nowhere/a.h5"]):
            code, _, err = run("export", "--store", self.store, *arguments)
            self.assertEqual(code, 2, arguments)
            self.assertEqual(len(err.strip().splitlines()), 1, err)

    def test_merge_is_a_union_and_idempotent(self):
        other_data = data_set(self.folder / "other_data", {"x": lines(300), "r1": lines(210)})
        other = self.folder / "other"
        must("ingest", other_data, "--store", other, "--source", SOURCE_YAML)
        target = self.copy("merged")
        before = {**objects(self.store), **objects(other)}
        document = must("merge", self.store, other, "--store", target)
        self.assertEqual(document["stores"][0]["new"], 0)
        self.assertEqual(set(objects(target)), set(before))
        files = snapshot(target)
        log = (target / "runs.jsonl").read_text()
        self.assertEqual(must("merge", other, self.store, "--store", target)["ids"], [])
        self.assertEqual(snapshot(target), files)
        self.assertNotIn("produced", (target / "runs.jsonl").read_text()[len(log):])  # nothing became newer
        must("verify", "--store", target)
        code, _, err = run("merge", target, "--store", target)
        self.assertEqual((code, "name others" in err), (2, True))

    def test_repair(self):
        store = self.copy("to_repair")
        must("analyze", "--store", store, "--input", "glove", "--phase", "none", "--alpha", "0.1", "--group-by", "object")
        victim = self.recordings[2]
        name = objects(store)[victim]["file"]
        path = store / name
        good = path.read_bytes()
        values = numpy.array(self.record(victim)["fields"]["q_h"], dtype="<f8").tobytes()
        at = good.index(values) + 1601
        damaged = good[:at] + bytes([good[at] ^ 1]) + good[at + 1:]
        path.write_bytes(damaged)
        self.assertEqual(
            run("show", victim, "--store", store)[0], 3)
        self.assertEqual(run("show", self.recordings[0], "--store", store)[0], 0)  # what is intact can be read
        before = snapshot(store)
        document = must("repair", "--store", store, "--dry-run", code=3)
        self.assertEqual([file["file"] for file in document["files"]], [name])
        self.assertEqual([item["id"] for item in document["files"][0]["lost"]], [victim])
        self.assertEqual(snapshot(store), before)
        done = must("repair", "--store", store)
        self.assertEqual(done["files"], document["files"])
        self.assertEqual({item["missing_input"] for item in done["missing_upstream"]}, {victim})
        self.assertEqual(len(done["missing_upstream"]), 2)  # both synergy sets
        self.assertEqual((store / "damaged" / name).read_bytes(), damaged)
        self.assertEqual(set(self.recordings) - set(objects(store)), {victim})
        kinds = [item["kind"] for item in must("show", "--store", store)["objects"]]
        self.assertEqual(kinds, ["demonstration"] * 3 + ["synergy_set"] * 2)  # the order of before
        self.assertEqual(must("repair", "--store", store)["files"], [])
        missing = [link for link in must("why", self.synergies, "--store", store)["chain"] if link["kind"] is None]
        self.assertEqual([link["id"] for link in missing], [victim])
        must("merge", self.store, "--store", store)  # a copy brings it back
        self.assertEqual(set(self.recordings) - set(objects(store)), set())
        must("verify", "--store", store)

    def test_repair_of_files_that_are_cut_or_gone(self):
        store = self.copy("cut")
        files = sorted(store.glob("*.h5"))
        files[0].write_bytes(files[0].read_bytes()[:-1])
        document = must("repair", "--store", store)
        self.assertEqual(document["files"][0]["lost"], [])  # each object's part is still there
        self.assertEqual(len(document["files"][0]["intact"]), 5)
        must("verify", "--store", store)
        sorted(store.glob("*.h5"))[0].unlink()
        self.assertEqual(run("show", "--store", store)[0], 3)
        document = must("repair", "--store", store)
        self.assertEqual(len(document["files"][0]["lost"]), 5)
        self.assertEqual({item["kind"] for item in objects(store).values()}, {"verification"})

    def test_stale(self):
        store = self.copy("stale")
        self.assertEqual(must("stale", "--store", store)["stale"], [])
        original = (self.data / "csv/r1.csv").read_text()
        (self.data / "csv/r1.csv").write_text("\n".join(lines(210, change=0.01)) + "\n")
        try:
            document = must("stale", "--store", store, "--files", self.data)
            named = {item["id"]: item for item in document["stale"]}
            victim = next(i for i in self.recordings if self.record(i)["name"] == "r1")
            self.assertEqual(set(named), {victim, self.synergies})
            self.assertEqual(named[victim]["file"], "r1.csv")
            self.assertEqual(named[self.synergies]["input"], victim)
            other = self.folder / "as_it_was"
            other.mkdir()
            (other / "r1.csv").write_text(original)
            document = must("stale", "--store", store, "--files", self.data, other)
            self.assertEqual((document["stale"], document["files_ambiguous"]), ([], ["r1.csv"]))
            must("ingest", self.data, "--store", store, "--source", SOURCE_YAML)
            document = must("stale", "--store", store)
            self.assertIn(victim, [item["id"] for item in document["superseded"]])
            self.assertIn(self.synergies, [item["id"] for item in document["stale"]])
            must("analyze", "--store", store, "--input", "glove", "--phase", "none", "--group-by", "object")
            document = must("stale", "--store", store)
            fresh = set(of_kind(store, "synergy_set")) - {self.synergies}
            self.assertEqual(len(fresh), 1)
            self.assertFalse(fresh & {item["id"] for item in document["stale"]})
            self.assertIn(self.synergies, [item["id"] for item in document["superseded"]])
        finally:
            (self.data / "csv/r1.csv").write_text(original)

    def test_show_and_why_for_a_person(self):
        _, out, _ = run("show", self.recordings[0], "--store", self.store)
        for part in ("demonstration", "label.object", "cup", "q_h", " x ", "made by", "ingest"):
            self.assertIn(part, out)
        _, out, _ = run("show", "--kind", "synergy_set", "--store", self.store)
        self.assertEqual(len(out.splitlines()), 1)
        _, out, _ = run("why", self.synergies, "--store", self.store)
        self.assertEqual(len(out.splitlines()), 5)
        self.assertTrue(out.splitlines()[1].startswith("  "))


if __name__ == "__main__":
    unittest.main()
