#!/usr/bin/env python3
"""The library for C exports what its header declares, under its version, and nothing else.

usage: exports_test.py LIBRARY HEADER
"""

import pathlib
import re
import subprocess
import sys

library, header = sys.argv[1:]
declared = set(re.findall(r"^(?:int|void|const char ?\*)\s*(\w+)\(", pathlib.Path(header).read_text(), re.MULTILINE))
listed = subprocess.run(["nm", "-D", "--defined-only", "--with-symbol-versions", library], capture_output=True, text=True, check=True).stdout
exported = {name: version for name, version in re.findall(r" [TWBDRVu] (\w+)@@?(\w+)", listed)}
assert len(declared) == 5, declared
assert set(exported) == declared, (sorted(set(exported) ^ declared))
assert set(exported.values()) == {"DRIFTMESH_TRIANGLE_1"}, exported
print(f"exports {', '.join(sorted(exported))}")
