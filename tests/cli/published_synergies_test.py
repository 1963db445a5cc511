# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""The published synergies V and variance accounted for (VAF) of the West and Hogan recordings, which are the centred singular
value decomposition of their processed cells, from our ingest and our principal axes by the command line (docs/cli.md)."""
import pathlib
import sys
import tempfile
import unittest

import numpy

from support import SHARED, must

sys.path.append(str(pathlib.Path(__file__).parent.parent / "storage"))
import mat_file  # noqa: E402

RECORDINGS = SHARED / "data/demos/west_r2g/mat"
PUBLISHED = SHARED / "reference/west_published"
TOLERANCE = 1e-10
OBJECTS = ["scissors", "zip_tie", "screwdriver", "harness_tied", "harness_untied"]


def published(form):
    """V [n x n x cells...] and the share of each synergy VAF [n x cells...]."""
    return [mat_file.variable(PUBLISHED / f"{what}_R2G_{form}_s1-5.mat", f"{what}_R2G_{form}") for what in ("V", "VAF")]


def learnt(source, group_by):
    """Group -> axes [n x n], cumulative variance [n]."""
    with tempfile.TemporaryDirectory() as folder:
        store = pathlib.Path(folder) / "store"
        must("ingest", RECORDINGS, "--store", store, "--source", f"models/sources/{source}.yaml")
        document = must("analyze", "--store", store, "--phase", "none", "--space", "rad", "--group-by", group_by)
        identity, = [one["id"] for one in must("show", "--store", store)["objects"] if one["kind"] == "synergy_set"]
        fields = must("show", identity, "--store", store)["object"]["fields"]
        groups = {}
        for number, group in enumerate(document["groups"][1:]):
            axes = numpy.array(fields[f"grasp.{number:03d}.basis_axes"])
            groups[group["name"]] = axes, numpy.array(group["cumulative_variance"]), group
        return groups


def distance(axes, v):
    """Largest difference between the entries of two sets of axes, whatever the sign of each."""
    return numpy.abs(axes * numpy.sign(numpy.sum(axes * v, axis=0)) - v).max()


class Published(unittest.TestCase):
    def check(self, found, v, vaf):
        axes, cumulative, group = found
        self.assertEqual(group["phase"], "all")
        self.assertLess(numpy.abs(cumulative - numpy.cumsum(vaf)).max(), TOLERANCE)
        self.assertLess(distance(axes, v), TOLERANCE)

    def test_subject_by_object(self):
        groups = learnt("west_r2g_processed", "subject,object")
        v, vaf = published("SUBJECTbyOBJECT")
        self.assertEqual(len(groups), 25)
        for subject in range(5):
            for number, name in enumerate(OBJECTS):
                with self.subTest(subject=subject + 1, object=name):
                    self.check(groups[f"{subject + 1}/{name}"], v[:, :, subject, number], vaf[:, subject, number])
        # What the comparison is worth: the synergies of the next object are far outside the tolerance.
        self.assertGreater(distance(groups["1/scissors"][0], v[:, :, 0, 1]), 1e6 * TOLERANCE)

    def test_by_subject(self):
        groups = learnt("west_r2g_by_subject", "subject")
        v, vaf = published("bySubject")
        self.assertEqual(len(groups), 5)
        for subject in range(5):
            with self.subTest(subject=subject + 1):
                self.check(groups[str(subject + 1)], v[:, :, subject], vaf[:, subject])


if __name__ == "__main__":
    if not (RECORDINGS.exists() and PUBLISHED.exists()):
        print(f"skipped: {RECORDINGS} or {PUBLISHED} is absent (set OPPONENS_SHARED_DATA)")
        sys.exit(77)
    unittest.main()
