"""Progress in a terminal or a notebook."""

import sys
import time


class ProgressLine:
    """Shows progress in one line: progress=ProgressLine(), or progress=True.

    In a notebook it is shown by IPython, elsewhere on standard error if that is a terminal. `delay`: nothing is shown for
    work that takes less than this many seconds.
    """

    def __init__(self, *, delay=0.5, stream=None):
        self._start = time.monotonic()
        self._delay = delay
        self._stream = sys.stderr if stream is None else stream
        self._notebook = notebook_display() if stream is None else None
        self._shown = ""

    def __call__(self, progress):
        if time.monotonic() - self._start >= self._delay:
            self._show(text_of(progress))

    def close(self):
        """Remove the line."""
        if self._shown:
            self._show("")

    __del__ = close

    def _show(self, text):
        if self._notebook is not None:
            self._notebook.update(text)
        elif self._stream.isatty():
            self._stream.write("\r" + text.ljust(len(self._shown)) + ("" if text else "\r"))
            self._stream.flush()
        self._shown = text


def text_of(progress):
    made, expected = progress.triangles, progress.forecast
    share = min(1, made / expected) if expected > 0 else 0
    bar = "#" * round(30 * share)
    return f"[{bar:30}] {share:4.0%}  {made:,} of about {round(expected, -3):,.0f} triangles"


class NotebookLine:
    """A line of text under a notebook's cell."""

    def __init__(self, display):
        self._handle = display({"text/plain": ""}, raw=True, display_id=True)

    def update(self, text):
        self._handle.update({"text/plain": text}, raw=True)


def notebook_display():
    """A line in the notebook that runs this program; None elsewhere. IPython is not asked for unless it is at work."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    if shell is None or not hasattr(shell, "kernel"):
        return None
    return NotebookLine(sys.modules["IPython"].display.display)
