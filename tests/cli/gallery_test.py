# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Grasps as the report shows them and as export writes them: the stored values, in every form."""
import csv
import html
import json
import pathlib
import re
import shutil
import tempfile
import unittest
import xml.etree.ElementTree

import numpy

from support import analysed_store, must, run, without_run_log

SCENE = "models/scenes/cylinder_shelf.yaml"


def wrenches_of(contact, convention):
    """[force; torque / rho] of the edges of a friction cone, as docs/algorithms/grasp_quality.md has them."""
    p, n = numpy.array(contact["p"]), numpy.array(contact["n"])
    t_x = numpy.cross(n, [1.0, 0.0, 0.0])
    t_x = t_x / numpy.linalg.norm(t_x)
    t_y = numpy.cross(n, t_x)
    result = []
    for edge in range(convention["edges"]):
        angle = 2 * numpy.pi * edge / convention["edges"]
        force = n + contact["mu"] * (numpy.cos(angle) * t_x + numpy.sin(angle) * t_y)
        torque = numpy.cross(p - numpy.array(convention["origin"]), force) / convention["rho"]
        result.append([*force, *torque])
    return numpy.array(result)


def rows_of(file):
    with open(file) as text:
        return list(csv.DictReader(text))


class Gallery(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.store = cls.folder / "store"
        analysed_store(cls.store)
        cls.world = ("--store", cls.store, "--scene", SCENE, "--noise-samples", 10)
        cls.found = must("grasp", *cls.world, "--group", 4, "--count", 2, "--min-trials", 64, "--max-trials", 640)
        cls.none = must("grasp", *cls.world, "--group", 1, "--trials", 1, "--mu", 0, code=1)
        cls.synergies = must("show", "--store", cls.store, "--kind", "synergy_set")["objects"][0]["id"]

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def record(self, identifier, store=None):
        return must("show", identifier, "--store", store or self.store)["object"]

    def page(self, store=None, *options):
        out = self.folder / "report.html"
        must("report", "--store", store or self.store, "--out", out, *options)
        return out.read_text()

    def section(self, page):
        return re.search(r'<section id="grasps">(.*?)</section>', page, re.S).group(1)

    # The report

    def test_report_shows_what_is_stored(self):
        section = self.section(self.page())
        cards = re.findall(r'<div class="card"><h4>.*?(?=<div class="card">|<h3>)', section, re.S)
        self.assertEqual(len(cards), len(self.found["grasps"]))
        for grasp in self.found["grasps"]:
            card = next(card for card in cards if f'title="{grasp["id"]}"' in card)
            facts = dict(re.findall(r"<dt>(.*?)</dt><dd>(.*?)</dd>", card))
            self.assertAlmostEqual(float(facts["\u03b5"]), grasp["epsilon"], delta=0.005 * grasp["epsilon"])
            self.assertAlmostEqual(float(facts["l*"]), grasp["min_weight"], delta=0.005 * grasp["min_weight"])
            slack = float(re.search(r"slack ([0-9.e-]+) rad", facts["posture"]).group(1))
            self.assertAlmostEqual(slack, grasp["slack"], delta=0.005 * grasp["slack"] + 1e-12)
            self.assertEqual("along the synergies" in facts["posture"], grasp["synergy_grasp"])
            self.assertEqual("yes" in facts["certified"], bool(grasp["certified"]))
            share = float(re.search(r"force closure in ([0-9.]+) %", facts["under errors"]).group(1))
            self.assertAlmostEqual(share, 100 * grasp["robust"]["force_closure"], delta=0.051)
            table = re.findall(r"<tr><th scope=\"row\">(\d+)</th>(.*?)</tr>", card)
            self.assertEqual([int(number) for number, _ in table], list(range(1, len(grasp["contacts"]) + 1)))
            for contact, (_, cells) in zip(grasp["contacts"], table):
                link, _, position, normal, mu = [html.unescape(one) for one in re.findall(r"<td[^>]*>(.*?)</td>", cells)]
                self.assertEqual(link, contact["link"])
                shown = [float(value) for value in position.split(",")]
                self.assertLess(numpy.abs(numpy.array(shown) - 1e3 * numpy.array(contact["p"])).max(), 0.051)
                shown = [float(value) for value in normal.split(",")]
                self.assertLess(numpy.abs(numpy.array(shown) - contact["n"]).max(), 0.00051)
                self.assertEqual(float(mu), contact["mu"])
            self.assertEqual(card.count("<svg xmlns="), 3)
            self.assertEqual(card.count('class="cone"'), 3 * len(grasp["contacts"]))

    def test_a_group_without_a_grasp_says_why(self):
        section = self.section(self.page())
        said = re.search(r"No grasp of [^<]* in 1 trial: 100 % ([^<]*?)\.", section)
        self.assertIsNotNone(said, section[:2000])
        self.assertEqual(html.unescape(said.group(1)), self.none["causes"][0]["cause"])

    def test_a_store_with_a_search_that_found_nothing_says_why(self):
        store = self.folder / "nothing"
        shutil.copytree(self.store, store)
        must("analyze", "--store", store, "--alpha", 0.04)  # newer synergies without grasps
        self.assertIn("No grasp has been found or searched yet.", self.section(self.page(store)))
        must("grasp", "--store", store, *self.world[2:], "--group", 1, "--trials", 1, "--mu", 0, code=1)
        self.assertRegex(self.section(self.page(store)), "No grasp of [^<]* in 1 trial: 100 % ")

    def test_equal_bytes_twice_and_pictures_are_well_formed(self):
        pictures = self.folder / "pictures"
        first = without_run_log(self.page())
        self.assertEqual(first, without_run_log(self.page(None, "--svg", pictures)))
        files = sorted(pictures.glob("grasps_*.svg"))
        drawings = [file for file in files if "What became of" not in file.read_text()]
        self.assertEqual(len(drawings), 3 * len(self.found["grasps"]))
        for file in files:
            root = xml.etree.ElementTree.parse(file).getroot()
            self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")

    # Export

    def exported(self, *options, store=None):
        out = pathlib.Path(tempfile.mkdtemp(dir=self.folder)) / "out"
        must("export", "--store", store or self.store, "--out", out, *options)
        return out

    def test_json_holds_the_stored_values(self):
        document = json.loads(self.exported("--kind", "grasp", "--format", "json").read_text())
        self.assertEqual(document["object"], self.found["object"])
        by_id = {grasp["id"]: grasp for grasp in document["grasps"]}
        self.assertEqual(set(by_id), {grasp["id"] for grasp in self.found["grasps"]})
        self.assertEqual({one["id"] for one in document["objects"]}, set(by_id))
        joints = self.record(self.synergies)["fields"]["joint_names"]
        for printed in self.found["grasps"]:
            grasp = by_id[printed["id"]]
            for key, value in printed.items():  # the same form as grasp --json, the same bits
                if key != "contacts":
                    self.assertEqual(grasp[key], value, key)
            fields = self.record(grasp["id"])["fields"]
            self.assertEqual(grasp["joints"], dict(zip(joints, fields["q_grasp"])))
            self.assertEqual(grasp["pregrasp"], dict(zip(joints, fields["q_pregrasp"])))
            self.assertEqual(numpy.reshape(grasp["X_OH"], (4, 4)).tolist(), fields["X_OH"])
            self.assertEqual(grasp["synergies"], self.synergies)
            self.assertEqual(grasp["state"], fields["quality.state"])
            convention = grasp["convention"]
            self.assertEqual({f"convention.{key}": value for key, value in convention.items()},
                             {key: value for key, value in fields.items() if key.startswith("convention.")})
            self.assertEqual((convention["model"], convention["unit"]), ("point_with_friction", "normal"))
            for i, contact in enumerate(grasp["contacts"]):
                self.assertEqual({key: contact[key] for key in ("link", "p", "n", "mu")}, printed["contacts"][i])
                self.assertEqual(contact["p"], fields["contact.p_OC"][i])
                self.assertLess(numpy.abs(wrenches_of(contact, convention) - contact["wrenches"]).max(), 1e-12)

    def test_epsilon_follows_from_the_exported_wrenches(self):
        """The stored direction is the outward normal of the facet that decides epsilon: its support value is epsilon."""
        document = json.loads(self.exported("--kind", "grasp", "--format", "json").read_text())
        for grasp in document["grasps"]:
            wrenches = numpy.concatenate([contact["wrenches"] for contact in grasp["contacts"]])
            self.assertEqual(numpy.linalg.matrix_rank(wrenches), 6)
            direction = numpy.array(self.record(grasp["id"])["fields"]["quality.direction"])
            support = (wrenches @ direction).max() / numpy.linalg.norm(direction)
            self.assertAlmostEqual(support, grasp["epsilon"], delta=1e-9)

    def test_csv_holds_the_same_numbers(self):
        document = json.loads(self.exported("--kind", "grasp", "--format", "json").read_text())
        folder = self.exported("--kind", "grasp", "--format", "csv")
        self.assertEqual([row["file"] for row in rows_of(folder / "index.csv")], ["grasps.csv", "contacts.csv", "wrenches.csv"])
        grasps = {row["id"]: row for row in rows_of(folder / "grasps.csv")}
        contacts, wrenches = rows_of(folder / "contacts.csv"), rows_of(folder / "wrenches.csv")
        self.assertEqual(len(grasps), len(document["grasps"]))
        self.assertEqual(len(contacts), sum(len(grasp["contacts"]) for grasp in document["grasps"]))
        for grasp in document["grasps"]:
            row = grasps[grasp["id"]]
            self.assertEqual((row["group"], row["object"], row["state"]), (grasp["group"], grasp["object"], grasp["state"]))
            self.assertEqual((float(row["epsilon"]), float(row["slack"])), (grasp["epsilon"], grasp["slack"]))
            self.assertEqual(row["volume"], "")  # was not computed
            self.assertEqual(row["synergy_grasp"], str(int(grasp["synergy_grasp"])))
            self.assertEqual([float(row[f"X_OH.{i}"]) for i in range(16)], grasp["X_OH"])
            self.assertEqual({name: float(row[f"joints.{name}"]) for name in grasp["joints"]}, grasp["joints"])
            self.assertEqual(float(row["convention.rho"]), grasp["convention"]["rho"])
            self.assertEqual(int(row["contacts"]), len(grasp["contacts"]))
            for number, contact in enumerate(grasp["contacts"], 1):
                line = next(one for one in contacts if one["grasp"] == grasp["id"] and int(one["contact"]) == number)
                self.assertEqual(line["link"], contact["link"])
                self.assertEqual([float(line[f"p_{axis}"]) for axis in "xyz"], contact["p"])
                self.assertEqual([float(line[f"n_{axis}"]) for axis in "xyz"], contact["n"])
                edges = [[float(one[f"{part}_{axis}"]) for part in "ft" for axis in "xyz"] for one in wrenches
                         if one["grasp"] == grasp["id"] and int(one["contact"]) == number]
                self.assertEqual(edges, contact["wrenches"])

    def test_a_grasp_whose_synergies_are_elsewhere_is_said_and_left_out(self):
        store = self.folder / "without"
        shutil.copytree(self.store, store)
        kept = [one["id"] for one in must("show", "--store", store)["objects"] if one["kind"] == "grasp"]
        objects = must("show", "--store", store)["objects"]
        (store / next(one["file"] for one in objects if one["id"] == self.synergies)).unlink()
        (store / "index.bin").unlink()
        out = self.folder / "left.json"
        code, _, err = run("export", "--store", store, "--kind", "grasp", "--format", "json", "--out", out)
        self.assertEqual(code, 0, err)
        self.assertIn("does not hold the synergies", err)
        document = json.loads(out.read_text())
        self.assertNotIn("grasps", document)
        self.assertEqual({one["id"] for one in document["objects"]}, set(kept))

    def test_what_was_exported_is_taken_back(self):
        out = self.exported("--kind", "grasp", "--format", "json")
        store = self.folder / "taken"
        shutil.copytree(self.store, store)
        document = must("grasp", "--store", store, *self.world[2:], "--import", out)
        self.assertEqual(document["refused"], [])
        self.assertEqual(len(document["grasps"]), len(self.found["grasps"]))
        self.assertEqual({grasp["origin"] for grasp in document["grasps"]}, {"imported"})
        poses = {tuple(grasp["X_OH"]) for grasp in self.found["grasps"]}
        self.assertEqual({tuple(grasp["X_OH"]) for grasp in document["grasps"]}, poses)
        section = self.section(self.page(store))
        self.assertIn("<dt>origin</dt><dd>imported</dd>", section)


if __name__ == "__main__":
    unittest.main()
