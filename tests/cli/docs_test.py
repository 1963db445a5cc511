# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""docs/cli.md and the program name the same commands and the same options."""
import re
import unittest

from support import SOURCE, run

COMMON = {"--json", "--quiet", "--help"}


def sections():
    parts = re.split(r"^## (\w+)$", (SOURCE / "docs/cli.md").read_text(), flags=re.M)[1:]
    return dict(zip(parts[::2], parts[1::2]))


def options(text):
    return set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", text))


class Docs(unittest.TestCase):
    def test_same_commands(self):
        code, out, _ = run("--help")
        self.assertEqual(code, 0)
        listed = set(re.findall(r"^  ([a-z]+) {2,}\S", out.split("Subcommands:")[1], flags=re.M))
        self.assertEqual(listed, set(sections()))

    def test_same_options(self):
        for command, text in sections().items():
            with self.subTest(command=command):
                code, out, _ = run(command, "--help")
                self.assertEqual(code, 0)
                documented = set(re.findall(r"^\| `(--[a-z-]+)`", text, flags=re.M))
                self.assertEqual(documented, options(out) - COMMON)


if __name__ == "__main__":
    unittest.main()
