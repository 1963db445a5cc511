# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Bad input gives one clear line and the right exit code, and leaves the store as it was."""
import pathlib
import shutil
import struct
import tempfile
import unittest

from support import HEADER, SOURCE, analysed_store, data_set, must, rows, run, snapshot

class BadInput(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.folder.name)
        cls.store = cls.root / "store"
        analysed_store(cls.store)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def refuse(self, code, words, *arguments, store=None):
        store = store or self.store
        before = snapshot(store)
        got, out, err = run(*arguments)
        self.assertEqual(got, code, out + err)
        self.assertEqual(out, "")
        self.assertEqual(len(err.strip().splitlines()), 1, err)
        for word in words:
            self.assertIn(word, err)
        self.assertEqual(snapshot(store), before)

    def recording(self, lines):
        return data_set(tempfile.mkdtemp(dir=self.root), {"a": lines})

    def ingest(self, words, lines):
        self.refuse(2, ["a.csv", *words], "ingest", self.recording(lines), "--store", self.store, "--source",
                    "models/sources/west_r2g.yaml")

    def test_a_good_recording_is_taken(self):
        store = self.root / "good"
        must("ingest", self.recording([HEADER, *rows()]), "--store", store, "--source", "models/sources/west_r2g.yaml")
        self.assertEqual(len(snapshot(store)), 1)

    def test_recordings(self):
        self.ingest([], [])
        self.ingest([], [HEADER])
        text = rows()
        text[50] = text[50].replace("0.2500", "nan", 1)
        self.ingest([":52"], [HEADER, *text])
        text = rows()
        text[50] = text[50].rsplit(",", 1)[0]
        self.ingest([":52"], [HEADER, *text])
        text = rows()
        text[50] = text[50].replace("0.500", "0.490", 1)
        self.ingest([":52", "0.49"], [HEADER, *text])
        text = rows()
        text[50] = text[50].replace("0.2500", "many", 1)
        self.ingest([":52", "many"], [HEADER, *text])
        self.ingest(["W_YAW"], [HEADER.replace("W_YAW", "L_YAWN"), *rows()])
        for last, shown in (("1000000000.0", "1000000000 s"), ("1e300", "1e+300 s")):  # more samples than memory holds
            self.ingest([shown, "is the time in seconds?"], [HEADER, *rows(), rows()[-1].replace("1.990", last, 1)])

    def test_missing_files(self):
        self.refuse(2, ["nowhere"], "ingest", self.root / "nowhere", "--store", self.store, "--source",
                    "models/sources/west_r2g.yaml")
        self.refuse(2, ["nowhere.yaml"], "ingest", self.root, "--store", self.store, "--source", "nowhere.yaml")
        self.refuse(2, ["nowhere.yaml"], "retarget", "--store", self.store, "--hand", "nowhere.yaml")
        self.refuse(2, ["nowhere.yaml"], "grasp", "--store", self.store, "--robot", "nowhere.yaml")
        self.refuse(2, ["nowhere.yaml"], "grasp", "--store", self.store, "--scene", "nowhere.yaml")
        self.refuse(2, ["nowhere"], "analyze", "--store", self.root / "nowhere", store=self.root / "nowhere")
        self.assertFalse((self.root / "nowhere").exists())

    def broken_hand(self, replace):
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.root))
        for file in (SOURCE / "models/ur5_allegro").iterdir():
            if file.is_file():
                shutil.copy(file, folder)
        for name, old, new in replace:
            file = folder / name
            text = file.read_text()
            self.assertIn(old, text)
            file.write_text(text.replace(old, new, 1))
        return folder / "allegro_right.yaml"

    def test_robots(self):
        hand = self.broken_hand([("allegro_right.yaml", "joint_5.0", "joint_99.0")])
        self.refuse(2, ["allegro_right.yaml", "joint_99.0"], "retarget", "--store", self.store, "--hand", hand)
        hand = self.broken_hand([("allegro_right.urdf", 'type="revolute"', 'type="floating"')])
        self.refuse(2, ["allegro_right.urdf", "floating"], "retarget", "--store", self.store, "--hand", hand)
        hand = self.broken_hand([("allegro_right.urdf", 'type="revolute"', 'type="wobbly"')])
        self.refuse(2, ["allegro_right.urdf", "wobbly"], "retarget", "--store", self.store, "--hand", hand)
        hand = self.broken_hand([("allegro_right.urdf", "<geometry>", '<geometry><mesh filename="gone.stl"/></geometry>'
                                  '</collision><collision><geometry>')])
        hand = self.broken_hand([("allegro_right.urdf", 'velocity="', 'velocity="-')])
        self.refuse(2, ["allegro_right.urdf", "joint", "velocity limit", "must be positive"], "retarget", "--store",
                    self.store, "--hand", hand)
        hand = self.broken_hand([("allegro_right.urdf", "<geometry>", '<geometry><mesh filename="gone.stl"/></geometry>'
                                  '</collision><collision><geometry>')])
        self.refuse(2, ["gone.stl"], "retarget", "--store", self.store, "--hand", hand)

    def test_scenes(self):
        scene = self.root / "scene.yaml"
        text = (SOURCE / "models/scenes/cylinder_shelf.yaml").read_text()
        scene.write_text(text + "\nsurprise: 1\n")
        self.refuse(2, ["scene.yaml", "surprise"], "grasp", "--store", self.store, "--scene", scene)
        arm = self.root / "arm.yaml"
        arm.write_text(f"name: arm\narm: {{urdf: {SOURCE}/models/ur5_allegro/ur5.urdf, joints: [elbow_joint]}}\n")
        self.refuse(2, ["arm.yaml", "arm without a hand"], "grasp", "--store", self.store, "--robot", arm)
        self.refuse(2, ["teapot"], "grasp", "--store", self.store, "--object", "teapot")

    def test_wrong_use(self):
        for arguments in (["fly"], ["plan"], ["analyze", "--store", str(self.store), "--alpha", "2"],
                          ["plan", "--store", str(self.store), "--planner", "magic"]):
            code, out, err = run(*arguments)
            self.assertEqual(code, 2, arguments)
            self.assertEqual(out, "")
            self.assertTrue(err)
        for arguments in (["fly"], ["fly", "--help"], ["grasps", "x"]):
            self.refuse(2, [arguments[0] + ": no such command"], *arguments)
        self.refuse(2, ["nobody"], "grasp", "--store", self.store, "--group", "nobody")
        self.refuse(2, ["opponens grasp"], "plan", "--store", self.store)

    def test_order_of_the_stages_is_told(self):
        store = self.root / "young"
        must("simulate", "--store", store, "--repetitions", 2)
        self.refuse(2, ["opponens analyze"], "grasp", "--store", store, store=store)

    def test_unknown_group_label_is_told(self):
        self.refuse(2, ["shoe_size"], "analyze", "--store", self.store, "--group-by", "shoe_size")

    def test_read_only_directory(self):
        # Root may write anywhere, so the folder lies on a read-only system: below /proc nothing can be made.
        self.refuse(2, ["/proc/opponens"], "simulate", "--store", "/proc/opponens", store="/proc/opponens")

    def damaged(self, change, which=-1):
        store = pathlib.Path(tempfile.mkdtemp(dir=self.root)) / "store"
        shutil.copytree(self.store, store)
        file = sorted(store.glob("*.h5"))[which]
        data = bytearray(file.read_bytes())
        file.chmod(0o644)
        file.write_bytes(change(data))
        return store

    def test_damaged_store(self):
        def flip(data):
            table, = struct.unpack_from("<Q", data, len(data) - 26)  # docs/file_format.md: contents
            data[table - 1] ^= 4  # the last byte of the last object
            return bytes(data)

        # The first file holds recordings, the last one the synergies: a command that reads them must refuse.
        readers = {0: (["retarget"], ["analyze", "--input", "glove"]),
                   -1: (["grasp"], ["plan"], ["report", "--out", self.root / "r.html"])}
        for which, commands in readers.items():
            for change in (flip, lambda data: bytes(data[: len(data) // 3]), lambda data: b""):
                store = self.damaged(change, which)
                for command in commands:
                    self.refuse(3, [".h5"], command[0], "--store", store, *command[1:], store=store)

    def test_verify_finds_damage(self):
        def flip(data):  # in the HDF5 bytes: not what a command reads, but damage
            data[len(data) // 3] ^= 4
            return bytes(data)

        for change in (flip, lambda data: bytes(data[:100])):
            store = self.damaged(change)
            code, out, err = run("verify", "--store", store)
            self.assertEqual(code, 3, out + err)


if __name__ == "__main__":
    unittest.main()
