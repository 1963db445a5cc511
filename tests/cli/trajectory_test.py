# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Timed paths as joint trajectories for a controller: read back by Python's own readers, checked against the robot's limits."""
import csv
import json
import pathlib
import shutil
import tempfile
import unittest

from support import SOURCE, analysed_store, must, run

try:
    import yaml
except ImportError:  # only the reading of YAML is left out
    yaml = None

ROBOT = "models/ur5_allegro/ur5_allegro_right.yaml"
SPEED = 0.5


def rates(values, times):
    """Differences of rows by differences of times."""
    return [[(b - a) / (t - s) for a, b in zip(one, two)]
            for one, two, s, t in zip(values, values[1:], times, times[1:])]


class Trajectories(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.folder.name)
        cls.store = cls.root / "store"
        analysed_store(cls.store)
        world = ("--store", cls.store, "--scene", "models/scenes/cylinder_shelf.yaml")
        must("grasp", *world, "--group", "1", "--count", 1, "--max-trials", 1500)
        cls.plan = must("plan", *world, "--speed", SPEED)
        joints = {one["name"]: one for one in must("robot", ROBOT, "--samples", 0)["joints"]}
        cls.limits = [(joints[name]["velocity"], joints[name]["acceleration"])
                      for name in cls.plan["path"]["joint_names"]]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def export(self, form, *options):
        out = self.root / ("trajectory" + "".join(map(str, options)) + "." + form)
        must("export", "--store", self.store, "--format", "trajectory_" + form, "--out", out, *options)
        return out

    def points(self, message):
        """Times, positions, velocities, accelerations of a JointTrajectory."""
        self.assertEqual(message["joint_names"], self.plan["path"]["joint_names"])
        self.assertEqual(message["header"], {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""})
        points = message["points"]
        for point in points:
            self.assertEqual(set(point), {"positions", "velocities", "accelerations", "effort", "time_from_start"})
            self.assertLess(point["time_from_start"]["nanosec"], 10**9)
            for name in ("positions", "velocities", "accelerations"):
                self.assertEqual(len(point[name]), 22)
                self.assertTrue(all(isinstance(value, float) for value in point[name]))
        nanoseconds = [one["time_from_start"]["sec"] * 10**9 + one["time_from_start"]["nanosec"] for one in points]
        self.assertTrue(all(a < b for a, b in zip(nanoseconds, nanoseconds[1:])))
        return ([value * 1e-9 for value in nanoseconds],
                *([one[name] for one in points] for name in ("positions", "velocities", "accelerations")))

    def within(self, values, limits, share):
        return all(abs(value) <= share * limit for row in values for value, limit in zip(row, limits))

    def test_json_and_yaml_say_the_same_and_keep_the_limits(self):
        times, positions, velocities, accelerations = self.points(json.loads(self.export("json").read_text()))
        self.assertEqual(times[0], 0.0)
        self.assertAlmostEqual(times[-1], self.plan["path"]["times"][-1], places=8)
        self.assertEqual(positions[0], self.plan["path"]["waypoints"][0])
        self.assertEqual(positions[-1], self.plan["path"]["waypoints"][-1])
        speed, rate = ([limits[i] for limits in self.limits] for i in (0, 1))
        self.assertTrue(self.within(velocities, speed, 1.001 * SPEED))
        self.assertTrue(self.within(accelerations, rate, 1.001 * SPEED))
        self.assertTrue(self.within(rates(positions, times), speed, 1.01 * SPEED))
        self.assertFalse(self.within(velocities, speed, 0.5 * SPEED))  # the companion: half the limits are not kept
        self.assertFalse(self.within(accelerations, rate, 0.5 * SPEED))
        for at_rest in (0, -1):
            self.assertEqual(set(map(abs, velocities[at_rest])), {0.0})
        row = self.plan["path"]["pregrasp_row"]
        self.assertEqual(set(map(abs, self.plan["path"]["velocities"][row])), {0.0})
        if yaml:
            self.assertEqual(self.points(yaml.safe_load(self.export("yaml").read_text())),
                             (times, positions, velocities, accelerations))

    def test_a_period_samples_the_same_motion(self):
        times, positions, velocities, _ = self.points(json.loads(self.export("json", "--period", 0.004).read_text()))
        self.assertTrue(all(abs(b - a - 0.004) < 1e-8 for a, b in zip(times, times[1:-1])))
        speed, rate = ([limits[i] for limits in self.limits] for i in (0, 1))
        self.assertTrue(self.within(rates(positions, times), speed, 1.01 * SPEED))
        self.assertTrue(self.within(rates(velocities[:-1], times[:-1]), rate, 1.01 * SPEED))
        self.assertFalse(self.within(rates(velocities[:-1], times[:-1]), rate, 0.5 * SPEED))

    def test_csv(self):
        with self.export("csv").open() as file:
            rows = list(csv.reader(file))
        names = self.plan["path"]["joint_names"]
        self.assertEqual(rows[0], ["time_s", *names, *(f"{name} velocity" for name in names),
                                   *(f"{name} acceleration" for name in names)])
        numbers = [list(map(float, row)) for row in rows[1:]]
        path = self.plan["path"]
        self.assertEqual(numbers, [[time, *q, *v, *a] for time, q, v, a in zip(
            path["times"], path["waypoints"], path["velocities"], path["accelerations"])])

    def test_the_final_path_stays_with_its_boxes(self):
        one, = self.plan["runs"]
        for part in ("start", "goal"):
            self.assertLessEqual(one["box_distance"][part + "_final"], one["box_distance"][part + "_planned"] + 1e-9)
        self.assertEqual({(entry["of"]) for entry in one["human_likeness_all"]}, {"planned", "final"})
        self.assertAlmostEqual(one["duration_s"], self.plan["path"]["times"][-1])

    def test_acceleration_limits_of_the_robot_file(self):
        folder = self.root / "robot"
        shutil.copytree(SOURCE / "models/ur5_allegro", folder)
        file = folder / "ur5_allegro_right.yaml"
        text = file.read_text()
        joints = {}
        for given, word in (("{elbow_joint: 1.25}", None), ("{no_such: 1}", "no such arm or hand joint"),
                            ("{elbow_joint: -1}", "positive")):
            file.write_text(text + f"accelerations: {given}\n")
            if word is None:
                joints = {one["name"]: one for one in must("robot", file, "--samples", 0)["joints"]}
                continue
            code, _, err = run("robot", file, "--samples", 0)
            self.assertEqual((code, len(err.strip().splitlines())), (2, 1), err)
            self.assertIn(word, err)
        self.assertEqual(joints["elbow_joint"]["acceleration"], 1.25)
        wrist = joints["wrist_1_joint"]
        self.assertEqual(wrist["acceleration"], 2.0 * wrist["velocity"])  # the default

    def test_refused(self):
        out = self.root / "x"
        for arguments in (["--format", "trajectory_json", "--kind", "grasp", "--out", out],
                          ["--format", "csv", "--period", "0.1", "--out", out]):
            code, _, err = run("export", "--store", self.store, *arguments)
            self.assertEqual((code, len(err.strip().splitlines())), (2, 1), err)
            self.assertFalse(out.exists())


if __name__ == "__main__":
    unittest.main()
