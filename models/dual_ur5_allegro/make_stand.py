#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes stand.urdf beside itself: the stand of the paper's dual-arm robot, of primitives.

Frame: x to the robot's right, y forward, z up, origin in the middle of the crossbar between the shoulders; the floor is
at z = -1.4061 m. It is the frame in which The Kautham Project publishes the poses of the two arms (see the robot.yaml).
Sources
  Every number is measured by us on the stand's mesh that The Kautham Project publishes (structure.stl of
  iocroblab/kautham, turned into the frame by the pose that its problem file waterNoPMD.xml gives): planes of its facets
  for the boxes, sections for the tubes (all of 88.9 mm diameter).
  Simplified by us: the ends of the tubes are cut square, the corners of the table are not rounded, profiles are solid, and
  so is the platform, which is hollow from below.
"""
from math import cos, pi, radians, sqrt, tan
from pathlib import Path

TUBE = 0.04445
FLOOR, PLATFORM_TOP, FEET_TOP = -1.4061, -1.2694, -1.2594
BEAM_BOTTOM, BEAM_TOP, TABLE_TOP = -0.6594, -0.6194, -0.6144
FRONT_LEG_Y = 0.485
STRUT_TOP, STRUT_ANGLE = -0.7593, radians(30)  # on the column's axis; from the vertical
BRACE = 0.433, (0, 0.2915, -0.7503), radians(-30)  # length, middle, about x


def shape(geometry, xyz, rpy=(0, 0, 0)):
    numbers = [" ".join(f"{value + 0.0:.9g}" for value in xyz), " ".join(f"{value + 0.0:.17g}" for value in rpy)]
    return (f'    <collision><origin xyz="{numbers[0]}" rpy="{numbers[1]}"/><geometry>{geometry}</geometry>'
            '</collision>')


def box(lower, upper):
    size = " ".join(f"{u - l:.9g}" for l, u in zip(lower, upper))
    return shape(f'<box size="{size}"/>', [(l + u) / 2 for l, u in zip(lower, upper)])


def tube(length, middle, rpy=(0, 0, 0), radius=TUBE):
    return shape(f'<cylinder radius="{radius:.9g}" length="{length:.9g}"/>', middle, rpy)


def strut(side):
    height = STRUT_TOP - FEET_TOP
    reach = height * tan(STRUT_ANGLE)
    return tube(height / cos(STRUT_ANGLE), (side * reach / 2, 0, (STRUT_TOP + FEET_TOP) / 2),
                (0, -side * STRUT_ANGLE, 0))


def mounting_plate(side):
    """The disc under an arm's base, 163 to 173 mm from the origin, facing down and outward at 45 degrees."""
    return tube(0.01, (side * 0.168 / sqrt(2) * 2 - side * 0.0035, 0, -0.0035), (0, side * radians(135), 0), 0.0735)


def stand():
    beam = FRONT_LEG_Y - 0.02, FRONT_LEG_Y + 0.02
    length, middle, about_x = BRACE
    column = [box((-0.41, -0.36, FLOOR), (0.41, 0.86, PLATFORM_TOP)),
              box((-0.37, -0.05, PLATFORM_TOP), (0.37, 0.05, FEET_TOP)),
              box((-0.05, 0.05, PLATFORM_TOP), (0.05, 0.555, FEET_TOP)),
              tube(-FEET_TOP, (0, 0, FEET_TOP / 2)), strut(-1), strut(1)]
    shoulders = [tube(2 * 0.163 * sqrt(2), (0, 0, 0), (0, pi / 2, 0)), mounting_plate(-1), mounting_plate(1)]
    table = [tube(BEAM_BOTTOM - FEET_TOP, (0, FRONT_LEG_Y, (BEAM_BOTTOM + FEET_TOP) / 2)),
             box((-0.02, 0.035, BEAM_BOTTOM), (0.02, 0.705, BEAM_TOP)),
             box((-0.3, beam[0], BEAM_BOTTOM), (0.3, beam[1], BEAM_TOP)),
             shape(f'<box size="0.04 {length:.9g} 0.04"/>', middle, (about_x, 0, 0)),
             box((-0.4, 0.185, BEAM_TOP), (0.4, 0.785, TABLE_TOP))]
    links = []
    for name, shapes in (("column", column), ("shoulders", shoulders), ("table", table)):
        links += [f'  <link name="{name}">', *shapes, "  </link>"]
    for child in ("shoulders", "table"):
        links += [f'  <joint name="{child}_joint" type="fixed"><parent link="column"/><child link="{child}"/></joint>']
    return "\n".join(['<?xml version="1.0"?>', "<!-- SPDX-FileCopyrightText: 2026 The opponens authors",
                      "     SPDX-License-Identifier: BSD-3-Clause",
                      "     Written by make_stand.py, which names the sources. -->", '<robot name="stand">', *links,
                      "</robot>"]) + "\n"


(Path(__file__).resolve().parent / "stand.urdf").write_text(stand())
