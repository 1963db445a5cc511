# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""What `ingest` has said to be committed survives its being killed, whenever that is."""
import os
import pathlib
import random
import re
import shutil
import tempfile
import time
import unittest

from support import HEADER, data_set, must, rows, run, start

SOURCE_YAML = "models/sources/west_r2g.yaml"
RECORDINGS = 1100  # five batches
KILLS = int(os.environ.get("OPPONENS_KILLS", 50))


def acknowledged(out):
    """How many recordings the last whole line tells to be on disk."""
    counts = re.findall(r"^committed \d+ recordings \((\d+) so far\)\n", out, flags=re.M)
    return int(counts[-1]) if counts else 0


class KilledIngest(unittest.TestCase):
    def test_nothing_acknowledged_is_lost(self):
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            data = data_set(folder / "data", {f"r{i:04}": [HEADER] + rows(60, 100.0 + 0.01 * i)
                                              for i in range(RECORDINGS)})
            arguments = ["ingest", data, "--source", SOURCE_YAML, "--store"]
            begin = time.monotonic()
            self.assertEqual(len(must(*arguments, folder / "whole")["ids"]), RECORDINGS)
            lasts = time.monotonic() - begin
            chance = random.Random(12)
            killed = some = 0
            while killed < KILLS:
                store = folder / "store"
                with start(*arguments, store) as program:
                    time.sleep(chance.uniform(0.0, lasts))
                    program.kill()
                    out, _ = program.communicate()
                if program.returncode != -9:  # it had ended: the machine was busier when the time was taken
                    self.assertEqual(program.returncode, 0)
                    lasts *= 0.9
                killed += program.returncode == -9
                said = acknowledged(out)
                some += 0 < said < RECORDINGS
                self.check(store, said)
                if killed % 10 == 0:
                    self.assertEqual(len(must(*arguments, store)["ids"]), RECORDINGS)
                    self.check(store, RECORDINGS)
                    self.assertEqual(run("verify", "--store", store)[0], 0)
                shutil.rmtree(store, ignore_errors=True)
            print(f"{killed} killed, {some} of them between the first and the last batch")
            self.assertGreater(some, KILLS // 10)

    def check(self, store, said):
        if not (store / "index.bin").exists() and not list(store.glob("*.h5")):
            self.assertEqual(said, 0)
            return
        self.assertGreaterEqual(len(must("show", "--store", store)["objects"]), said)
        self.assertEqual(must("repair", "--store", store, "--dry-run")["files"], [])  # reads and checks all


if __name__ == "__main__":
    unittest.main()
