# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""report: shows the recordings that the newest synergies were made from, whatever the store holds beside them."""
import pathlib
import re
import tempfile
import unittest

import numpy

from support import HEADER, SOURCE, data_set, must

SOURCE_YAML = "models/sources/west_r2g.yaml"
DRAWN = "Synergy 1 of "


def movement(samples, turn):
    """Fingers that move together in one way up to the share `turn` of the samples, in another after it."""
    lines = [HEADER]
    for i in range(samples):
        before, after = min(i, turn * samples) / samples, max(0.0, i - turn * samples) / samples
        noise = [0.01 * numpy.sin(0.37 * i * (1 + j)) for j in range(23)]
        values = [0.2 + before * (0.3 + 0.02 * j) + after * (1.0 - 0.09 * j) + noise[j] for j in range(23)]
        lines.append(",".join([f"{i / 100:.3f}"] + [f"{value:.6f}" for value in values]))
    return lines


class Report(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.store = self.folder / "store"

    def ingest(self, name, turns, source=SOURCE_YAML):
        data = data_set(self.folder / name, {f"r{i}": movement(200 + 10 * i, turn) for i, turn in enumerate(turns)})
        must("ingest", data, "--store", self.store, "--source", source)

    def analyze(self, *options):
        return must("analyze", "--store", self.store, "--group-by", "object", *options)

    def page(self):
        must("report", "--store", self.store, "--out", self.folder / "report.html")
        return (self.folder / "report.html").read_text()

    def test_shows_what_was_analysed(self):
        self.ingest("data", (0.4, 0.5, 0.6))
        must("retarget", "--store", self.store, "--mapping", "joint")
        self.analyze()
        page = self.page()
        self.assertTrue(DRAWN in page)
        self.assertTrue("with --mapping joint." in page)
        must("retarget", "--store", self.store, "--mapping", "fingertip")  # newer, and nobody analysed it
        page = self.page()
        self.assertTrue("with --mapping joint." in page)
        self.assertFalse("with --mapping fingertip." in page)
        self.analyze("--input", "glove")
        page = self.page()
        self.assertFalse("with --mapping " in page)
        self.assertFalse(DRAWN in page)  # a glove has no shape to draw
        self.assertTrue("its shape cannot be drawn" in page)

    def test_equal_names_of_two_sources_keep_their_transitions(self):
        other = self.folder / "other.yaml"
        text = (SOURCE / SOURCE_YAML).read_text()
        other.write_text(re.sub(r"(?m)^name: .*$", "name: another", text))
        self.assertNotEqual(other.read_text(), text)
        self.ingest("one", (0.3, 0.35, 0.4))
        self.ingest("two", (0.6, 0.65, 0.7), other)
        found = self.analyze("--input", "glove")["transitions"]
        fractions = {(one["method"], one["source"], one["demonstration"]): one["fraction"] for one in found}
        self.assertEqual(len(fractions), 12)
        apart = [value - fractions["changepoint", source, name]
                 for (method, source, name), value in fractions.items() if method == "likeness"]
        row = re.search(r"likeness - change point</th>(.*?)</tr>", self.page(), re.S).group(1)
        count, mean = (float(cell) for cell in re.findall(r">([-0-9.]+)</td>", row)[:2])
        self.assertEqual(count, 6)
        self.assertAlmostEqual(mean, sum(apart) / 6, delta=0.0006)
        self.assertGreater(abs(sum(apart[:3]) - sum(apart[3:])) / 3, 0.002)  # else one source's could pass for both's

    def test_without_a_split_no_rule_is_in_force(self):
        self.ingest("data", (0.4, 0.5, 0.6))
        self.analyze("--input", "glove")
        self.assertTrue("In force here: likeness." in self.page())
        self.analyze("--input", "glove", "--phase", "none")
        page = self.page()
        self.assertFalse("In force here" in page)
        self.assertTrue("No split was made here" in page)


if __name__ == "__main__":
    unittest.main()
