# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""MATLAB and HDF5 sources of every form that the reader knows, and refusals that name what is wrong."""
import json
import os
import pathlib
import subprocess
import tempfile

import h5py
import numpy

import mat_file

PROGRAM = os.environ["OPPONENS_READ_FOREIGN"]
CHANNELS = "channels: [{column: '1', joint: I_MCP}, {column: '2', joint: I_PIP, sign: -1}]\n"


def read(folder, yaml, path):
    description = folder / "source.yaml"
    description.write_text("name: made_up\nrecordings: {files: '(.*)\\.[a-z0-9]+', parts: [stem]}\n" + yaml)
    done = subprocess.run([PROGRAM, description], input=f"{path}\n", capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def values(answer):
    assert "recordings" in answer, answer
    return {one["id"]: numpy.array(one["values"]) for one in answer["recordings"]}


def refused(answer, *parts):
    for part in parts:
        assert part in answer.get("refused", ""), (part, answer)


def matlab(folder, rng):
    path = folder / "m.mat"
    sign = numpy.array([1, -1])
    cells = numpy.empty((2, 3), object)
    times = numpy.empty((2, 3), object)
    for place in numpy.ndindex(2, 3):
        rows = 4 + place[0] + place[1]
        cells[place] = rng.normal(size=(rows, 2))
        times[place] = numpy.arange(rows, dtype=float)[:, None] % 3  # two trials or three
    pages = rng.normal(size=(5, 2, 3))
    mat_file.write(path, {"X": cells, "t": times, "P": pages, "M": cells[0, 0], "N": cells[0, 0].T})
    layout = "labels: {subject: subject, object: object}\n"
    names = "[{name: subject, values: ['1', '2']}, {name: object, values: [a, b, c]}]"
    table = f"table: {{format: matlab, variable: X, columns: 2, cells: {names}}}\n"

    got = read(folder, table + layout + "time: none\n" + CHANNELS, path)
    assert [one["labels"]["object"] for one in got["recordings"]] == ["a", "a", "b", "b", "c", "c"]
    for (i, j), cell in numpy.ndenumerate(cells):
        assert numpy.array_equal(values(got)[f"m_{i + 1}_{'abc'[j]}"], cell * sign)
    joined = read(folder, table + "time: {variable: t}\nsplit: where_time_goes_back\n" + CHANNELS, path)
    refused(joined, "m.mat", "number of rows of 1_a is '1'")  # 4 rows: trials of 3 and 1
    for (i, j), cell in numpy.ndenumerate(cells):
        cells[i, j], times[i, j] = numpy.vstack([cell] * 3), numpy.tile(numpy.arange(len(cell)), 3)[:, None] / 50
    mat_file.write(folder / "x.mat", {"X": cells}, compress=False)
    mat_file.write(folder / "t.mat", {"t": times})
    got = values(read(folder, table + "time: {variable: t, file: t.mat}\nsplit: where_time_goes_back\n" + CHANNELS,
                      folder / "x.mat"))
    assert len(got) == 18 and all(numpy.array_equal(got[f"x_1_a_{k}"], got["x_1_a_1"]) for k in (2, 3))

    got = values(read(folder, "table: {format: matlab, variable: P, cells: [{name: s, values: [u, v, w]}]}\ntime: none\n"
                      + CHANNELS, path))
    assert all(numpy.array_equal(got[f"m_{'uvw'[k]}"], pages[:, :, k] * sign) for k in range(3))
    for variable, turned in (("M", "false"), ("N", "true")):
        got = values(read(folder, f"table: {{format: matlab, variable: {variable}, transposed: {turned}}}\ntime: none\n"
                          + CHANNELS, path))
        assert numpy.array_equal(got["m"], mat_file.variable(path, "M") * sign)

    none = "time: none\n" + CHANNELS
    refused(read(folder, "table: {format: matlab, variable: Q}\n" + none, path), "m.mat", "variable 'Q' is there 0 times")
    refused(read(folder, "table: {format: matlab, variable: X}\n" + none, path), "number of cells is '2 x 3'", "expected 1")
    refused(read(folder, "table: {format: matlab, variable: M, columns: 3}\n" + none, path), "number of columns is '2'")
    refused(read(folder, "table: {format: matlab, variable: M}\ntime: {variable: t}\n" + CHANNELS, path), "number of cells")
    (folder / "text.mat").write_text("hello")
    refused(read(folder, "table: {format: matlab, variable: X}\n" + none, folder / "text.mat"), "text.mat", "no header")
    bad = cells.copy()
    bad[0, 0] = numpy.full((4, 2), numpy.nan)
    mat_file.write(path, {"X": bad})
    refused(read(folder, table + none, path), "m.mat", "field '1' of 1_a in row 1 is 'nan'", "finite")


def hdf5(folder, rng):
    path = folder / "lift.hdf5"
    q = rng.normal(size=(9, 2))
    with h5py.File(path, "w") as file:
        for name in ("demo_0", "demo_1"):
            group = file.create_group(f"data/{name}")
            group.attrs["num_samples"] = len(q)
            group.attrs["task"] = "lift"
            group["obs/q"] = q + (name == "demo_1")
            group["obs/grip"] = numpy.arange(9, dtype="i4")
            group["obs/t"] = (numpy.arange(9) / 20).astype("f4")
        file["data/demo_1/obs/short"] = numpy.zeros(3)
    channels = "channels: [{column: 'obs/q:2', joint: I_MCP}, {column: obs/grip, joint: I_PIP, sign: -1}]\n"
    table = "table: {format: hdf5, group: data}\nlabels: {object: task, n: num_samples, stem: stem, repetition: group}\n"
    for time in ("{rate: 20}", "{column: obs/t}"):
        got = read(folder, table + f"time: {time}\n" + channels, path)
        assert values(got).keys() == {"lift_demo_0", "lift_demo_1"}
        assert numpy.array_equal(values(got)["lift_demo_1"], numpy.column_stack([q[:, 1] + 1, -numpy.arange(9.0)]))
        labels = got["recordings"][1]["labels"]
        assert labels == {"object": "lift", "n": "9", "stem": "lift", "repetition": "demo_1", "source": "made_up"}, labels
    one = read(folder, "table: {format: hdf5}\ntime: {rate: 5}\nchannels: [{column: 'data/demo_0/obs/q:1', joint: I_MCP}]\n",
               path)
    assert numpy.array_equal(values(one)["lift"], q[:, :1])

    rate = "table: {format: hdf5, group: data}\ntime: {rate: 20}\n"
    for column, parts in (("obs/q", ("one of the 2 columns",)), ("'obs/q:3'", ("one of the 2 columns",)),
                          ("obs/none", ("obs/none",)), ("'obs/q:x'", ("dataset:number",)), ("obs", ("obs",))):
        refused(read(folder, rate + f"channels: [{{column: {column}, joint: I_MCP}}]\n", path), "lift.hdf5", *parts)
    short = rate + "channels: [{column: obs/grip, joint: I_MCP}, {column: obs/short, joint: I_PIP}]\n"
    refused(read(folder, short, path), "lift.hdf5")
    refused(read(folder, rate.replace("data", "other") + channels, path), "other")
    (folder / "text.h5").write_text("hello")
    refused(read(folder, rate + channels, folder / "text.h5"), "text.h5")


def not_held(folder):
    """Values that libhdf5 gives and the file does not hold are refused."""
    one = "table: {format: hdf5}\ntime: {rate: 5}\nchannels: [{column: q, joint: I_MCP}]\n"
    q = numpy.linspace(1.0, 2.0, 64)
    path = folder / "q.h5"

    def made(make, **settings):
        with h5py.File(path, "w", **settings) as file:
            make(file)
        return read(folder, one, path)

    def partly(file, rows, **settings):
        file.create_dataset("q", (64,), "f8", chunks=(16,), **settings)[:rows] = q[:rows]

    # Companions: what is held is read; compression that would not help is left out by libhdf5, chunk by chunk.
    noise = numpy.frombuffer(numpy.random.default_rng(8).bytes(64 * 8), "u8").astype("u8") >> 1
    for settings in ({"userblock_size": 512}, {}):
        assert numpy.array_equal(values(made(lambda f: partly(f, 64), **settings))["q"][:, 0], q)
        assert numpy.array_equal(values(made(lambda f: f.create_dataset("q", data=q), **settings))["q"][:, 0], q)
    got = made(lambda f: f.create_dataset("q", data=noise, chunks=(16,), compression="gzip"))
    assert numpy.array_equal(values(got)["q"][:, 0], noise.astype("f8"))

    refused(made(lambda f: partly(f, 40)), "q.h5", "never written")
    refused(made(lambda f: partly(f, 64, fletcher32=True) or f["q"].id.write_direct_chunk((16,), b"\0" * 128, 1)),
            "q.h5", "without one of its filters")
    refused(made(lambda f: f.create_dataset("q", (64,), "f8")), "q.h5", "never written")
    layout = h5py.VirtualLayout((64,), "f8")
    layout[:] = h5py.VirtualSource("missing.h5", "q", (64,))
    refused(made(lambda f: f.create_virtual_dataset("q", layout)), "q.h5", "in other datasets")
    q.tofile(folder / "q.raw")
    refused(made(lambda f: f.create_dataset("q", (64,), "f8", external=[(str(folder / "q.raw"), 0, 512)])),
            "q.h5", "in other files")
    with h5py.File(folder / "other.h5", "w") as file:
        file["q"] = q
    refused(made(lambda f: f.__setitem__("q", h5py.ExternalLink("other.h5", "q"))), "q.h5")

    # The address of a chunk, and of contiguous values, moved behind the end of the file.
    def shifted(file):  # to an address that is found once
        file["p"] = numpy.zeros(999, "i1")
        file["q"] = q

    for make in (lambda f: partly(f, 64, fletcher32=True), shifted):
        made(make)
        with h5py.File(path, "r") as file:
            at = file["q"].id.get_offset() if file["q"].chunks is None else file["q"].id.get_chunk_info(3).byte_offset
        data = path.read_bytes()
        address = at.to_bytes(8, "little")
        assert data.count(address) == 1
        for end in (len(data), len(data) + 4096):
            path.write_bytes(data.replace(address, (end - 16).to_bytes(8, "little")))
            refused(read(folder, one, path), "q.h5", "beyond the end of the file")


def main():
    rng = numpy.random.default_rng(3)
    with tempfile.TemporaryDirectory() as name:
        matlab(pathlib.Path(name), rng)
        hdf5(pathlib.Path(name), rng)
        not_held(pathlib.Path(name))


main()
