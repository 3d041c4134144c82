#!/usr/bin/env python3
"""Checks that the kinds of bounds on sizes are known in one place, src/mesh/size_bound.cpp.

Whoever refines, forecasts, cuts, maps or moves asks SizeBounds, all kinds together. What reads the values of one kind, or asks a size
field by itself, would have to be changed for each new kind.

usage: check_kinds.py PROJECT
"""

import pathlib
import re
import sys

from check_stages import without_comments

# Where meshes are made.
FOLDERS = ["src/mesh", "src/decompose", "src/mapping", "src/runtime", "src/cluster", "src/distributed", "migration"]

KINDS = {"src/mesh/bounds.hpp", "src/mesh/size_bound.hpp", "src/mesh/size_bound.cpp"}
HANDS_ON = {
    "src/runtime/plan_bytes.cpp": "region_max_area",  # to other ranks
    "src/mesh/area_for_count.cpp": "plain.area",  # chooses it
}

QUESTIONS = "edge_length|falls_below|least_between|visit_marks"


def members_of(struct, text):
    """The names of a struct's members."""
    body = re.search(rf"struct {struct} {{(.*?)\n}};", without_comments(text), re.DOTALL)
    return re.findall(r"(\w+)(?: = [^;]*|{})?;", body[1]) if body else []


def problems(project):
    project = pathlib.Path(project)
    bounds = project / "src/mesh/bounds.hpp"
    plain = members_of("PlainBounds", bounds.read_text()) if bounds.exists() else []
    if not plain:
        return ["src/mesh/bounds.hpp: has no PlainBounds; correct check_kinds.py"]
    values = rf"\bplain\.(?:{'|'.join(plain)})\b|\bregion_max_area\b|\bbounds_?\.size\b(?! = )"
    found = []
    for path in sorted(path for folder in FOLDERS for path in (project / folder).rglob("*.[ch]pp")):
        name = path.relative_to(project).as_posix()
        code = without_comments(path.read_text())
        if name in KINDS:
            continue
        for word in sorted(set(re.findall(values, code)) - {HANDS_ON.get(name)}):
            found.append(f"{name}: reads {word}, the value of one kind of bound; ask SizeBounds")
        if re.search(rf"(?:->|\bfield_?\.|\bsize_?\.)(?:{QUESTIONS})\(", code):
            found.append(f"{name}: asks a size field; ask SizeBounds")
    return found


if __name__ == "__main__":
    all_problems = problems(sys.argv[1])
    print("\n".join(all_problems) or "kinds of bounds are known in src/mesh/size_bound.cpp alone")
    sys.exit(1 if all_problems else 0)
