"""Runs the blocks of Python in docs/python.md, docs/which-tool.md and README.md one after the other, and the examples.

usage: docs_test.py SOURCE_FOLDER
"""

import contextlib
import importlib.util
import io
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv.pop(1))
NEEDS = {"adaptive_poisson": "scipy", "adaptive_dolfinx": "dolfinx"}


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)

    def run_page(self, name, least):
        """What the blocks of a page print. Errors name the line of the page."""
        page = (SOURCE / name).read_text()
        blocks = re.findall(r"^```python\n(.*?)^```", page, flags=re.MULTILINE | re.DOTALL)
        self.assertGreaterEqual(len(blocks), least)
        names, said = {}, io.StringIO()
        for block in blocks:
            line = page[:page.index(block)].count("\n")
            with contextlib.redirect_stdout(said):
                exec(compile("\n" * line + block, name, "exec"), names)
        return said.getvalue()

    def test_page(self):
        self.assertIn("accepted", self.run_page("docs/python.md", 9))
        for file in ("bay.vtu", "bay.png", "frame.poly", "frame.pvtu"):
            self.assertTrue(pathlib.Path(file).is_file(), file)

    def test_other_tools(self):
        self.assertIn("{1, 2, 3, 4}", self.run_page("docs/which-tool.md", 2))

    @unittest.skipUnless(importlib.util.find_spec("scipy"), "scipy is not installed")
    def test_readme(self):
        self.run_page("README.md", 2)
        for file in ("bay.png", "solution.png"):
            self.assertTrue(pathlib.Path(file).is_file(), file)

    def run_example(self, name, *arguments):
        if name in NEEDS and importlib.util.find_spec(NEEDS[name]) is None:
            self.skipTest(f"{NEEDS[name]} is not installed")
        done = subprocess.run([sys.executable, SOURCE / "examples" / "python" / f"{name}.py", *arguments], capture_output=True, text=True,
                              timeout=250, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def test_first_mesh(self):
        self.assertIn("accepted", self.run_example("first_mesh"))
        self.assertTrue(pathlib.Path("bay.png").read_bytes().startswith(b"\x89PNG"))

    def test_adaptive_poisson(self):
        self.assertIn("to the power of -", self.run_example("adaptive_poisson"))

    def test_moving_front(self):
        self.assertIn("mass:", self.run_example("moving_front", "", "0.05"))

    def test_adaptive_dolfinx(self):
        self.assertIn("to the power of -", self.run_example("adaptive_dolfinx"))

    def test_own_policy(self):
        self.assertEqual(len(self.run_example("own_policy").splitlines()), 5)

    def test_every_example_is_run(self):
        examples = {path.stem for path in (SOURCE / "examples" / "python").glob("*.py")}
        self.assertEqual({f"test_{name}" for name in examples} - set(dir(self)), set())


if __name__ == "__main__":
    unittest.main(verbosity=2)
