# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Bad robot files: exit 2 and one line that names file and element; never a crash, a hang or a gigabyte."""
import os
import pathlib
import random
import re
import resource
import struct
import subprocess
import tempfile
import unittest

from support import PROGRAM, SOURCE

LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
MEMORY = 1500 * 1024 * 1024  # bytes of address space: our largest model needs a tenth


def link(name, shape=""):
    body = f"<collision><geometry>{shape}</geometry></collision>" if shape else ""
    return f'<link name="{name}">{body}</link>'


def joint(name, parent, child, inside=LIMIT, kind="revolute"):
    return f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>{inside}</joint>'


def mesh(name):
    return link("a", f'<mesh filename="{name}"/>') + link("b") + joint("j", "a", "b")


def two(inside, kind="revolute"):
    return link("a") + link("b") + joint("j", "a", "b", inside, kind)


# what is wrong -> (URDF inside <robot>, words of the complaint)
CASES = {
    "loop": (link("a") + link("b") + link("c") + joint("j", "b", "c") + joint("k", "c", "b"), ["'b'", "loop"]),
    "two roots": (two(LIMIT) + link("c"), ["root", "[c]"]),
    "two parents": (link("a") + link("b") + link("c") + joint("i", "a", "b") + joint("j", "a", "c") +
                    joint("k", "b", "c"), ["'c'", "'j'", "'k'"]),
    "zero-length axis": (two(LIMIT + '<axis xyz="0 0 0"/>'), ["'j'", "axis"]),
    "missing limits": (two(""), ["[j]", "limits"]),
    "limits swapped": (two('<limit lower="1" upper="-1" effort="1" velocity="1"/>'), ["'j'", "lower limit is above"]),
    "limits that are no numbers": (two('<limit lower="a" upper="1" effort="1" velocity="1"/>'), ["'j'"]),
    "no speed": (two('<limit lower="0" upper="1" effort="1" velocity="0"/>'), ["'j'", "velocity limit"]),
    "NaN origin": (two(LIMIT + '<origin xyz="nan 0 0" rpy="0 0 0"/>'), ["'j'"]),
    "infinite origin": (two(LIMIT + '<origin xyz="1e999 0 0" rpy="0 0 0"/>'), ["'j'"]),
    "half an origin": (two(LIMIT + '<origin xyz="0 0" rpy="0 0 0"/>'), ["'j'"]),
    "link twice": (link("a") + two(LIMIT), ["'a'"]),
    "joint twice": (two(LIMIT) + link("c") + joint("j", "b", "c"), ["'j'"]),
    "link without a name": ("<link/>" + two(LIMIT), ["a link has no name"]),
    "parent that is none": (link("a") + link("b") + joint("j", "z", "b"), ["joint", "[z]"]),
    "own parent": (link("a") + joint("j", "a", "a"), ["'a'", "loop"]),
    "mimic loop": (link("a") + link("b") + link("c") + joint("j", "a", "b", LIMIT + '<mimic joint="k"/>') +
                   joint("k", "b", "c", LIMIT + '<mimic joint="j"/>'), ["'j'", "mimics itself"]),
    "mimic of nothing": (two(LIMIT + '<mimic joint="z"/>'), ["'j'", "'z'"]),
    "negative size": (link("a", '<box size="1 -1 1"/>') + link("b") + joint("j", "a", "b"), ["'a'", "box"]),
    "zero scale": (link("a", '<mesh filename="t.stl" scale="1 0 1"/>') + link("b") + joint("j", "a", "b"),
                   ["'a'", "t.stl", "scale"]),
    "NaN scale": (link("a", '<mesh filename="t.stl" scale="nan 1 1"/>') + link("b") + joint("j", "a", "b"),
                  ["link 'a'", "<mesh> scale 'nan 1 1'", "3 finite numbers"]),
    "mesh that leaves its package": (mesh("package://x/../../etc/passwd"), ["'a'", "package://x/../../etc/passwd",
                                                                           "leaves its package"]),
    "mesh that is a directory": (mesh("folder.stl"), None),
    "nothing": ("", ["robot"]),
    "nothing that moves": (two("", "fixed"), ["no joint that moves"]),
    "floating": (two("", "floating"), ["'j'", "floating"]),
    "planar": (two("", "planar"), ["'j'", "planar"]),
}


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


class BadRobots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # A sanitizer's shadow memory does not fit under a limit; its own checks stand in.
        fits = subprocess.run([PROGRAM, "--version"], capture_output=True, preexec_fn=limit_memory).returncode == 0
        cls.limit = staticmethod(limit_memory) if fits else None

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "folder.stl").mkdir()
        (self.folder / "x").mkdir()
        (self.folder / "t.stl").write_text("solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                                           "vertex 0 1 0\nendloop\nendfacet\nendsolid t\n")

    def run_robot(self, file, *more):
        done = subprocess.run([PROGRAM, "robot", str(file), "--samples", "0", *more], capture_output=True, timeout=60,
                              preexec_fn=self.limit)
        return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")

    def refuse(self, file, words):
        code, out, err = self.run_robot(file)
        self.assertEqual((code, out), (2, ""), err)
        self.assertEqual(len(err.strip().splitlines()), 1, err)
        for word in [file.name, *words]:
            self.assertIn(word, err)

    def write(self, name, content):
        file = self.folder / name
        file.write_bytes(content if isinstance(content, bytes) else content.encode())
        return file

    def test_urdfs(self):
        for name, (inside, words) in CASES.items():
            with self.subTest(name):
                file = self.write("robot.urdf", f'<robot name="r">{inside}</robot>')
                if words is None:  # listed here, refused by the loaders (tests/robot/bad_urdf_test.cpp)
                    code, out, _ = self.run_robot(file)
                    self.assertEqual(code, 1)
                    self.assertIn("folder.stl is a directory", out)
                    continue
                self.refuse(file, words)

    def test_a_good_one_is_taken(self):
        self.assertEqual(self.run_robot(self.write("robot.urdf", f'<robot name="r">{two(LIMIT)}</robot>'))[0], 0)
        self.assertEqual(self.run_robot(self.write("robot.urdf", f'<robot name="r">{mesh("t.stl")}</robot>'))[0], 0)

    def test_meshes(self):
        def announces(name, content):
            self.write(name, content)
            urdf = self.write("robot.urdf", f'<robot name="r">{mesh(name)}</robot>')
            code, out, err = self.run_robot(urdf)
            self.assertEqual((code, out), (2, ""), err)
            self.assertEqual(len(err.strip().splitlines()), 1, err)
            self.assertIn(name, err)

        announces("large.stl", bytes(80) + struct.pack("<I", 20_000_000))  # 1 GB of triangles, none there
        announces("short.stl", b"\1" * 10)
        announces("solid.stl", "solid t\n")
        announces("faces.obj", "v 0 0 0\nf 1 2000000000 3\n")
        announces("empty.obj", "")
        announces("array.dae", '<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">'
                  '<library_geometries><geometry id="g"><mesh><source id="s"><float_array id="f" count="4000000000">0'
                  "</float_array></source></mesh></geometry></library_geometries></COLLADA>")
        announces("indices.dae", '<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">'
                  '<library_geometries><geometry id="g"><mesh><source id="s"><float_array id="f" count="3">0 0 0'
                  '</float_array><technique_common><accessor source="#f" count="1000000000" stride="3"/>'
                  '</technique_common></source><triangles count="400000000"><input semantic="VERTEX" source="#s" '
                  'offset="0"/><p>0 0 0</p></triangles></mesh></geometry></library_geometries></COLLADA>')
        announces("nested.dae", "<COLLADA>" + "<a>" * 200000)
        announces("noise.dae", random.Random(1).randbytes(2000))
        announces("mesh.txt", "nothing")

    def test_files_that_are_none(self):
        self.refuse(self.write("robot.urdf", "<a>" * 300000), ["inside each other"])
        self.refuse(self.write("robot.urdf", b"\0" * 100), ["not XML"])
        self.refuse(self.write("robot.urdf", random.Random(2).randbytes(5000)), ["robot"])
        self.refuse(self.write("robot.yaml", "palm_link: [" * 5000), ["robot.yaml"])
        self.refuse(self.write("robot.yaml", "[1, 2]"), ["neither"])
        self.refuse(self.write("robot.yaml", b"\xff\xfe\0\0"), ["robot.yaml"])
        self.refuse(pathlib.Path("/dev/zero"), ["64 MiB"])
        (self.folder / "loop.urdf").symlink_to("loop.urdf")
        code, out, err = self.run_robot(self.folder / "loop.urdf")
        self.assertEqual((code, out, len(err.strip().splitlines())), (2, "", 1), err)

    def test_srdf(self):
        self.write("robot.urdf", f'<robot name="r">{two(LIMIT)}</robot>')
        hand = self.write("hand.yaml", "urdf: robot.urdf\npalm_link: a\njoints: [j]\nsrdf: robot.srdf\n")
        for text, words in (("<robot>\n<group", ["line 2"]), ("", ["robot.srdf"]), ("<a/>", ["<robot>"]),
                            ("<robot><disable_collisions/></robot>", ["line 1", "link1"])):
            self.write("robot.srdf", text)
            code, out, err = self.run_robot(hand)
            self.assertEqual((code, out), (2, ""), err)
            self.assertEqual(len(err.strip().splitlines()), 1, err)
            for word in ["robot.srdf", *words]:
                self.assertIn(word, err)
        self.write("robot.srdf", '<robot><disable_collisions link1="a" link2="zz"/><new_tag/></robot>')
        code, out, err = self.run_robot(hand)
        self.assertEqual((code, err), (0, ""))
        self.assertIn("robot does not have: zz", out)
        self.assertIn("<new_tag> ignored (1)", out)

    def test_mutations_of_our_hand(self):
        """Whatever is changed: an answer, or one line. Seeds are fixed; a failing one is printed."""
        text = (SOURCE / "models/ur5_allegro/allegro_right.urdf").read_text()
        values = ["nan", "-1", "0", "1e308", "-1e-320", "", "1 2", "x", "99999999999999999999", "0x10", "inf"]
        for seed in range(int(os.environ.get("OPPONENS_MUTATIONS", "120"))):
            chance = random.Random(seed)
            changed = text
            for _ in range(chance.choice([1, 1, 2, 5])):
                kind = chance.randrange(4)
                places = [m.span() for m in re.finditer(r'"[^"]*"' if kind < 2 else r"<[^>]*>", changed)]
                begin, end = chance.choice(places)
                if kind == 0:
                    changed = changed[:begin] + f'"{chance.choice(values)}"' + changed[end:]
                elif kind == 1:
                    other = chance.choice(places)
                    changed = changed[:begin] + changed[slice(*other)] + changed[end:]
                elif kind == 2:
                    changed = changed[:begin] + changed[end:]
                else:
                    changed = changed[:end] + changed[begin:end] + changed[end:]
            with self.subTest(seed=seed):
                code, out, err = self.run_robot(self.write("robot.urdf", changed), "--propose-contacts")
                self.assertIn(code, (0, 1, 2), f"seed {seed}: {err}")
                self.assertNotIn("internal error", err)
                if code == 2:
                    self.assertEqual((out, len(err.strip().splitlines())), ("", 1), f"seed {seed}: {err}")


if __name__ == "__main__":
    unittest.main()
