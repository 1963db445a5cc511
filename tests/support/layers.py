#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""The `layers` test: fails on an include that the layering does not allow.

Usage: layers.py SOURCE_DIR. Prints each offence as file:line: reason. Also refused: a third-party header in a public
header (Eigen, tl::expected and the planner class's OMPL header excepted), and file access in algorithm modules.
"""
import pathlib
import re
import sys

ALLOWED = {
    "core": set(),
    "storage": {"core"},
    "analysis": {"core"},
    "robot": {"core"},
    "grasp": {"core", "analysis", "robot"},
    "motion": {"core", "analysis", "robot"},
    "verify": {"core", "analysis", "robot", "grasp"},
    "report": {"core", "analysis", "robot"},
}
HEADER_LIBRARIES = ("Eigen/", "tl/")
PLANNER_HEADER = "motion/ompl_planner.hpp"
INCLUDE = re.compile(r'^\s*#\s*include\s+([<"])([^">]+)[">]')


def offences(root: pathlib.Path):
    for module, allowed in ALLOWED.items():
        for path in sorted((root / module).rglob("*.[ch]pp")):
            name = path.relative_to(root).as_posix()
            for number, line in enumerate(path.read_text().splitlines(), 1):
                match = INCLUDE.match(line)
                if not match:
                    continue
                kind, target = match.groups()
                first = target.split("/")[0]
                if kind == '"':
                    if first not in allowed | {module}:
                        yield f"{name}:{number}: {module} may not include {target}"
                elif path.suffix == ".hpp" and ("/" in target or target.endswith((".h", ".hpp"))):
                    if name == PLANNER_HEADER and target.startswith("ompl/"):
                        continue
                    if not target.startswith(HEADER_LIBRARIES):
                        yield f"{name}:{number}: third-party header {target} in a public header"
                elif target == "fstream" and module in ("core", "analysis", "grasp", "motion", "verify", "report"):
                    yield f"{name}:{number}: {module} may not touch files"


def main() -> int:
    root = pathlib.Path(sys.argv[1])
    found = list(offences(root))
    print("\n".join(found) if found else "layers hold")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
