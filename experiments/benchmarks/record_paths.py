#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""COUNT planned paths, evenly out of a store, as JSON for verify_benchmark: record_paths.py OPPONENS STORE COUNT OUT"""
import json
import subprocess
import sys


def show(program, store, *what):
    told = subprocess.run([program, "show", "--store", store, *what, "--json"], check=True, capture_output=True, text=True)
    return json.loads(told.stdout)


def main():
    program, store, count, out = sys.argv[1:]
    paths = []
    stored = show(program, store, "--kind", "path")["objects"]
    for one in stored[::max(1, len(stored) // int(count))][:int(count)]:
        fields = show(program, store, one["id"])["object"]["fields"]
        grasp = show(program, store, fields["goal_grasp"])["object"]["fields"]
        links = sorted(set(grasp["contact.link"]))
        paths.append({"closing_from": fields["pregrasp_row"], "contact_links": links,
                      "waypoints": [[round(q, 9) for q in row] for row in fields["motion"]]})
    with open(out, "w", encoding="utf-8") as file:
        json.dump({"paths": paths}, file)
        file.write("\n")


main()
