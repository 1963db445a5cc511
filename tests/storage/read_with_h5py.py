#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reads a store with h5py alone, as docs/file_format.md describes it: prints the content hash of every object, worked
out from what was read, then some values of the first demonstration. Usage: read_with_h5py.py STORE"""
import hashlib
import pathlib
import struct
import sys

import h5py
import numpy


def number(value):
    return struct.pack("<Q", value & 0xFFFFFFFFFFFFFFFF)


def text(value):
    data = value.encode("utf-8")
    return number(len(data)) + data


def texts(values):
    return number(len(values)) + b"".join(text(value) for value in values)


def field_bytes(value):
    """Type number and canonical bytes of one field."""
    if isinstance(value, str):
        return number(2) + text(value)
    if isinstance(value, list):
        return number(3) + texts(value)
    if isinstance(value, numpy.floating):
        return number(0) + struct.pack("<d", value)
    if isinstance(value, numpy.integer):
        return number(1) + struct.pack("<q", value)
    shape = b"".join(number(size) for size in value.shape)
    return number(3 + value.ndim) + shape + value.astype("<f8").tobytes(order="C")


def read_dataset(dataset):
    if h5py.check_string_dtype(dataset.dtype):
        return list(dataset.asstr()[...])
    return dataset[...]


def read_object(group):
    provenance = group["provenance"]
    result = dict(group.attrs)
    result["provenance"] = dict(provenance.attrs)
    for name in ("inputs", "files", "files_sha256"):
        result["provenance"][name] = read_dataset(provenance[name])
    result["fields"] = dict(group["fields"].attrs)
    result["fields"].update({name: read_dataset(dataset) for name, dataset in group["fields"].items()})
    return result


def content_hash(item):
    origin = item["provenance"]
    data = text("opponens record 1") + text(item["kind"]) + text(item["name"]) + text(origin["command"])
    data += texts(origin["inputs"]) + number(len(origin["files"]))
    for name, digest in zip(origin["files"], origin["files_sha256"]):
        data += text(name) + text(digest)
    data += text(origin["parameters"]) + number(int(origin["seed"])) + text(origin["program_version"])
    data += number(len(item["fields"]))
    for name in sorted(item["fields"], key=lambda key: key.encode("utf-8")):
        data += text(name) + field_bytes(item["fields"][name])
    return hashlib.sha256(data).hexdigest()


def main():
    objects = []
    for path in sorted(pathlib.Path(sys.argv[1]).glob("*.h5")):
        assert path.stem.split("-")[1] == hashlib.sha256(path.read_bytes()).hexdigest()[:32]
        with h5py.File(path, "r") as file:
            assert file.attrs["format"] == "opponens batch" and file.attrs["schema_version"] == 1
            objects += [read_object(group) for group in file["objects"].values()]
    for item in objects:
        assert content_hash(item) == item["id"], item["name"]
        print(item["id"])
    first = next(item for item in objects if item["kind"] == "demonstration")
    fields = first["fields"]
    q_h = fields["q_h"]
    print(first["name"], fields["label.object"], fields["label.subject"], fields["origin"])
    print(*q_h.shape, struct.pack(">d", q_h[0, 1]).hex(), struct.pack(">d", q_h[-1, -1]).hex(), fields["joint_names"][2])
    print(first["provenance"]["command"], first["provenance"]["files"][0], first["provenance"]["seed"])


if __name__ == "__main__":
    main()
