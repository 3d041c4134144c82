#!/usr/bin/env python3
"""Makes programs of the examples in the comments of public headers, between \\code and \\endcode: one of those that need no ranks, one of
those that call MPI or simulate ranks. Each example is a function of its own, unless it begins with an #include: then it is a whole file,
the shared library of a policy. A header without an example is an error.

usage: extract.py INCLUDE_FOLDER OUTPUT_FOLDER        (writes serial.cpp, ranks.cpp, policy_library.cpp)
"""

import pathlib
import re
import sys
from typing import NamedTuple

ON_RANKS = re.compile(r"\b(MPI_|simulate\()")
MOST_LINES = 8
COMMENT = re.compile(r"\s*/// ?")


class Example(NamedTuple):
    header: str   # as it is included
    path: pathlib.Path
    line: int     # of its first line
    text: str

    @property
    def name(self):
        return re.sub(r"\W", "_", self.header.removesuffix(".hpp"))

    @property
    def is_file(self):
        return self.text.startswith("#include")


def examples_of(path, header):
    lines, begin = path.read_text().splitlines(), None
    for number, line in enumerate(lines):
        words = COMMENT.sub("", line, count=1)
        if words == r"\code":
            begin = number + 1
        elif words == r"\endcode":
            text = "\n".join(COMMENT.sub("", inner, count=1) for inner in lines[begin:number]) + "\n"
            if number - begin > MOST_LINES:
                raise ValueError(f"{path}:{begin + 1}: an example of more than {MOST_LINES} lines")
            yield Example(header, path, begin + 1, text)
            begin = None
    if begin is not None:
        raise ValueError(f"{path}:{begin}: \\code without \\endcode")


def placed(example):
    return f'#line {example.line} "{example.path}"\n{example.text}'


def program(examples, files, setup):
    headers = "".join(f'#include "{header}"\n' for header in dict.fromkeys(["driftmesh/driftmesh.hpp", *(e.header for e in examples)]))
    functions = "".join(f"static void {e.name}_{i}() {{\n{placed(e)}}}\n" for i, e in enumerate(examples))
    calls = "".join(f'  failed += run("{e.header}", {e.name}_{i});\n' for i, e in enumerate(examples))
    calls += "".join(f'  failed += run("{e.header}", load_policy);\n' for e in files)
    return f"""// Made by extract.py.
#undef NDEBUG
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

{headers}
{'#include "driftmesh/policy_library.hpp"' if files else ""}
{POLICY if files else ""}
{functions}
static int run(const char* header, void (*example)()) {{
  std::cout << header << std::endl;
  try {{
    example();
    return 0;
  }} catch (const std::exception& error) {{
    std::cerr << "the example of " << header << " threw: " << error.what() << std::endl;
    return 1;
  }}
}}

int main({"int argc, char** argv" if setup else ""}) {{
  {"MPI_Init(&argc, &argv);" if setup else ""}
  int failed = 0;
{calls}  {"MPI_Finalize();" if setup else ""}
  return failed == 0 ? 0 : 1;
}}
"""


# What a program does that loads the library.
POLICY = """extern "C" const driftmesh::balancer::PolicyEntry driftmesh_policy;
static void load_policy() {
  driftmesh::balancer::Parameters parameters(driftmesh_policy.name, {});
  assert(driftmesh_policy.make(parameters) != nullptr && std::string(DRIFTMESH_VERSION) == driftmesh_policy.version);
}
"""


def main():
    include, output = map(pathlib.Path, sys.argv[1:])
    headers = {str(path.relative_to(include)): path for path in sorted(include.glob("driftmesh/**/*.hpp"))}
    found = {header: list(examples_of(path, header)) for header, path in headers.items()}
    if missing := [header for header, examples in found.items() if not examples]:
        sys.exit(f"no example in the comments of {', '.join(missing)} (between \\code and \\endcode)")
    examples = [example for of_header in found.values() for example in of_header]
    files = [e for e in examples if e.is_file]
    ranks = [e for e in examples if not e.is_file and ON_RANKS.search(e.text)]
    serial = [e for e in examples if e not in files and e not in ranks]
    (output / "serial.cpp").write_text(program(serial, files, setup=False))
    (output / "ranks.cpp").write_text(program(ranks, [], setup=True))
    (output / "policy_library.cpp").write_text("".join(map(placed, files)))


if __name__ == "__main__":
    main()
