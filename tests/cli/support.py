# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the opponens program and looks at what it leaves behind."""
import contextlib
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import time

import h5py

sys.path.append(str(pathlib.Path(__file__).parent.parent / "storage"))
from read_with_h5py import content_hash, read_object  # noqa: E402

PROGRAM = os.environ["OPPONENS_PROGRAM"]
SOURCE = pathlib.Path(os.environ["OPPONENS_SOURCE_DIR"])
SHARED = pathlib.Path(os.environ["OPPONENS_SHARED_DATA"])


HEADER = "t_s," + ",".join(
    [f"T_{joint}" for joint in ("ROT", "MCP", "IP", "ABD")]
    + [f"{finger}_{joint}" for finger in "IMRL" for joint in ("MCP", "PIP", "DIP", "ABD")]
    + ["PALM_ARCH", "W_PITCH", "W_YAW"])


def rows(count=200, rate=100.0):
    return [",".join([f"{i / rate:.3f}"] + [f"{0.005 * i * (1 + j % 3):.4f}" for j in range(23)]) for i in range(count)]


def data_set(folder, recordings):
    """A data set in the form of west_r2g, of one subject: name -> lines of a CSV."""
    folder = pathlib.Path(folder)
    (folder / "csv").mkdir(parents=True)
    index = ["file,subject,object,repetition,samples,duration_s"]
    for number, (name, lines) in enumerate(recordings.items()):
        (folder / "csv" / f"{name}.csv").write_text("\n".join(lines) + ("\n" if lines else ""))
        index.append(f"{name}.csv,1,cup,{number + 1},200,2")
    (folder / "index.csv").write_text("\n".join(index) + "\n")
    return folder


def run(*arguments, cwd=None, env=None):
    """Exit code, stdout, stderr."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, cwd=cwd or SOURCE,
                          env={**os.environ, **(env or {})})
    return done.returncode, done.stdout, done.stderr


def analysed_store(store, repetitions=2):
    """Simulated recordings, mapped to the hand, and their synergies; what `analyze` says."""
    must("simulate", "--store", store, "--repetitions", repetitions)
    must("retarget", "--store", store)
    return must("analyze", "--store", store)


def start(*arguments, cwd=None):
    """The running program."""
    return subprocess.Popen([PROGRAM, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                            cwd=cwd or SOURCE)


def wait_for_cpu_time(program, seconds):
    """Until the program has used that much, on a busy machine too, or has ended."""
    while program.poll() is None:
        used = pathlib.Path(f"/proc/{program.pid}/stat").read_text().rsplit(")", 1)[1].split()[11:13]
        if sum(map(int, used)) >= seconds * os.sysconf("SC_CLK_TCK"):
            return
        time.sleep(0.1)


def written_since(store, moment):
    """Whether an object file of the store was written after that time; others may vanish meanwhile."""
    for file in store.glob("*.h5"):
        with contextlib.suppress(FileNotFoundError):
            if file.stat().st_mtime > moment:
                return True
    return False


def must(*arguments, code=0, **options):
    """The JSON document of a command that has to end with the given exit code."""
    got, out, err = run(*arguments, "--json", **options)
    assert got == code, f"{arguments}: exit {got}, expected {code}\n{out}{err}"
    return json.loads(out)


def snapshot(store):
    """Name and content of every object file of a store; index and run log may differ."""
    store = pathlib.Path(store)
    if not store.exists():
        return None
    return {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in sorted(store.glob("*.h5"))}


def forge(store, kind, change):
    """Changes the fields of every object of a kind, and the hashes so that they fit: what a damaged file cannot be."""
    for path in sorted(store.glob("*.h5")):
        with h5py.File(path, "r") as file:
            numbers = [number for number, group in file["objects"].items() if group.attrs["kind"] == kind]
        if numbers:
            with h5py.File(path, "r+") as file:  # closing cuts off the contents behind the HDF5 bytes
                for number in numbers:
                    group = file["objects"][number]
                    change(group["fields"])
                    group.attrs["id"] = content_hash(read_object(group))
            path.rename(path.with_name(f"{path.stem.split('-')[0]}-{hashlib.sha256(path.read_bytes()).hexdigest()[:32]}.h5"))
    (store / "index.bin").unlink()


def without_run_log(page):
    return re.sub(r"<!-- run-log begin -->.*?<!-- run-log end -->", "", page, flags=re.S)
