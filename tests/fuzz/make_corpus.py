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


if __name__ == "__main__":
    for number, (target, seed) in enumerate(seeds()):
        folder = pathlib.Path(sys.argv[1]) / target
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"seed_{number:02}").write_bytes(seed)
