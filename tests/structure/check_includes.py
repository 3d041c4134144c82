#!/usr/bin/env python3
"""Holds the sources to the dependency graph that the build files declare.

usage: check_includes.py PROJECT_FOLDER

Each driftmesh_library(NAME ... DEPENDS a b) is one box: the sources in its folder may include the headers of that folder
and of the folders of a and b, no others. What they depend on in turn is not theirs to include. The graph has no cycle.
Some outside libraries are kept behind one file or folder each, so that they can be exchanged there.
"""

import pathlib
import re
import sys

# Where boxes lie.
TOPS = ("src", "protocol", "migration", "balancer")

# What lies in no box, and sees all of them.
OPEN_FOLDERS = ("tests", "bench")

# Outside headers, by how their names begin, and the only place that may include them.
BEHIND = {
    "mpi.h": "protocol/mpi/mpi_transport.cpp",
    "boost/": "migration/archive.hpp",
    "metis.h": "src/decompose/graph_partition.cpp",
    "muParser.h": "src/sizing/expression_field.cpp",
    "cairo": "src/picture/plot_",
    "CLI/": "src/app/",
    "yaml-cpp/": ("src/app/config_file.cpp", "src/experiment/experiment_file.cpp"),
    "zoltan": "balancer/zoltan/zoltan_partition.cpp",
    "CGAL/": "tests and bench alone",
}


def declared_boxes(root):
    """{box: (folder, [boxes it depends on])} from every CMakeLists.txt under the folders of boxes."""
    boxes = {}
    for path in (path for top in TOPS for path in root.glob(f"{top}/**/CMakeLists.txt")):
        text = re.sub(r"#.*", "", path.read_text())
        for call in re.findall(r"driftmesh_library\(([^)]*)\)", text):
            name, *words = call.split()
            depends, section = [], None
            for word in words:
                if word in ("SOURCES", "DEPENDS", "LIBS", "PUBLIC_LIBS"):
                    section = word
                elif section == "DEPENDS":
                    depends.append(word)
            boxes[name] = (path.parent, depends)
    return boxes


def cycle_in(boxes):
    """The boxes of one cycle, or [] when there is none."""
    done = set()

    def visit(box, way):
        if box in way:
            return way[way.index(box):] + [box]
        if box in done or box not in boxes:
            return []
        for other in boxes[box][1]:
            found = visit(other, way + [box])
            if found:
                return found
        done.add(box)
        return []

    for box in boxes:
        found = visit(box, [])
        if found:
            return found
    return []


def foreign_includes(root, boxes):
    """A message for each include that no declaration allows."""
    for folder in sorted({folder for folder, _ in boxes.values()}):
        own = [depends for other, depends in boxes.values() if other == folder]
        allowed = {folder} | {boxes[name][0] for depends in own for name in depends if name in boxes}
        for source in sorted([*folder.glob("*.cpp"), *folder.glob("*.hpp")]):
            for number, line in enumerate(source.read_text().splitlines(), 1):
                match = re.match(r'\s*#\s*include\s*"([^"]+)"', line)
                if not match:
                    continue
                header = match.group(1)
                target = next((base / header for base in (root / "src", root) if (base / header).exists()), None)
                place = f"{source.relative_to(root)}:{number}"
                if target is None:
                    yield f"{place}: {header} is not found under src/ or the root"
                elif target.parent not in allowed:
                    yield f"{place}: includes {header}, which the DEPENDS of its box does not name"


def misplaced_libraries(root):
    """A message for each outside header that is included where it should not be."""
    for source in sorted(path for top in TOPS for path in (root / top).rglob("*.[ch]pp")):
        name = str(source.relative_to(root))
        for number, line in enumerate(source.read_text().splitlines(), 1):
            match = re.match(r'\s*#\s*include\s*[<"]([^>"]+)[>"]', line)
            for header, place in BEHIND.items():
                if match and match.group(1).startswith(header) and not name.startswith(place):
                    yield f"{name}:{number}: includes {match.group(1)}, which belongs to {' and '.join([place] if isinstance(place, str) else place)}"


def undeclared_folders(root, boxes):
    """A message for each folder of sources that no box owns."""
    owned = {folder for folder, _ in boxes.values()}
    for folder in sorted({path.parent for top in TOPS for path in (root / top).rglob("*.[ch]pp")}):
        if folder not in owned and not str(folder.relative_to(root)).startswith(OPEN_FOLDERS):
            yield f"{folder.relative_to(root)}: no driftmesh_library declares this folder"


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    boxes = declared_boxes(root)
    problems = [f"{name}: depends on {other}, which no driftmesh_library declares"
                for name, (_, depends) in boxes.items() for other in depends if other not in boxes]
    cycle = cycle_in(boxes)
    if cycle:
        problems.append("cycle: " + " -> ".join(cycle))
    problems += foreign_includes(root, boxes)
    problems += misplaced_libraries(root)
    problems += undeclared_folders(root, boxes)
    for problem in problems:
        print(problem)
    print(f"{len(boxes)} boxes, {len(problems)} problems")
    sys.exit(1 if problems or not boxes else 0)


if __name__ == "__main__":
    main()
