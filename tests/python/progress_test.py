"""The progress that comes with the package: in a terminal, in a notebook, and where there is neither."""

import io
import sys
import types
import unittest
from unittest import mock

import driftmesh

PLATE = driftmesh.generate("rectangle-hole")


class Terminal(io.StringIO):
    def isatty(self):
        return True


class Lines(unittest.TestCase):
    def show(self, line, triangles, forecast):
        line(types.SimpleNamespace(triangles=triangles, forecast=forecast))

    def test_terminal(self):
        terminal = Terminal()
        line = driftmesh.ProgressLine(delay=0, stream=terminal)
        self.show(line, 12_500, 50_000.0)
        self.assertIn("25%", terminal.getvalue())
        self.assertIn("12,500 of about 50,000 triangles", terminal.getvalue())
        self.show(line, 60_000, 50_000.0)
        self.assertIn("100%", terminal.getvalue())
        line.close()
        self.assertTrue(terminal.getvalue().endswith(" \r"))

    def test_no_terminal(self):
        file = io.StringIO()
        self.show(driftmesh.ProgressLine(delay=0, stream=file), 1, 2)
        self.assertEqual(file.getvalue(), "")

    def test_delay(self):
        terminal = Terminal()
        self.show(driftmesh.ProgressLine(delay=3600, stream=terminal), 1, 2)
        self.assertEqual(terminal.getvalue(), "")

    def test_notebook(self):
        """IPython as a notebook has it: a shell with a kernel, and a display whose content can be changed."""
        handle = mock.Mock()
        display = mock.Mock(return_value=handle)
        ipython = types.SimpleNamespace(get_ipython=lambda: types.SimpleNamespace(kernel="yes"),
                                        display=types.SimpleNamespace(display=display))
        with mock.patch.dict(sys.modules, {"IPython": ipython, "IPython.display": ipython.display}):
            line = driftmesh.ProgressLine(delay=0)
            self.show(line, 5, 10)
            line.close()
        self.assertEqual(display.call_count, 1)
        texts = [call.args[0]["text/plain"] for call in handle.update.call_args_list]
        self.assertIn("50%", texts[0])
        self.assertEqual(texts[1:], [""])

    def test_as_an_option(self):
        terminal = Terminal()
        driftmesh.mesh(PLATE, max_area=1e-3, progress=driftmesh.ProgressLine(delay=0, stream=terminal))
        self.assertIn("triangles", terminal.getvalue())
        driftmesh.mesh(PLATE, progress=True)
        driftmesh.mesh(PLATE, progress=False)


if __name__ == "__main__":
    unittest.main(verbosity=2)
