#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes human_hand.urdf and human_hand.yaml beside itself: a parametric right hand, every length a share of HL.

Sources
  Segment lengths: Buchholz, Armstrong and Goldstein 1992 (doi:10.1080/00140139208967812), shares of the hand length.
  Upper limits of flexion, extension, abduction: American Academy of Orthopaedic Surgeons 1965, "Joint Motion: Method of
  Measuring and Recording".
  Ours, no source: places of the metacarpals in the palm, segment radii, T_ROT's range (the AAOS measures opposition as
  a distance), PALM_ARCH, and the lower limits of flexion (active extension of a relaxed hand, not the passive limit).

Palm frame P, as the Allegro hand's: origin in the middle finger's MCP joint, x out of the palm, z along the straight
middle finger, y to the thumb's side. Flexion is positive about a segment's y, which turns z towards x.
"""
from math import cos, radians, sin
from pathlib import Path

HL = 0.19  # m, default; RobotDescription scaled(description, factor) changes it
METACARPAL = {"I": 0.463, "M": 0.446, "R": 0.421, "L": 0.414}  # from the wrist
SEGMENTS = {"I": (0.245, 0.143, 0.097), "M": (0.266, 0.170, 0.108), "R": (0.244, 0.165, 0.107),
            "L": (0.204, 0.117, 0.093)}
THUMB = (0.251, 0.196, 0.158)  # metacarpal, proximal, distal
RAY = {"I": 14.0, "M": 0.0, "R": -14.0, "L": -27.0}  # deg, metacarpals fan out from the wrist, + towards the thumb
RADIUS = {"I": (0.050, 0.046, 0.042), "M": (0.050, 0.046, 0.042), "R": (0.045, 0.042, 0.039),
          "L": (0.040, 0.037, 0.034)}
THUMB_RADIUS = (0.060, 0.055, 0.050)
THUMB_BASE = (0.07, 0.14, 0.10 - METACARPAL["M"])  # palmar, radial, distal (from the wrist)
CMC_SHARE = 0.25  # PALM_ARCH bends the little finger's metacarpal at this share of its length
FINGER = {"I": "index", "M": "middle", "R": "ring", "L": "little"}
RANGE = {"T_ROT": (-10, 110), "T_ABD": (0, 70), "T_MCP": (0, 50), "T_IP": (-15, 80), "MCP": (-10, 90), "PIP": (0, 100),
         "DIP": (0, 90), "ABD": (-20, 20), "PALM_ARCH": (0, 25), "W_PITCH": (-70, 80), "W_YAW": (-20, 30)}  # deg
CHANNELS = (["T_ROT", "T_MCP", "T_IP", "T_ABD"] + [f + "_" + j for f in "IMRL" for j in ("MCP", "PIP", "DIP", "ABD")] +
            ["PALM_ARCH", "W_PITCH", "W_YAW"])

urdf = []
fingers = {}  # finger -> [(link, length m, radius m)]


def number(value):
    return f"{value + 0.0:.9g}"  # + 0.0: no minus zero


def triple(values):
    return " ".join(number(v) for v in values)


def exact(angles):
    return " ".join(f"{a:.17g}" for a in angles)  # nine digits would tilt a frame by 1e-9 rad


def cylinder(radius, length, z, rpy=(0, 0, 0), x=0.0, y=0.0):
    return (f'    <collision><origin xyz="{triple((x, y, z))}" rpy="{triple(rpy)}"/><geometry>'
            f'<cylinder radius="{number(radius)}" length="{number(length)}"/></geometry></collision>')


def sphere(radius, z):
    return (f'    <collision><origin xyz="0 0 {number(z)}"/><geometry><sphere radius="{number(radius)}"/></geometry>'
            '</collision>')


def box(size, at):
    return (f'    <collision><origin xyz="{triple(at)}"/><geometry><box size="{triple(size)}"/></geometry></collision>')


def link(name, shapes=()):
    if shapes:
        urdf.extend([f'  <link name="{name}">', *shapes, "  </link>"])
    else:
        urdf.append(f'  <link name="{name}"/>')


def joint(name, parent, child, xyz, axis, rpy=(0, 0, 0)):
    low, high = RANGE.get(name) or RANGE[name.split("_")[1]]
    urdf.extend([
        f'  <joint name="{name}" type="revolute">',
        f'    <parent link="{parent}"/><child link="{child}"/>',
        f'    <origin xyz="{triple(xyz)}" rpy="{exact(rpy)}"/><axis xyz="{triple(axis)}"/>',
        f'    <limit lower="{number(radians(low))}" upper="{number(radians(high))}" effort="1" velocity="10"/>', "  </joint>"])


def segment(name, length, radius, last=False):
    """A capsule along z: cylinder and a ball at the far end; the near end is covered by the segment before. The ball
    of the last segment ends at the length, that of the others is the knuckle."""
    length -= radius if last else 0.0
    link(name, (cylinder(radius, length, length / 2), sphere(radius, length)))


def chain(finger, parent, names, lengths, radii, start):
    """Flexion joints about y, one after the other along z."""
    at = start
    for name, length, radius in zip(names, lengths, radii):
        segment_name = finger + "_" + name.split("_")[1].lower()
        joint(name, parent, segment_name, (0, 0, at), (0, 1, 0))
        segment(segment_name, length * HL, radius * HL, last=name == names[-1])
        fingers.setdefault(finger, []).append((segment_name, length * HL, radius * HL))
        parent, at = segment_name, length * HL


def finger(letter):
    name, ray = FINGER[letter], radians(RAY[letter])
    direction = (0.0, sin(ray), cos(ray))
    wrist = -METACARPAL["M"] * HL
    length = METACARPAL[letter] * HL
    knuckle = [d * length for d in direction]
    knuckle[2] += wrist
    cmc = [CMC_SHARE * d * length for d in direction]
    cmc[2] += wrist
    bone = (1 - CMC_SHARE) * length
    half = [d * bone / 2 for d in direction]
    parent, at = "palm", knuckle
    if letter == "L":
        parent, at = "little_metacarpal", [2 * v for v in half]
        joint("PALM_ARCH", "palm", parent, cmc, (0, 1, 0))
        link(parent, (cylinder(0.042 * HL, bone, half[2], (-ray, 0, 0), 0.0, half[1]),))
    # Abduction is positive away from the middle finger; the middle finger's own is positive towards the thumb.
    away = 1.0 if letter in "RL" else -1.0
    joint(letter + "_ABD", parent, name + "_base", at, (away, 0, 0))
    link(name + "_base", (sphere(RADIUS[letter][0] * HL, 0.0),))
    chain(name, name + "_base", [letter + "_" + j for j in ("MCP", "PIP", "DIP")], SEGMENTS[letter], RADIUS[letter], 0.0)


def thumb():
    """T_ROT turns the metacarpal about z from beside the index finger (0) to in front of the palm; T_ABD opens it."""
    joint("T_ROT", "palm", "thumb_base", [v * HL for v in THUMB_BASE], (0, 0, -1), (0, 0, radians(-90)))
    link("thumb_base")
    joint("T_ABD", "thumb_base", "thumb_metacarpal", (0, 0, 0), (0, -1, 0))
    segment("thumb_metacarpal", THUMB[0] * HL, THUMB_RADIUS[0] * HL)
    chain("thumb", "thumb_metacarpal", ["T_MCP", "T_IP"], THUMB[1:], THUMB_RADIUS[1:], THUMB[0] * HL)


def wrist():
    """The forearm hangs below the palm, so that fingertips in the palm frame do not depend on the wrist."""
    at = (0, 0, -METACARPAL["M"] * HL)
    joint("W_PITCH", "palm", "carpus", at, (0, -1, 0))
    link("carpus")
    joint("W_YAW", "carpus", "forearm", (0, 0, 0), (-1, 0, 0))
    link("forearm", (cylinder(0.15 * HL, 0.6 * HL, -0.36 * HL),))


def write_urdf(path):
    urdf.extend(['<?xml version="1.0"?>', "<!-- SPDX-FileCopyrightText: 2026 The opponens authors",
                 "     SPDX-License-Identifier: BSD-3-Clause",
                 "     Written by make_human_hand.py, which names the sources. -->", '<robot name="human_hand">'])
    # One box over the index and middle metacarpals, one over the ring finger's.
    link("palm", (box((0.14 * HL, 0.21 * HL, 0.44 * HL), (0, 0.045 * HL, -0.22 * HL)),
                  box((0.12 * HL, 0.08 * HL, 0.38 * HL), (0, -0.1 * HL, -0.25 * HL))))
    thumb()
    for letter in "IMRL":
        finger(letter)
    wrist()
    urdf.append("</robot>")
    path.write_text("\n".join(urdf) + "\n")


def point(finger_name, link_name, at, normal, name=None):
    label = f"name: {name}, " if name else ""
    return (f"  - {{{label}finger: {finger_name}, link: {link_name}, point: [{', '.join(number(v) for v in at)}], "
            f"normal: [{', '.join(number(v) for v in normal)}]}}")


def write_yaml(path):
    lines = ["# SPDX-FileCopyrightText: 2026 The opponens authors", "# SPDX-License-Identifier: BSD-3-Clause",
             "# Written by make_human_hand.py.", "urdf: human_hand.urdf", "palm_link: palm",
             f"joints: [{', '.join(CHANNELS[:12])},", f"         {', '.join(CHANNELS[12:])}]"]
    tips, contacts = ["tips:"], ["contact_points:"]
    slope = (cos(radians(30)), 0.0, sin(radians(30)))  # the pulp: 30 deg from the palmar side to the end
    for name, segments in fingers.items():
        for number_of, (segment_name, length, radius) in enumerate(segments, 1):
            contacts.append(point(name, segment_name, (radius, 0, length / 2), (1, 0, 0), f"{name}_{number_of}"))
        last, length, radius = segments[-1]
        pulp = (radius * slope[0], 0.0, length - radius * (1 - slope[2]))
        tips.append(point(name, last, pulp, slope))
        contacts.append(point(name, last, pulp, slope, f"{name}_tip"))
    for number_of, (y, z) in enumerate(((0.12, -0.08), (-0.02, -0.08), (0.02, -0.30)), 1):
        contacts.append(point("palm", "palm", (0.07 * HL, y * HL, z * HL), (1, 0, 0), f"palm_{number_of}"))
    pairs = ["allowed_collisions:  # two joints apart, but built around one centre"]
    pairs += [f"  - [palm, {name}_mcp]" for name in ("index", "middle", "ring")]
    pairs += ["  - [palm, thumb_metacarpal]", "  - [little_metacarpal, little_mcp]", "  - [palm, forearm]",
              "  - [little_metacarpal, forearm]"]
    path.write_text("\n".join(lines + tips + contacts + pairs) + "\n")


here = Path(__file__).resolve().parent
write_urdf(here / "human_hand.urdf")
write_yaml(here / "human_hand.yaml")
