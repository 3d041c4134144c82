"""The stubs: they declare what the package has, name every option, and mypy understands them, if it is installed."""

import ast
import importlib.util
import pathlib
import subprocess
import sys
import tempfile
import unittest

import driftmesh

FOLDER = pathlib.Path(driftmesh.__file__).parent  # that of the built package, whose sources are links

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples" / "python"

PROGRAM = """\
import driftmesh
mesh = driftmesh.mesh(driftmesh.generate("bay", seed=7), min_angle=25, size=lambda x, y: 10 + x, subdomains={"count": 4})
reveal_type(mesh.points)
reveal_type(driftmesh.check(mesh).accepted)
driftmesh.mesh(mesh)
driftmesh.mesh(driftmesh.generate("bay"), holes="some")
driftmesh.mesh(driftmesh.generate("bay"), subdomains={"number": 3})
"""


class Stubs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.stubs = ast.parse((FOLDER / "__init__.pyi").read_text())
        cls.declared = {node.name: node for node in cls.stubs.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}

    def test_marked_as_typed(self):
        self.assertTrue((FOLDER / "py.typed").is_file())

    def test_everything_is_declared(self):
        self.assertEqual(set(driftmesh.__all__) - set(self.declared), {"__version__"})

    def test_members(self):
        for name in ("CheckReport", "Decomposition", "DistributedPiece", "GhostedPiece", "Load", "Mesh", "Progress", "Pslg", "SimulatedRun"):
            has = {member for member, value in vars(getattr(driftmesh, name)).items() if not member.startswith("_")}
            declares = {node.name for node in self.declared[name].body if not node.name.startswith("_")}
            self.assertEqual(declares, has, name)

    def test_members_are_described(self):
        """In words, and arrays by their shapes."""
        for name in set(driftmesh.__all__) & set(self.declared):
            node = self.declared[name]
            self.assertTrue(getattr(driftmesh, name).__doc__, name)
            for member in (m for m in node.body if isinstance(m, ast.FunctionDef) and not m.name.startswith("_")):
                with self.subTest(member=f"{name}.{member.name}"):
                    said = getattr(getattr(driftmesh, name), member.name).__doc__
                    self.assertTrue(said)
                    if member.decorator_list and ast.unparse(member.returns) in ("Floats", "Integers", "LongIntegers"):
                        self.assertIn("shape (", said)

    def test_options(self):
        for name in ("mesh", "check", "mesh_distributed", "simulate"):
            keywords = {argument.arg for argument in self.declared[name].args.kwonlyargs}
            for option in driftmesh.option_table():
                section, _, member = option["name"].rpartition(".")
                self.assertIn(section or member, keywords)
                if section:
                    self.assertIn(member, [node.target.id for node in self.declared[section.title()].body])

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    def test_mypy(self):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "program.py"
            program.write_text(PROGRAM)
            said = subprocess.run([sys.executable, "-m", "mypy", "--cache-dir", folder, "--strict", program], capture_output=True,
                                  text=True, check=False).stdout
        self.assertRegex(said, r'program.py:3: note: Revealed type is "numpy.ndarray\[Any, numpy.dtype\[numpy.floating\[')
        self.assertIn('program.py:4: note: Revealed type is "builtins.bool"', said)
        errors = [int(line.split(":")[1]) for line in said.splitlines() if "error:" in line and "program.py" in line]
        self.assertEqual(errors, [5, 6, 7], said)
        self.assertNotIn("pyi:", said)

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    def test_mypy_on_examples(self):
        examples = [str(path) for path in EXAMPLES.glob("*.py")]
        self.assertGreater(len(examples), 2)
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-m", "mypy", "--cache-dir", folder, "--ignore-missing-imports", *examples],
                                  capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
