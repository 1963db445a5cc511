#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""The layers check refuses what it is there for: each forbidden include is written into a scratch tree and found."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

LAYERS = pathlib.Path(__file__).with_name("layers.py")


class Layers(unittest.TestCase):
    def offences(self, name, text):
        with tempfile.TemporaryDirectory() as root:
            file = pathlib.Path(root) / name
            file.parent.mkdir(parents=True)
            file.write_text(text)
            run = subprocess.run([sys.executable, LAYERS, root], capture_output=True, text=True)
            return run.returncode, run.stdout

    def test_refuses(self):
        for name, line in [
            ("core/a.hpp", '#include "analysis/pca.hpp"'),
            ("grasp/a.cpp", '#include "motion/world.hpp"'),
            ("motion/a.cpp", '#include "grasp/quality.hpp"'),
            ("analysis/a.cpp", '#include "robot/mesh.hpp"'),
            ("storage/readers/a.cpp", '#include "robot/mesh.hpp"'),
            ("robot/a.hpp", "#include <fcl/fcl.h>"),
            ("storage/a.hpp", "#include <hdf5.h>"),
            ("motion/other.hpp", "#include <ompl/base/Planner.h>"),
            ("grasp/a.cpp", "#include <fstream>"),
        ]:
            with self.subTest(name=name, line=line):
                code, out = self.offences(name, line + "\n")
                self.assertEqual(code, 1)
                self.assertIn(f"{name}:1:", out)

    def test_allows(self):
        for name, line in [
            ("verify/a.cpp", '#include "grasp/quality.hpp"'),
            ("robot/a.cpp", "#include <fcl/fcl.h>"),
            ("core/a.hpp", "#include <Eigen/Core>"),
            ("motion/ompl_planner.hpp", "#include <ompl/base/Planner.h>"),
        ]:
            with self.subTest(name=name, line=line):
                self.assertEqual(self.offences(name, line + "\n")[0], 0)


if __name__ == "__main__":
    unittest.main()
