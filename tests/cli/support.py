# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the opponens program and looks at what it leaves behind."""
import hashlib
import json
import os
import pathlib
import re
import subprocess

PROGRAM = os.environ["OPPONENS_PROGRAM"]
SOURCE = pathlib.Path(os.environ["OPPONENS_SOURCE_DIR"])
SHARED = pathlib.Path(os.environ["OPPONENS_SHARED_DATA"])


def run(*arguments, cwd=None, env=None):
    """Exit code, stdout, stderr."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, cwd=cwd or SOURCE,
                          env={**os.environ, **(env or {})})
    return done.returncode, done.stdout, done.stderr


def start(*arguments, cwd=None):
    """The running program."""
    return subprocess.Popen([PROGRAM, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                            cwd=cwd or SOURCE)


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


def without_run_log(page):
    return re.sub(r"<!-- run-log begin -->.*?<!-- run-log end -->", "", page, flags=re.S)
