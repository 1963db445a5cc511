#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes ur5.urdf and, for both hands, allegro_*.urdf and allegro_*.yaml beside itself.

Sources
  UR5: Denavit-Hartenberg table published by Universal Robots (d1 0.089159, a2 -0.425, a3 -0.39225, d4 0.10915,
  d5 0.09465, d6 0.0823 m; alpha pi/2, 0, 0, pi/2, -pi/2, 0), joint speeds of its data sheet (180 deg/s), elbow limited
  to half a turn as is usual for planning. Tube radii and lengths of the collision cylinders are rounded by us.
  Allegro hand, right: joint places, limits and box sizes published by Wonik Robotics with the hand.
Conventions
  Every joint of the arm turns about its frame's z axis: link frames are the Denavit-Hartenberg frames of the table.
  Right hand: x out of the palm, y to the index finger, z along the fingers; flexion is positive about y.
  Left hand: the right one mirrored in the plane y = 0 of the palm, so that equal joint positions are mirrored postures and
  synergies found for the right hand serve the left. Wonik's own left hand turns the abduction joints the other way.
"""
from math import cos, pi, radians, sin
from pathlib import Path

ARM = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
ARM_LINKS = ("base_link", "shoulder_link", "upper_arm_link", "forearm_link", "wrist_1_link", "wrist_2_link",
             "wrist_3_link")
ARM_ORIGINS = (((0, 0, 0), (0, 0, 0)), ((0, 0, 0.089159), (pi / 2, 0, 0)), ((-0.425, 0, 0), (0, 0, 0)),
               ((-0.39225, 0, 0), (0, 0, 0)), ((0, 0, 0.10915), (pi / 2, 0, 0)), ((0, 0, 0.09465), (-pi / 2, 0, 0)))
ALONG_X, ALONG_Y, ALONG_Z = (0, pi / 2, 0), (pi / 2, 0, 0), (0, 0, 0)
# link -> (radius, length, centre, direction): the tubes of upper arm and forearm lie 0.136 and 0.016 m beside the base
ARM_CYLINDERS = {
    "base_link": [(0.075, 0.025, (0, 0, 0.0125), ALONG_Z)],
    "shoulder_link": [(0.06, 0.12, (0, 0, 0.09), ALONG_Z)],
    "upper_arm_link": [(0.06, 0.13, (0, 0, 0.133), ALONG_Z), (0.055, 0.425, (-0.2125, 0, 0.136), ALONG_X),
                       (0.06, 0.12, (-0.425, 0, 0.137), ALONG_Z)],
    "forearm_link": [(0.058, 0.12, (0, 0, 0.017), ALONG_Z), (0.045, 0.39225, (-0.196125, 0, 0.016), ALONG_X),
                     (0.042, 0.11, (-0.39225, 0, 0.012), ALONG_Z)],
    "wrist_1_link": [(0.042, 0.11, (0, 0, 0.108), ALONG_Y)],
    "wrist_2_link": [(0.042, 0.11, (0, 0, 0.09465), ALONG_Y)],
    "wrist_3_link": [(0.038, 0.04, (0, 0, 0.0623), ALONG_Z)]}

FINGERS = (("index", 0, 0.0435, -0.001542, -5.0), ("middle", 4, 0.0, 0.0007, 0.0), ("ring", 8, -0.0435, -0.001542, 5.0))
FINGER_LIMITS = ((-0.47, 0.47), (-0.196, 1.61), (-0.174, 1.709), (-0.227, 1.618))
FINGER_LENGTHS = (0.0164, 0.054, 0.0384, 0.0267)
THUMB_LIMITS = ((0.263, 1.396), (-0.105, 1.163), (-0.189, 1.644), (-0.162, 1.719))
THUMB_LENGTHS = (0.0177, 0.0514, 0.0423)
WIDTH = (0.0196, 0.0275)  # of every finger box, x and y
TIP_RADIUS = 0.012


def number(value):
    return f"{value + 0.0:.9g}"  # + 0.0: no minus zero


def triple(values):
    return " ".join(number(v) for v in values)


def exact(angles):
    return " ".join(f"{a + 0.0:.17g}" for a in angles)  # nine digits would tilt a frame by 1e-9 rad


RIGHT, LEFT = 1, -1


def place(side, xyz):
    return (xyz[0], side * xyz[1], xyz[2])


def turn(side, rpy):
    return (side * rpy[0], rpy[1], side * rpy[2])


def axis_of(side, axis):
    """A rotation by q about an axis a, mirrored, is one by q about -M a."""
    return (side * axis[0], axis[1], side * axis[2])


def collision(geometry, xyz=(0, 0, 0), rpy=(0, 0, 0)):
    return (f'    <collision><origin xyz="{triple(xyz)}" rpy="{exact(rpy)}"/><geometry>{geometry}</geometry>'
            '</collision>')


def cylinder(radius, length):
    return f'<cylinder radius="{number(radius)}" length="{number(length)}"/>'


def box(*size):
    return f'<box size="{triple(size)}"/>'


def link(name, shapes=()):
    if not shapes:
        return [f'  <link name="{name}"/>']
    return [f'  <link name="{name}">', *shapes, "  </link>"]


def joint(name, parent, child, xyz, rpy=(0, 0, 0), axis=None, limits=None, velocity=0.0):
    lines = [f'  <joint name="{name}" type="{"revolute" if axis else "fixed"}">',
             f'    <parent link="{parent}"/><child link="{child}"/>',
             f'    <origin xyz="{triple(xyz)}" rpy="{exact(rpy)}"/>']
    if axis:
        lines.append(f'    <axis xyz="{triple(axis)}"/><limit lower="{limits[0]:.17g}" upper="{limits[1]:.17g}" '
                     f'effort="1" velocity="{number(velocity)}"/>')
    return lines + ["  </joint>"]


def document(name, body):
    return "\n".join(['<?xml version="1.0"?>', "<!-- SPDX-FileCopyrightText: 2026 The opponens authors",
                      "     SPDX-License-Identifier: BSD-3-Clause",
                      "     Written by make_ur5_allegro.py, which names the sources. -->", f'<robot name="{name}">',
                      *body, "</robot>"]) + "\n"


def arm():
    body = []
    for name in ARM_LINKS:
        body += link(name, [collision(cylinder(r, l), at, rpy) for r, l, at, rpy in ARM_CYLINDERS[name]])
    for i, name in enumerate(ARM):
        turn = pi if name == "elbow" else 2 * pi
        body += joint(name + "_joint", ARM_LINKS[i], ARM_LINKS[i + 1], *ARM_ORIGINS[i], (0, 0, 1), (-turn, turn), pi)
    body += link("tool0")
    body += joint("flange", "wrist_3_link", "tool0", (0, 0, 0.0823))
    return document("ur5", body)


def finger_box(length):
    return [collision(box(*WIDTH, length), (0, 0, length / 2))]


def tip(last, length):
    return (link(last + "_tip", [collision(f'<sphere radius="{number(TIP_RADIUS)}"/>')]) +
            joint(last.replace("link", "joint") + "_tip", last, last + "_tip", (0, 0, length)))


def hand(side):
    def moved(name, parent, at, rpy, axis, limits):
        return joint(name, parent, name.replace("joint", "link"), place(side, at), turn(side, rpy), axis_of(side, axis),
                     limits, 7)

    body = link("palm_link", [collision(box(0.0408, 0.113, 0.0475), (-0.0093, 0, -0.02375)),
                              collision(box(0.0408, 0.0965, 0.0475), place(side, (-0.0093, -0.00825, -0.07125)))])
    for _, first, y, z, tilt in FINGERS:
        parent, at, rpy, axis = "palm_link", (0, y, z), (radians(tilt), 0, 0), (0, 0, 1)
        for i, (length, limits) in enumerate(zip(FINGER_LENGTHS, FINGER_LIMITS)):
            name = f"link_{first + i}.0"
            body += link(name, finger_box(length))
            body += moved(f"joint_{first + i}.0", parent, at, rpy, axis, limits)
            parent, at, rpy, axis = name, (0, 0, length), (0, 0, 0), (0, 1, 0)
        body += tip(parent, FINGER_LENGTHS[-1])
    body += link("link_12.0", [collision(box(0.0358, 0.034, 0.0455), place(side, (-0.0179, 0.009, 0.0145)))])
    body += moved("joint_12.0", "palm_link", (-0.0182, 0.019333, -0.045987), (0, radians(-95), -pi / 2), (-1, 0, 0),
                  THUMB_LIMITS[0])
    parent, at, axis = "link_12.0", (-0.027, 0.005, 0.0399), (0, 0, 1)
    for i, (length, limits) in enumerate(zip(THUMB_LENGTHS, THUMB_LIMITS[1:]), 13):
        name = f"link_{i}.0"
        body += link(name, finger_box(length))
        body += moved(f"joint_{i}.0", parent, at, (0, 0, 0), axis, limits)
        parent, at, axis = name, (0, 0, length), (0, 1, 0)
    return document("allegro_right" if side == RIGHT else "allegro_left", body + tip(parent, THUMB_LENGTHS[-1]))


def point(finger, name_of_link, at, normal, name=None):
    label = f"name: {name}, " if name else ""
    return (f"  - {{{label}finger: {finger}, link: {name_of_link}, point: [{', '.join(number(v) for v in at)}], "
            f"normal: [{', '.join(number(v) for v in normal)}]}}")


def surface_points(side):
    """Fig. 5 of the paper: four contacts a finger, three on the thumb, three on the palm."""
    slope = (cos(radians(30)), 0.0, sin(radians(30)))  # the tip's pad: 30 deg from the palmar side to the end
    pad = [TIP_RADIUS * v for v in slope]
    tips, contacts = ["tips:"], ["contact_points:"]
    chains = [(name, first + 1, FINGER_LENGTHS[1:]) for name, first, *_ in FINGERS] + [("thumb", 14, THUMB_LENGTHS[1:])]
    for finger, first, lengths in chains:
        for i, length in enumerate(lengths):
            contacts.append(point(finger, f"link_{first + i}.0", (WIDTH[0] / 2, 0, length / 2), (1, 0, 0),
                                  f"{finger}_{i + 1}"))
        last = f"link_{first + len(lengths) - 1}.0_tip"
        tips.append(point(finger, last, pad, slope))
        contacts.append(point(finger, last, pad, slope, f"{finger}_tip"))
    for i, (y, z) in enumerate(((0.02, -0.02), (-0.035, -0.02), (-0.03, -0.07)), 1):
        contacts.append(point("palm", "palm_link", place(side, (0.0111, y, z)), (1, 0, 0), f"palm_{i}"))
    return tips + contacts


def mapping():
    """Section 3.2 of the paper: flexion copies, abduction and thumb opposition come from fingertip positions."""
    copied = [(f"joint_{first + 1 + i}.0", f"{name[0].upper()}_{channel}")
              for name, first, *_ in FINGERS for i, channel in enumerate(("MCP", "PIP", "DIP"))]
    copied += [("joint_14.0", "T_MCP"), ("joint_15.0", "T_IP")]
    lines = ["mapping:", "  copied:"] + [f"    - {{joint: {j}, channel: {c}}}" for j, c in copied]
    lines += ["  direct:", "    - {joint: joint_0.0, channel: I_ABD}", "    - {joint: joint_4.0, channel: M_ABD}",
              "    - {joint: joint_8.0, channel: R_ABD, gain: -1}",
              "    - {joint: joint_12.0, channel: T_ROT, ranges: true}",
              "    - {joint: joint_13.0, channel: T_ABD, ranges: true}"]
    return lines + ["  fitted: [joint_0.0, joint_4.0, joint_8.0, joint_12.0, joint_13.0]",
                    "  fingertips: {index: index, middle: middle, ring: ring, thumb: {tip: thumb, from: index}}"]


def hand_yaml(side):
    joints = [f"joint_{i}.0" for i in range(16)]
    lines = ["# SPDX-FileCopyrightText: 2026 The opponens authors", "# SPDX-License-Identifier: BSD-3-Clause",
             "# Written by make_ur5_allegro.py.",
             f"urdf: {'allegro_right' if side == RIGHT else 'allegro_left'}.urdf", "palm_link: palm_link",
             f"joints: [{', '.join(joints[:8])},", f"         {', '.join(joints[8:])}]"]
    # The gloves are right hands: the left hand takes the joint positions found for the right one.
    return "\n".join(lines + surface_points(side) + (mapping() if side == RIGHT else [])) + "\n"


here = Path(__file__).resolve().parent
(here / "ur5.urdf").write_text(arm())
for hand_side, hand_name in ((RIGHT, "allegro_right"), (LEFT, "allegro_left")):
    (here / f"{hand_name}.urdf").write_text(hand(hand_side))
    (here / f"{hand_name}.yaml").write_text(hand_yaml(hand_side))
