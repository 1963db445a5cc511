# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Every real data set is ingested, and what arrives is what small readers of our own find in the files."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy

from support import SHARED, SOURCE, must

sys.path.append(str(pathlib.Path(__file__).parent.parent / "storage"))
import mat_file  # noqa: E402

DEMOS = SHARED / "data" / "demos"
OBJECTS = ["scissors", "zip_tie", "screwdriver", "harness_tied", "harness_untied"]


def ingest(name, folder, store):
    """The summary of a real ingest, which the dry run has to have told before."""
    arguments = ("ingest", DEMOS / folder, "--source", f"models/sources/{name}.yaml", "--store", store)
    told = must(*arguments, "--dry-run")
    assert not told["stored"] and "ids" not in told
    document = must(*arguments)
    assert document["summary"] == told["summary"] and len(document["ids"]) == told["summary"]["recordings"]
    return document["summary"]


def recordings(name, folder):
    """Id -> labels and values, as the library reads them."""
    source = SOURCE / "models" / "sources" / f"{name}.yaml"
    done = subprocess.run([os.environ["OPPONENS_READ_FOREIGN"], source], input=f"{DEMOS / folder}\n",
                          capture_output=True, text=True, check=True)
    return {one["id"]: (one["labels"], numpy.array(one["values"])) for one in json.loads(done.stdout)["recordings"]}


def ranges(summary):
    return {one["name"]: (one["min_rad"], one["max_rad"]) for one in summary["channels"]}


def west_processed(store):
    cells = mat_file.variable(DEMOS / "west_r2g/mat/X_R2G_SUBJECTbyOBJECT_s1-5.mat", "X_R2G_SUBJECTbyOBJECT")
    assert ingest("west_r2g_processed", "west_r2g/mat", store)["samples"] == 20000
    got = recordings("west_r2g_processed", "west_r2g/mat")
    assert len(got) == 25
    for (subject, other), cell in numpy.ndenumerate(cells):
        labels, values = got[f"X_R2G_SUBJECTbyOBJECT_s1-5_{subject + 1}_{OBJECTS[other]}"]
        assert labels == {"subject": str(subject + 1), "object": OBJECTS[other], "kind": "postures",
                          "source": "west_r2g_processed"}
        assert values.shape == (800, 23) and numpy.array_equal(values, cell), "bit for bit"
    pages = mat_file.variable(DEMOS / "west_r2g/mat/X_R2G_bySubject_s1-5.mat", "X_R2G_bySubject")
    assert ingest("west_r2g_by_subject", "west_r2g/mat", store)["samples"] == 20000
    got = recordings("west_r2g_by_subject", "west_r2g/mat")
    for subject in range(5):
        assert numpy.array_equal(got[f"X_R2G_bySubject_s1-5_{subject + 1}"][1], pages[:, :, subject])


def west_raw(store):
    """The MATLAB cells split where time goes back are the recordings of the CSV files."""
    csv, mat = ingest("west_r2g", "west_r2g", store), ingest("west_r2g_mat", "west_r2g/mat", store)
    for summary in (csv, mat):
        assert summary["recordings"] == 100 and abs(summary["lowest_rate_hz"] - 50) < 1e-6
        assert summary["labels"]["object"] == {name: 20 for name in OBJECTS}
        assert [one["name"] for one in summary["channels"] if one["depends_on"]] == ["R_ABD"]
        assert next(one["depends_on"] for one in summary["channels"] if one["depends_on"]) == ["I_ABD", "M_ABD"]
    assert csv["samples"] == mat["samples"] and ranges(csv).keys() == ranges(mat).keys()
    one, two = recordings("west_r2g", "west_r2g"), recordings("west_r2g_mat", "west_r2g/mat")
    for labels, values in two.values():
        other = one[f"s{labels['subject']}_{labels['object']}_r{labels['repetition']}"][1]
        assert values.shape == other.shape and numpy.abs(values - other).max() < 1e-6, "CSV has 6 digits"


def graspdb14(store):
    summary = ingest("graspdb14", "graspdb14", store)
    assert summary["recordings"] == 3 and summary["labels"]["subject"] == {"01": 1, "03": 1, "04": 1}
    assert abs(summary["duration_s"] - 13.1) < 0.05 and abs(summary["largest_step_s"] - 0.032) < 1e-6
    columns = numpy.loadtxt(DEMOS / "graspdb14" / "r_01_11_ex03-rad-004-grasp-su04.txt")
    labels, values = recordings("graspdb14", "graspdb14")["r_01_11_ex03-rad-004-grasp-su04"]
    assert labels["object"] == "01_11" and labels["experiment"] == "03" and labels["repetition"] == "004"
    time = columns[:, 3] * 3600 + columns[:, 4] * 60 + columns[:, 5]
    grid = time[0] + numpy.arange(len(values)) / 60
    assert grid[-1] <= time[-1] + 1e-6 < grid[-1] + 1 / 60
    for channel, sign in ((0, -1), (3, 1), (5, -1), (22, 1)):
        want = sign * numpy.interp(grid, time, columns[:, 7 + channel])
        assert numpy.abs(values[:, channel] - want).max() < 1e-6


def vmg30(store):
    summary = ingest("vmg30", "vmg30", store)
    assert summary["labels"]["object"] == {"bottle": 22, "mouse": 26, "pen": 30, "rest": 30}
    assert summary["samples"] == 40117 and summary["dropped_channels"] == ["T_MCP", "L_PIP"]
    rows = numpy.array([[float(cell) for cell in line.replace(",", " ").split()]
                        for line in (DEMOS / "vmg30/bottle/0.txt").read_text().splitlines()])
    values = recordings("vmg30", "vmg30")["bottle_0"][1]
    assert numpy.abs(values[:, 1] - 1.57 * rows[:, 4] / 1000).max() < 1e-12
    assert abs(ranges(summary)["I_MCP"][1] - 1.57) < 1e-12


def mimic(store):
    summary = ingest("mimic_holding", "mimic_holding", store)
    assert summary["samples"] == 7200 and summary["labels"]["kind"] == {"postures": 144}
    assert set(summary["labels"]["object"].values()) == {24} and len(summary["labels"]["object"]) == 6
    rows = [line.split(",") for line in (DEMOS / "mimic_holding/data.csv").read_text().split()[1:]]
    angles = numpy.radians(numpy.array([row[:20] for row in rows], float))
    got = recordings("mimic_holding", "mimic_holding")
    stacked = numpy.vstack([values for _, values in got.values()])
    assert numpy.abs(stacked - angles).max() < 1e-13, "in the order of the file"
    assert abs(ranges(summary)["L_ABD"][1] - angles[:, 16].max()) < 1e-13


def allegro(store):
    summary = ingest("allegro_rosbag", "allegro_rosbag", store)
    assert summary["recordings"] == 1 and abs(summary["duration_s"] - 8.09) < 0.011
    kinds = {one["kind"] for one in must("show", "--store", store)["objects"] if "allegro" in one["name"]}
    assert kinds == {"hand_demonstration"}, kinds
    table = numpy.loadtxt(DEMOS / "allegro_rosbag/allegro_ros_jointstates.csv", delimiter=",", skiprows=1)
    (_, values), = recordings("allegro_rosbag", "allegro_rosbag").values()
    want = numpy.interp(numpy.arange(len(values)) / 100, table[:, 0], table[:, 2])
    assert numpy.abs(values[:, 1] - want).max() < 1e-12


def main():
    if not DEMOS.exists():
        print(f"skipped: {DEMOS} is absent")
        return 77
    for test in (west_processed, west_raw, graspdb14, vmg30, mimic, allegro):
        with tempfile.TemporaryDirectory() as folder:
            test(pathlib.Path(folder) / "store")
        print(f"{test.__name__}: ok")
    return 0


sys.exit(main())
