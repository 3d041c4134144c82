"""Runs the program for tests, each in a folder of its own that is empty at first.

A test ends with program.main(), and is started as: NAME_test.py DRIFTMESH [unittest options]
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PATH = None  # of the program
MESHER_SECONDS = 120  # far more than any call here needs: a hang fails, a slow machine does not

SQUARE = """4 2 0 0
1 0 0
2 4 0
3 4 4
4 0 4
4 1
1 1 2 1
2 2 3 2
3 3 4 3
4 4 1 4
0
"""

# More ranks than cores, and root in a container, must be allowed explicitly. Open MPI also leaks on purpose.
RANKS_ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                         OMPI_MCA_rmaps_base_oversubscribe="1", ASAN_OPTIONS="detect_leaks=0")


def without_progress(errors):
    """Standard error of a run that took more than five seconds here."""
    return re.sub(r"^\[[^]]+\] .*\n", "", errors, flags=re.MULTILINE)


class Cli(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_program(self, *arguments):
        in_subdomains = {"-n", "--decomposition"}.intersection(arguments)
        starts_mpi = arguments and (arguments[0] in ("run", "replay", "calibrate") or arguments[0] == "mesh" and in_subdomains)
        return subprocess.run([PATH, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                              errors="replace", timeout=MESHER_SECONDS, check=False,
                              env=RANKS_ENVIRONMENT if starts_mpi else None)

    def succeed(self, *arguments):
        result = self.run_program(*arguments)
        self.assertEqual(result.returncode, 0, f"{arguments}\n{result.stdout}{result.stderr}")
        return result.stdout

    def refuse(self, *arguments, code=1, says=()):
        """The call ends with `code` and an error of few lines that contains every word of `says`."""
        result = self.run_program(*arguments)
        self.assertEqual(result.returncode, code, f"{arguments}\n{result.stdout}{result.stderr}")
        errors = [line for line in result.stderr.splitlines() if line]
        self.assertTrue(1 <= len(errors) <= 12, result.stderr)
        for word in says:
            self.assertIn(word, result.stderr)
        return result

    def on_ranks(self, ranks, *arguments):
        return subprocess.run(["mpiexec", "-n", str(ranks), PATH, *map(str, arguments)], cwd=self.folder,
                              capture_output=True, text=True, errors="replace", timeout=MESHER_SECONDS, check=False,
                              env=RANKS_ENVIRONMENT)

    def write(self, name, text):
        path = self.folder / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return name

    def files(self):
        return sorted(path.name for path in self.folder.iterdir())


def main():
    global PATH
    PATH = os.path.abspath(sys.argv.pop(1))
    unittest.main("__main__")
