# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""opponens quality: contact sets from JSON, their values, and what is said of bad ones."""
import json
import math
import pathlib
import tempfile
import unittest

from support import SHARED, must, run

REFERENCE = SHARED / "reference/graspit_quality_cases.json"


def ring(count=3, **fields):
    """Contacts on the equator of a sphere of radius 50 mm, pushing inward."""
    angles = [2 * math.pi * i / count for i in range(count)]
    return {"name": "ring", "mu": 0.5, "edges": 8, "model": "pcwf", "rho_mm": 50.0, "cog_mm": [0, 0, 0],
            "contacts": [{"p": [50 * math.cos(a), 50 * math.sin(a), 0],
                          "n_into_object": [-math.cos(a), -math.sin(a), 0]} for a in angles], **fields}


class Quality(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = pathlib.Path(self.folder.name) / "contacts.json"

    def score(self, *cases, options=(), code=0):
        self.file.write_text(json.dumps({"cases": list(cases)}))
        return must("quality", self.file, *options, code=code)["cases"]

    def refused(self, document, *expected):
        self.file.write_text(document if isinstance(document, str) else json.dumps(document))
        code, out, err = run("quality", self.file)
        self.assertEqual((code, out), (2, ""))
        for part in (str(self.file), *expected):
            self.assertIn(part, err)

    def test_a_sphere_held_by_three(self):
        case, = self.score(ring(edges=4))
        self.assertEqual(case["name"], "ring")
        self.assertEqual([result["norm"] for result in case["results"]], ["L1", "Linf"])
        first, second = case["results"]
        self.assertAlmostEqual(first["min_weight"], 1 / 12, 12)  # all 12 weights are equal by symmetry
        for result in case["results"]:
            self.assertEqual((result["state"], result["force_closure"], result["certified"]),
                             ("force_closure", True, True))
            self.assertGreater(result["volume"], 0)
        self.assertGreater(second["epsilon"], first["epsilon"])
        code, out, _ = run("quality", self.file, "--no-volume")
        self.assertEqual(code, 0)
        self.assertIn("force closure", out)
        self.assertIn("certified", out)

    def test_other_states(self):
        pinch = ring(2, name="pinch")
        above = ring(name="above", mu=0.3)
        for contact in above["contacts"]:
            contact["p"][2] = 50
            contact["n_into_object"][2] = -1  # any length: it is a direction
        nothing = {"name": "nothing", "contacts": []}
        cases = self.score(pinch, above, nothing, options=("--no-volume",))
        for result in cases[0]["results"] + cases[2]["results"]:
            self.assertEqual((result["state"], result["epsilon"], result["certified"]), ("rank_deficient", None, False))
        for result in cases[1]["results"]:
            self.assertEqual((result["state"], result["certified"]), ("not_force_closure", False))
            self.assertLess(result["epsilon"], 0)
            self.assertLess(result["min_weight"], 0)

    def test_options_win_over_the_file(self):
        def epsilon(*options):
            return self.score(ring(), options=("--norm", "L1", "--no-volume", *options))[0]["results"][0]["epsilon"]
        base = epsilon()
        self.assertGreater(epsilon("--mu", 0.8), base)
        self.assertLess(epsilon("--edges", 4), base)
        self.assertLess(epsilon("--unit", "force"), base)
        self.assertGreater(epsilon("--cone", "quadratic"), base)
        result = self.score(ring(), options=("--norm", "L1", "--cone", "quadratic", "--gap", "0.01"))[0]["results"][0]
        self.assertLessEqual(result["epsilon_gap"], 0.0102)
        self.assertIsNone(result["volume"])
        fine = epsilon("--edges", 64)
        self.assertGreater(result["epsilon"] * 1.011, fine)
        plain, = self.score(ring(), options=("--norm", "Linf", "--no-volume", "--certificate"))[0]["results"]
        self.assertIsNone(plain["volume"])
        self.assertGreaterEqual(len(plain["certificate"]), 7)
        self.assertTrue(all(int(edge["coefficient"]) > 0 for edge in plain["certificate"]))
        self.assertEqual(self.score(ring(), options=("--at-least", "0.9", "--no-volume"))[0]["results"][0]["state"], "below_incumbent")
        frictionless, = self.score(ring(), options=("--model", "frictionless", "--norm", "L1"))[0]["results"]
        self.assertEqual(frictionless["state"], "rank_deficient")
        code, _, err = run("quality", self.file, "--model", "soft_finger")
        self.assertEqual(code, 2)
        self.assertIn("torsion_radius_mm", err)

    def test_weight_and_disturbances(self):
        palm = ring(name="palm", mu=0.0, model="frictionless", mass_kg=2.0, down=[0, 0, -1],
                    disturbances=[{"force": [0, 0, -3]}, {"force": [1, 0, 0], "torque": [0, 0, 0.1]}])
        for contact in palm["contacts"]:
            contact["n_into_object"] = [0, 0, 1]
        result = self.score(palm, options=("--norm", "L1"))[0]["results"][0]
        self.assertFalse(result["force_closure"])
        self.assertAlmostEqual(result["gravity"]["force_n"], 2 * 9.80665, 6)  # it carries just the weight
        self.assertEqual((result["disturbances"]["factor"], result["disturbances"]["limiting"]), (0.0, 1))

    def test_forms(self):
        self.file.write_text(json.dumps({"mu": 0.5, "rho_mm": 50.0, "cog_mm": [0, 0, 0], "grasps": [
            {"rank": 1, "contacts": [{"p": c["p"], "n": c["n_into_object"]} for c in ring()["contacts"]]}]}))
        grasps = must("quality", self.file, "--no-volume")["cases"]
        self.file.write_text(json.dumps(ring()))
        single = must("quality", self.file, "--no-volume")["cases"]
        self.file.write_text(json.dumps([ring()]))
        listed = must("quality", self.file, "--no-volume")["cases"]
        self.assertEqual(grasps[0]["results"], single[0]["results"])
        self.assertEqual(single, listed)

    def test_norms(self):
        def norms(*options, **fields):
            case, = self.score(ring(**fields), options=("--no-volume", *options))
            return [result["norm"] for result in case["results"]]
        self.assertEqual(norms(), ["L1", "Linf"])
        self.assertEqual(norms(norm="Linf"), ["Linf"])
        self.assertEqual(norms(norm=["Linf", "L1"]), ["Linf", "L1"])
        self.assertEqual(norms(results=[{"norm": "L1"}]), ["L1"])
        self.assertEqual(norms("--norm", "both", norm="L1"), ["L1", "Linf"])

    def test_bad_input(self):
        self.refused({"cases": [ring(norm="L2")]}, "cases[0].norm", "L1 or Linf", "L2")
        self.refused("{", "not JSON")
        self.refused({}, "cases", "expected a list of contact sets", "null")
        self.refused({"cases": []}, "at least one contact set")
        self.refused({"cases": [{"name": "x"}]}, "cases[0].contacts")
        self.refused({"cases": [ring(edges=2)]}, "cases[0].edges", "3 to 1024", "found 2")
        self.refused({"cases": [ring(edges=3.5)]}, "cases[0].edges", "whole number")
        self.refused({"cases": [ring(mu=-0.1)]}, "cases[0].mu", "friction", "-0.1")
        self.refused({"cases": [ring(model="rubber")]}, "cases[0].model", "soft_finger", "rubber")
        self.refused({"cases": [ring(model="soft")]}, "torsion_radius_mm", "soft finger")
        self.refused({"cases": [ring(rho_mm=0)]}, "cases[0].rho_mm", "> 0", "found 0")
        self.refused({"cases": [ring(mass_kg=1)]}, "cases[0].down", "direction of gravity")
        bad = ring()
        bad["contacts"][1]["p"] = [1, 2]
        self.refused({"cases": [ring(), bad]}, "cases[1].contacts[1].p", "3 numbers (mm)", "[1,2]")
        bad["contacts"][1] = {"p": [1, 2, 3], "n_into_object": [0, 0, 0]}
        self.refused({"cases": [bad]}, "cases[0].contacts[1].n_into_object", "not zero")
        code, _, err = run("quality", self.file.with_name("absent.json"))
        self.assertEqual(code, 2)
        self.assertIn("cannot be read", err)

    @unittest.skipUnless(REFERENCE.exists(), "no reference data")
    def test_reference_cases(self):
        """GraspIt!'s own sets: qhull's values for L1; GraspIt!'s for Linf."""
        wanted = json.loads(REFERENCE.read_text())["cases"]
        cases = must("quality", REFERENCE)["cases"]
        self.assertEqual([case["name"] for case in cases], [case["name"] for case in wanted])
        closures = 0
        for case, reference in zip(cases, wanted):
            results = {result["norm"]: result for result in case["results"]}
            for one in reference["results"]:
                with self.subTest(case=case["name"], norm=one["norm"]):
                    result = results[one["norm"]]
                    clean = one.get("qhull_Qt", one["graspit"])
                    epsilon = clean.get("min_offset")
                    closed = epsilon is not None and epsilon > 0
                    self.assertEqual(result["force_closure"], closed)
                    self.assertEqual(result["certified"], closed)
                    if closed:
                        closures += 1
                        self.assertAlmostEqual(result["epsilon"] / epsilon, 1, delta=1e-6)
                        self.assertAlmostEqual(result["volume"] / clean["volume"], 1, delta=1e-4)
                    else:
                        self.assertIn(result["state"], ("not_force_closure", "rank_deficient"))
                        self.assertFalse((result["epsilon"] or -1) > 0)
        self.assertGreater(closures, 25)


if __name__ == "__main__":
    unittest.main()
