# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Damaged HDF5 and MATLAB files, 1,000 of each: the reader lives, answers in time, and what it accepts is what an
independent reader (h5py; mat_file.py) takes from the same bytes. Where check sums guard the values, it is also what the
file held before the damage; elsewhere no reader can tell, and how many accepted files hold other values is printed."""
import json
import os
import pathlib
import random
import select
import subprocess
import sys
import tempfile

import h5py
import numpy

import mat_file

PROGRAM = os.environ["OPPONENS_READ_FOREIGN"]
COUNT = int(os.environ.get("OPPONENS_MUTATIONS", "1000"))
LONGEST = 90.0  # s for one file: the child's own limit is 60

MATLAB = """name: mutated
recordings: {files: '.*mat'}
table: {format: matlab, variable: X, columns: 3, cells: [{name: subject, values: ['1', '2']}, {name: object, values: [a, b]}]}
labels: {subject: subject, object: object}
time: none
channels: [{column: '1', joint: I_MCP}, {column: '2', joint: I_PIP}, {column: '3', joint: I_DIP}]
"""
HDF5 = """name: mutated
recordings: {files: '.*h5'}
table: {format: hdf5, group: data}
labels: {object: group}
time: {rate: 50}
channels: [{column: 'obs/q:1', joint: I_MCP}, {column: 'obs/q:2', joint: I_PIP}, {column: 'obs/p', joint: I_DIP}]
"""


def line_of(process, path):
    """The next line that a process writes; it writes whole lines."""
    ready, _, _ = select.select([process.stdout], [], [], LONGEST)
    if not ready:
        process.kill()
        raise AssertionError(f"{path}: no answer within {LONGEST} s")
    return process.stdout.readline()


def matlab_seeds(folder, rng):
    """Bytes, and whether check sums guard the values."""
    cells = numpy.empty((2, 2), object)
    for place in numpy.ndindex(2, 2):
        cells[place] = rng.normal(size=(12, 3)).round(3)
    for compress in (False, True):
        mat_file.write(folder / "seed.mat", {"other": numpy.eye(3), "X": cells}, compress)
        yield (folder / "seed.mat").read_bytes(), compress


def hdf5_seeds(folder, rng):
    for settings in ({}, {"compression": "gzip", "chunks": True}, {"fletcher32": True, "chunks": True}):
        with h5py.File(folder / "seed.h5", "w") as file:
            for number in range(2):
                group = file.create_group(f"data/demo_{number}")
                group.attrs["num_samples"] = 12
                group.create_dataset("obs/q", data=rng.normal(size=(12, 2)), **settings)
                group.create_dataset("obs/p", data=rng.normal(size=12).astype("f4"), **settings)
        yield (folder / "seed.h5").read_bytes(), bool(settings)


def mutated(seed, dice):
    """Flipped bits, replaced runs, swapped pieces, a cut."""
    data = bytearray(seed)
    for _ in range(dice.choice((1, 1, 1, 2, 8))):
        at = dice.randrange(len(data))
        kind = dice.randrange(6)
        if kind <= 1:
            data[at] ^= 1 << dice.randrange(8)
        elif kind == 2:
            data[at] = dice.choice((0, 1, 0x7F, 0x80, 0xFF))
        elif kind == 3:
            size = dice.choice((2, 4, 8))
            data[at:at + size] = dice.choice((b"\0", b"\xff", b"\x7f")) * len(data[at:at + size])
        elif kind == 4:
            other = dice.randrange(len(data))
            size = dice.randrange(1, 64)
            data[at:at + size] = data[other:other + size]
        elif len(data) > 300:
            del data[at:len(data) if dice.randrange(2) else at + dice.randrange(1, 32)]
        if len(data) < 2:
            break
    return bytes(data)


def expected_matlab(file):
    cells = mat_file.variable(file, "X")
    assert cells.shape == (2, 2)
    return {f"{subject + 1}_{'ab'[other]}": cells[subject, other] for subject, other in numpy.ndindex(2, 2)}


H5PY = """import h5py, json, sys
for path in sys.stdin:
    try:
        with h5py.File(path.strip(), "r") as file:
            answer = {name: [group["obs/q"][()].tolist(), group["obs/p"][()].tolist()]
                      for name, group in file["data"].items()}
    except Exception as error:
        answer = {"refused": [str(error)]}
    print(json.dumps(answer), flush=True)
"""


class H5pyReader:
    """h5py in a process of its own: libhdf5 can crash or hang there too."""

    def __init__(self):
        self.process = None

    def __call__(self, file):
        if self.process is None:
            self.process = subprocess.Popen([sys.executable, "-c", H5PY], stdin=subprocess.PIPE,
                                            stdout=subprocess.PIPE, text=True)
        self.process.stdin.write(f"{file}\n")
        self.process.stdin.flush()
        try:
            line = line_of(self.process, file)
        except AssertionError:
            self.process = None
            raise
        if not line:
            self.process = None
            raise ValueError("h5py crashed")
        groups = json.loads(line)
        if "refused" in groups:
            raise ValueError(groups["refused"][0])
        return {name: numpy.column_stack([numpy.array(q), numpy.array(p)]) for name, (q, p) in groups.items()}


def same(recordings, expected, stem):
    got = {one["id"].removeprefix(stem + "_"): numpy.array(one["values"]) for one in recordings}
    return got.keys() == expected.keys() and all(numpy.array_equal(got[name], expected[name]) for name in got)


def run(folder, kind, yaml, seeds, expected):
    description = folder / f"{kind}.yaml"
    description.write_text(yaml)
    dice = random.Random(f"mutations of {kind}")
    seeds = list(seeds)
    with subprocess.Popen([PROGRAM, description], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as program:
        def answer(path):
            program.stdin.write(f"{path}\n")
            program.stdin.flush()
            line = line_of(program, path)
            assert line, f"{path}: the program ended"
            return json.loads(line)

        truths = []
        for number, (seed, _) in enumerate(seeds):  # companion: what is intact is read
            path = folder / f"intact_{number}.{kind}"
            path.write_bytes(seed)
            got = answer(path)
            assert "refused" not in got and same(got["recordings"], expected(path), path.stem), got
            truths.append(expected(path))
        accepted = 0
        changed = [0] * len(seeds)  # accepted, with other values than before the damage
        wrong = []
        reasons = {}
        for number in range(COUNT):
            path = folder / f"mutation_{number}.{kind}"
            seed, guarded = seeds[number % len(seeds)]
            path.write_bytes(mutated(seed, dice))
            got = answer(path)
            if "refused" in got:
                assert path.name in got["refused"], got
                reason = "was ended by" if "was ended by" in got["refused"] else "refused"
                reasons[reason] = reasons.get(reason, 0) + 1
                path.unlink()
                continue
            accepted += 1
            try:
                truth = expected(path)
                good = same(got["recordings"], truth, path.stem)
                why = "" if good else "other values"
            except Exception as error:  # the other reader's refusal, of whatever kind
                good, why = False, f"refused by the other reader: {error}"
            if not same(got["recordings"], truths[number % len(seeds)], path.stem):
                changed[number % len(seeds)] += 1
                if guarded:
                    good, why = False, why or "check sums did not tell of other values than before the damage"
            if not good:
                wrong.append((number, why))
            else:
                path.unlink()
        program.stdin.close()
        assert program.wait(timeout=60) == 0
    print(f"{kind}: {COUNT} files, {accepted} accepted, {len(wrong)} of them wrongly, {reasons}; "
          f"changed, per seed: {changed}, with check sums: {[guarded for _, guarded in seeds]}")
    for number, why in wrong[:10]:
        print(f"  mutation {number}: {why}")
    return wrong


def main():
    rng = numpy.random.default_rng(5)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(os.environ.get("OPPONENS_KEEP", name))
        wrong = run(folder, "mat", MATLAB, matlab_seeds(folder, rng), expected_matlab)
        wrong += run(folder, "h5", HDF5, hdf5_seeds(folder, rng), H5pyReader())
    return 1 if wrong else 0


sys.exit(main())
