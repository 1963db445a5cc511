# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""MATLAB v5 files read and written without any library: numbers and cells (MAT-File Format, MathWorks)."""
import itertools
import pathlib
import struct
import zlib

import numpy

TYPES = {1: "<i1", 2: "<u1", 3: "<i2", 4: "<u2", 5: "<i4", 6: "<u4", 7: "<f4", 9: "<f8", 12: "<i8", 13: "<u8"}
CLASSES = {6: "<f8", 7: "<f4", 8: "<i1", 9: "<u1", 10: "<i2", 11: "<u2", 12: "<i4", 13: "<u4", 14: "<i8", 15: "<u8"}


def elements(data):
    """Type and bytes of each element."""
    at = 0
    while at < len(data):
        if len(data) - at < 8:
            raise ValueError("cut off")
        kind, size = struct.unpack_from("<II", data, at)
        if kind >> 16:
            size, kind, begin, end = kind >> 16, kind & 0xFFFF, at + 4, at + 8
            if size > 4:
                raise ValueError("a small element of more than 4 bytes")
        else:
            begin = at + 8
            end = begin + size
            if end > len(data):
                raise ValueError("cut off")
            if kind != 15:
                end = min((end + 7) // 8 * 8, len(data))
        yield kind, data[begin:begin + size]
        at = end


def array(data):
    """Name and value: a numpy array, or an object array of cells."""
    parts = list(elements(data))
    flags, = struct.unpack("<I", parts[0][1][:4])
    kind = flags & 0xFF
    shape = struct.unpack(f"<{len(parts[1][1]) // 4}i", parts[1][1])
    name = parts[2][1].decode("latin-1")
    if flags & 0x0800:
        raise ValueError("complex")
    if kind == 1:
        cells = numpy.empty(len(parts) - 3, object)
        for number, (_, cell) in enumerate(parts[3:]):
            cells[number] = array(cell)[1]
        return name, cells.reshape(shape, order="F")
    raw, = parts[3:]
    values = numpy.frombuffer(raw[1], TYPES[raw[0]]).astype(CLASSES[kind])
    return name, values.reshape(shape, order="F")


def read(file):
    """Name -> bytes of each array of that name."""
    data = file if isinstance(file, bytes) else pathlib.Path(file).read_bytes()
    if data[124:128] != b"\x00\x01IM":
        raise ValueError("not a MATLAB v5 file of a little-endian machine")
    found = {}
    for kind, content in elements(data[128:]):
        if kind == 15:
            unpack = zlib.decompressobj()
            content = unpack.decompress(content)
            if not unpack.eof or unpack.unused_data:
                raise ValueError("damaged compressed data")
            (kind, content), = elements(content)
        if kind != 14:
            raise ValueError("not an array")
        parts = list(itertools.islice(elements(content), 3))
        found.setdefault(parts[2][1].decode("latin-1"), []).append(content)
    return found


def variable(file, name):
    """The value of a variable that is there once."""
    content, = read(file)[name]
    return array(content)[1]


def element(kind, data):
    return struct.pack("<II", kind, len(data)) + data + b"\0" * (-len(data) % 8)


def pack(name, value):
    """A matrix element of float64 numbers, or of an object array of them."""
    cells = value.dtype == object
    head = element(6, struct.pack("<II", 1 if cells else 6, 0))
    head += element(5, struct.pack(f"<{value.ndim}i", *value.shape)) + element(1, name.encode())
    flat = value.flatten(order="F")
    body = b"".join(pack("", cell) for cell in flat) if cells else element(9, flat.astype("<f8").tobytes())
    return element(14, head + body)


def write(file, variables, compress=True):
    with open(file, "wb") as out:
        out.write(b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM")
        for name, value in variables.items():
            packed = pack(name, value)
            if compress:
                packed = zlib.compress(packed)
                packed = struct.pack("<II", 15, len(packed)) + packed
            out.write(packed)
