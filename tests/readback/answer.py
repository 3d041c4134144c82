"""How a reader answers: one line of JSON on rank 0."""

import collections
import json


def import_or_say(name):
    """The module; ends the process with an answer that says why there is none."""
    import importlib
    import sys
    try:
        return importlib.import_module(name)
    except ImportError as error:
        print(json.dumps({"missing": str(error)}))
        sys.exit(0)


def counts(values):
    """{value: how often}, by whole numbers."""
    return {str(value): count for value, count in sorted(collections.Counter(int(v) for v in values).items())}


def area(points, triangles):
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return float((((b - a)[:, 0] * (c - a)[:, 1] - (c - a)[:, 0] * (b - a)[:, 1]) / 2).sum())


def answer(version, **facts):
    print(json.dumps({"version": str(version), **facts}), flush=True)
