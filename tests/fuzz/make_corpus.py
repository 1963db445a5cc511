# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the seeds of the fuzz targets: make_corpus.py FOLDER. All are made here; the source YAMLs are the project's."""
import pathlib
import struct
import sys
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def element(kind, data):
    return struct.pack("<II", kind, len(data)) + data + b"\0" * (-len(data) % 8)


def matrix(name, kind, dimensions, body):
    head = element(6, struct.pack("<II", kind, 0)) + element(5, struct.pack(f"<{len(dimensions)}i", *dimensions))
    return element(14, head + element(1, name.encode()) + body)


def mat_file(*elements):
    return b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM" + b"".join(elements)


def numbers(name="X"):
    return matrix(name, 6, (3, 2), element(9, struct.pack("<6d", *range(6))))


def index_block(texts, entries, inputs):
    """A block of index.bin; the target itself makes its size and sum fit."""
    ends = [sum(map(len, texts[:count + 1])) for count in range(len(texts))]
    numbers = [len(entries), 0, len(inputs), len(texts), ends[-1], 0]
    flat = [number for entry in entries for number in entry] + inputs + ends
    body = struct.pack("<6I", *numbers) + b"".join(bytes([count]) * 32 for count in range(len(entries)))
    block = bytes(24) + body + struct.pack(f"<{len(flat)}I", *flat) + b"".join(texts)
    return block + bytes(-len(block) % 8)


def u64(value):
    return struct.pack("<Q", value)


def text(value):
    return u64(len(value)) + value


def object_part():
    """The contents' part of one object with a field of each type; its arrays begin with the file."""
    skeleton = b"".join([text(b"opponens record 1"), text(b"document"), text(b"x"), text(b"c"), u64(1), text(b"i"),
                         u64(1), text(b"f"), text(b"h"), text(b"{}"), u64(1), text(b"0.1.0"), u64(6),
                         text(b"a"), u64(0), u64(0), text(b"b"), u64(1), u64(7), text(b"c"), u64(2),
                         text(b"t"), text(b"d"), u64(3), u64(1), text(b"t"), text(b"e"), u64(4), u64(2),
                         u64(0), text(b"f"), u64(5), u64(2), u64(1), u64(0)])
    return b"opponens object\n" + text(bytes(64)) + text(skeleton)


def joint(name, kind, inside="<limit lower='-1' upper='1' effort='1' velocity='1'/>"):
    return (f"<joint name='{name}' type='{kind}'><origin xyz='0 0 0.1' rpy='0 1 0'/><parent link='{name[0]}'/>"
            f"<child link='{name[1]}'/><axis xyz='0 0 1'/>{inside}</joint>")


def urdfs():
    shapes = ("<box size='1 1 1'/>", "<sphere radius='1'/>", "<cylinder radius='1' length='2'/>", "<capsule/>",
              "<mesh filename='package://p/a.stl' scale='1 -1 1'/>")
    bodies = "".join(f"<collision><origin xyz='0 0 1'/><geometry>{shape}</geometry></collision>" for shape in shapes)
    links = f"<link name='a'>{bodies}</link>" + "".join(f"<link name='{name}'/>" for name in "bcd")
    limit = "<limit lower='0' upper='1' effort='1' velocity='1'/><mimic joint='ab' multiplier='-1' offset='0.5'/>"
    yield f"<?xml version='1.0'?><!-- c --><robot name='r'>{links}{joint('ab', 'revolute')}{joint('ac', 'fixed')}" \
          f"{joint('cd', 'prismatic', limit)}</robot>"
    yield f"<robot name='r'>{links}{joint('ab', 'continuous', '')}{joint('bc', 'revolute')}{joint('bd', 'revolute')}" \
          "<gazebo reference='a'/><transmission/></robot>"


SRDF = """<robot name='r'><group name='g'><joint name='j'/><link name='a'/><chain base_link='a' tip_link='b'/>
<group name='h'/></group><group_state name='s' group='g'><joint name='j' value='0 1e-3'/></group_state>
<end_effector name='e' parent_link='a' group='g'/><disable_collisions link1='a' link2='b' reason='Never'/></robot>"""

ROBOTS = (
    "arm: {urdf: arm.urdf, joints: [ab, bc], link_prefix: x/}\nhand: hand.yaml\nweights: {ab: 2}\n"
    "mount: {parent: x/c, xyz: [0, 0, 1], rpy: [0, 1, 0], support: {name: s, radius: 1, length: 1, xyz: [0, 0, 0]}}\n"
    "allowed_collisions: [[x/a, q]]\nwithout_geometry: [x/a]\ncollision: visual\n",
    "name: n\narm: {urdf: arm.urdf, joints: [ab]}\n",
    "arms:\n  l: {arm: {urdf: arm.urdf, joints: [ab, bc]}, hand: hand.yaml, mount: {parent: c}, rest: {ab: 0.5}}\n"
    "  r: {arm: {urdf: arm.urdf, joints: [ab]}, base: {parent: stand/a, xyz: [1, 0, 0]}}\n"
    "stand: {urdf: arm.urdf, xyz: [0, 0, 1]}\ndefault: l\nallowed_collisions: [[l/a, r/a]]\n")

HAND = ("urdf: hand.urdf\npackages: {p: .}\npalm_link: p\njoints: [pq, qr]\n"
        "tips: [{finger: index, link: r, point: [0, 0, 0], normal: [0, 0, 2]}]\n"
        "contact_points: [{name: a, finger: index, link: q, point: [0, 0, 0], normal: [1, 0, 0]}]\n"
        "mapping: {pq: {channel: I_MCP}, qr: I_PIP}\nallowed_collisions: [[p, r]]\n")

SCENE = """name: s
robot_base: {xyz: [1, 2, 3], rpy: [0, 0, 1]}
object: thing
start: {b: 0.5, a: -1}
bodies:
  - name: thing
    pose: {xyz: [0, 0, 1], quaternion: [1, 0, 0, 0]}
    geometry:
      - {box: {size: [1, 2, 3]}, pose: {xyz: [4, 0, 0]}}
      - {sphere: {radius: 0.5}}
      - {cylinder: {radius: 0.5, length: 2}}
      - {mesh: {file: t.obj, unit: mm, scale: [2, 1, 1]}}
      - {revolution: {profile: [[0.1, 0], [0.1, 1]], segments: 8}}
"""

PLANNING_SCENE = """name: ""
robot_state: {joint_state: {name: [a, b], position: [0.5, -1]}}
fixed_frame_transforms:
  - {child_frame_id: f, transform: {rotation: {x: 0, y: 0, z: 0, w: 1}, translation: [0, 0, 0]}}
allowed_collision_matrix: {entry_names: [p, q], entry_values: [[false, true], [true, false]]}
world:
  collision_objects:
    - id: a
      header: {frame_id: f}
      pose: {position: [1, 0, 0], orientation: [0, 0, 0, 1]}
      primitives: [{type: box, dimensions: [1, 2, 3]}, {type: "4", dimensions: [0.4, 0.1]}]
      primitive_poses: [{position: [1, 0, 0], orientation: [0, 0, 0, 1]}, {position: [1, 0, 0], orientation: [0, 0, 0, 1]}]
      meshes: [{resource: "package://p/t.obj", dimensions: [2, 1, 1]}, {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles: [[0, 2, 1]]}]
      mesh_poses: [{position: [0, 0, 0], orientation: [0, 0, 0, 1]}, {position: [0, 0, 0], orientation: [0, 0, 0, 1]}]
"""

TEXT_SCENE = """s
* cup
1 2 3
0 0 0 1
2
cone
0.1 0.3
0 0 0.5
0 0 0 1
0 0 0 0
mesh
3 1
0 0 0
1 0 0
0 1 0
0 2 1
0 0 1
0 0 0 1
0 0 0 0
1
handle
0 0 0
0 0 0 1
* old
1
box
1 2 3
0 0 1
0 0 0 1
0 0 0 0
.
"""

REQUEST = """group_name: arm
start_state: {joint_state: {name: [a, b], position: [1, 2]}}
goal_constraints:
  - joint_constraints: [{joint_name: a, position: 0.5, tolerance_above: 0.1}]
path_constraints: {joint_constraints: [{joint_name: a, position: 0}]}
"""


def robot_seeds():
    for text in urdfs():
        yield "urdf", text.encode()
    yield "srdf", SRDF.encode()
    for text in ROBOTS:
        yield "robot", b"\0" + text.encode()
    yield "robot", b"\1" + HAND.encode()
    for kind, text in enumerate((SCENE, TEXT_SCENE, REQUEST, PLANNING_SCENE)):
        yield "scene", bytes([kind]) + text.encode()
    yield "scene", b"\0" + PLANNING_SCENE.replace("package://p/", "").encode()


def seeds():
    csv = b"t,a,b,c\n0,1,2,3\n0.1,359,2.5,3\n0.2,1,1e1,3\n0,1,2,3\n0.1,2,3,4\n"
    yield "csv", b"\0" + csv
    yield "csv", b"\1" + b"t,0,0.1,0.2\na,1,2,3\nb,4,5,6\nc,7,8,9\n"
    yield "csv", b"\2" + b"a,b,c,d,e\n1,2,3,cup,N\n1,3,3,cup,N\n1,2,3,pen,Y\n2,2,3,pen,Y\n"
    yield "text", b"\0" + b"2014 12 31 23 59 59.5 1.5 [2]\n2015 1 1 0 0 0.5 1 2\n2015, 01, 01, 00, 00, 00.2, 1, 2\n2015 1 1 0 0 1 1 2\n"
    yield "text", b"\1" + b"tick\n10, 0, 1000\n20, 5, 6\n30 7 8\n"
    yield "text", b"\2" + b"0 1 6.2 6.3\n1 2 3 4\n"
    for file in sorted((ROOT / "models" / "sources").glob("*.yaml")):
        lines = [line for line in file.read_text().splitlines() if not line.lstrip().startswith("#")]
        yield "source", "\n".join(lines).encode()
    yield "mat_layout", mat_file(numbers())
    packed = zlib.compress(numbers())
    yield "mat_layout", mat_file(struct.pack("<II", 15, len(packed)) + packed, numbers("Y"))
    yield "mat_layout", mat_file(matrix("X", 1, (1, 2), numbers("") + numbers("")))
    yield "index", index_block([b"f.h5", b"document", b"x"], [(1, 2, 0, 1), (1, 0, 1, 0)], [0])
    yield "index", index_block([b"f.h5"], [], [])
    yield "contents", object_part()
    yield "contents", object_part() * 2
    yield from robot_seeds()


if __name__ == "__main__":
    for number, (target, seed) in enumerate(seeds()):
        folder = pathlib.Path(sys.argv[1]) / target
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"seed_{number:02}").write_bytes(seed)
