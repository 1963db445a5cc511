#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""FRoGGeR's published grasps of ten YCB objects through the checks of `opponens grasp --import` (README.md)."""
import argparse
import json
import pathlib
import subprocess
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
MODELS = SOURCE / "models/ur5_allegro"


def robot_with_meshes(folder, shared):
    """Our robot.yaml with the hand that FRoGGeR's numbers are about: example-robot-data's Allegro, visual meshes."""
    data = shared / "data/robots/example-robot-data"
    hand = (MODELS / "allegro_right.yaml").read_text()
    hand = hand.replace("urdf: allegro_right.urdf",
                        f"urdf: {data}/robots/allegro_hand_description/urdf/allegro_right_hand.urdf\n"
                        f"packages: {{example-robot-data: {data}}}\ncollision: visual")
    (folder / "hand.yaml").write_text(hand)
    robot = (MODELS / "ur5_allegro_right.yaml").read_text()
    robot = robot.replace("urdf: ur5.urdf", f"urdf: {MODELS}/ur5.urdf").replace("collision: urdf", "collision: visual")
    robot = robot.replace("hand: allegro_right.yaml", "hand: hand.yaml")
    (folder / "robot.yaml").write_text(robot)
    return folder / "robot.yaml"


def scene(folder, name, mesh):
    """The object alone in front of the robot's base."""
    content = {"name": name, "robot_base": {"xyz": [0, 0, 0.75]}, "object": name, "bodies": [
        {"name": name, "pose": {"xyz": [0.45, 0.1, 1.0]}, "geometry": [{"mesh": {"file": str(mesh)}}]}]}
    file = folder / f"{name}.yaml"
    file.write_text(json.dumps(content))
    return file


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="opponens")
    parser.add_argument("--shared", type=pathlib.Path, required=True, help="folder with data/ and reference/frogger")
    parser.add_argument("--store", required=True, help="a store with synergies of the Allegro hand")
    parser.add_argument("--max-penetration", default="0.005")
    parser.add_argument("--method", default="frogger", help="frogger, baseline_fc or fccorr16")
    parser.add_argument("objects", nargs="*", help="default: all")
    options = parser.parse_args()
    total = {"given": 0, "stored": 0}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        robot = robot_with_meshes(folder, options.shared)
        for file in sorted((options.shared / "reference/frogger").glob(f"*.{options.method}.json")):
            name = file.name.split(".")[0]
            if options.objects and name not in options.objects:
                continue
            mesh = options.shared / "data/objects/ycb" / name / f"{name}.obj"
            done = subprocess.run(
                [options.program, "grasp", "--store", options.store, "--robot", robot, "--scene",
                 scene(folder, name, mesh), "--import", file, "--edges", "4", "--max-penetration",
                 options.max_penetration, "--noise-samples", "0", "--threads", "1", "--json"],
                capture_output=True, text=True)
            if done.returncode not in (0, 1):
                print(f"{name}: {done.stderr.strip()}")
                continue
            found = json.loads(done.stdout)
            total["given"] += found["trials"]
            total["stored"] += len(found["grasps"])
            print(f"{name}: {len(found['grasps'])} of {found['trials']}", found["rejected"] or "", flush=True)
    print(total)


if __name__ == "__main__":
    main()
