#!/usr/bin/env python3
"""Defaults that several parts have are written once, in include/driftmesh/defaults.hpp.

No other header gives a member of the same name a number of its own, and sentences of help, headers and pages that state a default
state that one.

usage: defaults_test.py PROJECT
"""

import pathlib
import re
import sys
import unittest

PROJECT = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".")
DEFAULTS = "include/driftmesh/defaults.hpp"
FOLDERS = ["include", "src", "balancer", "migration", "protocol", "python"]

# What replays assume of a recorded run, and the latency of a move, which is more than that of a message.
OWN = {"src/cluster/replay/replay.hpp", "balancer/cost/move_cost.hpp"}

# Sentences that state what a default is or stands for, and where it is written: in a file of this folder. Tables of keys in pages are
# compared with the program.
WRITTEN = {"min_angle": ("include", r"kMinAngle = ([\d.]+)"),
           "separator_angle": ("include", r"kSeparatorAngle = ([\d.]+)"),
           "subdomains": ("src/runtime", r"kSubdomainsPerRank = (\d+)"),
           "speed": ("balancer", r"reference_speed = ([\d.]+)e6"),
           "memory": ("src/job", r"free / 100 \* (\d+)")}
SENTENCES = [("docs/theory.md", r"([\d.]+) degrees, the default", "min_angle"),
             ("docs/decomposition.md", r"([\d.]+) degrees by default", "separator_angle"),
             ("src/job/key_table.cpp", r"0: (\d+) per rank", "subdomains"),
             ("include/driftmesh/options.hpp", r"0: (\d+) per rank", "subdomains"),
             ("src/job/key_table.cpp", r"refines; 0: ([\d.]+) million", "speed"),
             ("src/job/key_table.cpp", r"0: (\d+) % of the machine's free memory", "memory"),
             ("src/job/request.hpp", r"0: (\d+) % of what the machine has free", "memory"),
             ("include/driftmesh/options.hpp", r"0: (\d+) % of the machine's free memory", "memory")]


def member(constant):
    """min_angle of kMinAngle."""
    return re.sub(r"(?<!^)([A-Z])", r"_\1", constant[1:]).lower()


def defaults():
    found = re.findall(r"constexpr [\w:]+ (k\w+) = ([\d.e+-]+);", (PROJECT / DEFAULTS).read_text())
    return {member(name): float(value) for name, value in found}


def literals(text, names):
    """Members that a number is given to where they are declared. 0 stands for none."""
    found = re.findall(rf"\b(?:double|std::\w+) ({'|'.join(names)}) = (-?[\d.]+(?:e[+-]?\d+)?)\b", text)
    return [name for name, value in found if float(value) != 0]


class Defaults(unittest.TestCase):
    def test_there_are_some(self):
        self.assertEqual(defaults()["min_angle"], 20)
        self.assertGreater(len(defaults()), 10)
        self.assertEqual(literals("double min_angle = 20;\ndouble gap = 0;\nstd::int64_t slice = 5;", defaults()), ["min_angle", "slice"])

    def test_no_other_header_writes_one(self):
        for folder in FOLDERS:
            for path in sorted((PROJECT / folder).rglob("*.hpp")):
                name = path.relative_to(PROJECT).as_posix()
                if name not in OWN:
                    self.assertEqual(literals(path.read_text(), defaults()), [], f"{name}: take it from {DEFAULTS}")

    def test_sentences_state_the_same(self):
        for page, sentence, name in SENTENCES:
            folder, written = WRITTEN[name]
            values = [value for path in (PROJECT / folder).rglob("*.[ch]pp") for value in re.findall(written, path.read_text())]
            self.assertEqual(len(values), 1, f"{name} is to be written once, in {folder}")
            stated = re.findall(sentence, (PROJECT / page).read_text())
            self.assertTrue(stated, f"{page} does not say '{sentence}'")
            self.assertEqual({float(value) for value in stated}, {float(values[0])}, page)


if __name__ == "__main__":
    unittest.main()
