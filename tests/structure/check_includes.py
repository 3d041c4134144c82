#!/usr/bin/env python3
"""Checks the sources against the dependency graph that the build files declare.

usage: check_includes.py [--graph | --update] PROJECT_FOLDER

Each driftmesh_library(NAME SOURCES ... DEPENDS a b LIBS x y) is one box, and one folder with a CMakeLists.txt of its own.
  - Its files include headers of their own folder and of the folders of a and b, no others; each of a and b is included.
  - Includes are followed to the end: whatever they lead to lies in boxes that the box stands on.
  - An outside library is named in LIBS by every box that includes it, be it through the header of another box. What LIBS
    names is included, and LIBRARIES below allows it.
  - The graph has no cycle, KEPT_APART holds whatever is declared, and docs/architecture.md shows the graph as it is.
--graph prints that graph; --update writes it into docs/architecture.md.
"""

import functools
import pathlib
import re
import sys

from boxes import INCLUDE_ROOTS, TOPS, closure, cycle_in, declared_boxes, graph, without_remarks

# Outside libraries: the names of their headers, and the boxes that may use them (None: any that says so).
LIBRARIES = {
    "cairo": (r"cairo.*\.h", ["picture"]),
    "cli11": (r"CLI/.*", ["cli"]),
    "fmt": (r"fmt/.*", None),
    "gdal": (r"(gdal|ogr|cpl)\w*\.h", ["gis"]),
    "hdf5": (r"hdf5\.h", ["hdf5", "io"]),
    "json": (r"nlohmann/.*", None),
    "metis": (r"metis\.h", ["decompose"]),
    "boost_serialization": (r"boost/(archive|serialization)/.*", ["migration"]),
    "mpi": (r"mpi\.h", ["api_mpi", "partition_zoltan", "public_mpi", "python_ranks", "transport_mpi"]),  # Zoltan's own header needs it
    "pybind11": (r"pybind11/.*", ["python", "python_ranks"]),
    "threads": (r"thread|future", None),
    "yaml": (r"yaml-cpp/.*", ["config"]),
    "zlib": (r"zlib\.h", ["report", "zlib"]),
    "zoltan": (r"zoltan.*\.h", ["partition_zoltan"]),
}

# Headers of the standard library and of POSIX, malloc.h of the C library, and io.h of Windows: free for all.
STANDARD = re.compile(r"""[a-z_]+ | sys/[a-z]+\.h
    | (assert|ctype|dirent|dlfcn|errno|fcntl|fenv|float|inttypes|io|limits|locale|malloc|math|poll|pthread|sched|setjmp|signal
       |stdarg|stddef|stdint|stdio|stdlib|string|strings|termios|time|unistd|wchar|wctype)\.h""", re.VERBOSE)

# Dependencies that are never allowed: algorithms see no messages; planners and mobile objects see no communicator, policies no
# controller.
MESSAGES = ["protocol", "transport_mpi"]
KEPT_APART = {"mesh": MESSAGES, "decompose": MESSAGES, "verify": MESSAGES, "io": MESSAGES, "picture": MESSAGES,
              "balancer": MESSAGES[1:], "policies": [*MESSAGES[1:], "balancer"], "migration": MESSAGES[1:]}

PAGE = "docs/architecture.md"
BEGIN, END = "<!-- check_includes.py --graph -->\n```text\n", "```\n<!-- end of the graph -->\n"


class Tree:
    """The files of the project and what they include. Names of files are relative to its folder."""

    def __init__(self, root):
        self.root = root
        self.known = {}

    def name(self, path):
        return str(path.relative_to(self.root))

    def includes(self, path):
        """[(number of the line, header as it is written, its file or None if it is not the project's)]"""
        if path not in self.known:
            self.known[path] = [(number, *self.resolved(path, match.group(1), match.group(2)))
                                for number, line in enumerate(path.read_text().splitlines(), 1)
                                if "include" in line and (match := re.match(r'\s*#\s*include\b\s*(.)([^>"]*)', line))]
        return self.known[path]

    def resolved(self, path, mark, header):
        if mark not in '<"':
            return mark + header, None
        return header, self.found(header, path.parent if mark == '"' else None)

    @functools.cache
    def found(self, header, folder):
        """The file of this name in the folder or in those that headers are named from, or None."""
        folders = [folder] * bool(folder) + [self.root / top for top in INCLUDE_ROOTS]
        found = next((place for top in folders if (place := top / header).is_file()), None)
        return found.resolve() if found else None

    def reached(self, path):
        """{file of the project, or name of an outside header: the files on the way there}, transitively."""
        ways, waiting = {}, [(path, [])]
        for file, way in waiting:
            for _, header, target in self.includes(file):
                if (target or header) not in ways:
                    ways[target or header] = way
                    waiting += [(target, way + [target])] * bool(target)
        return ways

    def reach(self, source, way, end):
        return f"{self.name(source)}: reaches " + " -> ".join([*map(self.name, way), end])


def files_in(folder):
    return sorted(path for path in folder.iterdir()
                  if re.fullmatch(r"\.([chi]pp|cc|cxx|hh|hxx|ipp|tpp|inl|inc|[chi])", path.suffix))


@functools.cache
def library_of(header):
    """The outside library that a header belongs to: "" if it is a standard one, None if it is unknown."""
    known = next((name for name, (headers, _) in LIBRARIES.items() if re.fullmatch(headers, header)), None)
    return "" if known is None and STANDARD.fullmatch(header) else known


def declaration_problems(tree, declared, boxes):
    """The problems of the declarations themselves."""
    folders = [box.folder for box in declared]
    for box in declared:
        place = tree.name(box.folder)
        if [other.name for other in declared].count(box.name) > 1 or folders.count(box.folder) > 1:
            yield f"{place}: {box.name} is not the one box of one folder"
        for source in box.sources:
            if "/" in source:
                yield f"{place}: {box.name} has {source}, which lies in another folder"
        for other in box.depends:
            if other not in boxes:
                yield f"{box.name}: depends on {other}, which no driftmesh_library declares"
        for lib in box.libs:
            allowed = LIBRARIES[lib][1] if lib in LIBRARIES else []
            if allowed is not None and box.name not in allowed:
                yield f"{box.name}: must not use {lib}, which belongs to {' and '.join(allowed) or 'no box'}"
        for word in re.findall(r"target_link_libraries\(\s*dm_|\w*include_directories", without_remarks(box.folder / "CMakeLists.txt")):
            yield f"{place}/CMakeLists.txt: {word} goes around the declaration"
    if cycle := cycle_in(boxes):
        yield "cycle: " + " -> ".join(cycle)
    for name, others in KEPT_APART.items():
        for other in others:
            if name in boxes and other in closure(boxes, name):
                yield f"{name}: stands on {other}, from which it is kept apart"
    for folder in sorted({path.parent for top in TOPS for path in (tree.root / top).rglob("*.[ch]pp")} - set(folders)):
        yield f"{tree.name(folder)}: no driftmesh_library declares this folder"


def include_problems(tree, boxes, box):
    """What a box includes without permission, and what it declares without including it."""
    box_of = {other.folder: name for name, other in boxes.items()}
    below = closure(boxes, box.name)
    used_boxes, used_libs, told = set(), set(), set()  # one way to each box or library that is out of reach will do
    for source in files_in(box.folder):
        for number, header, target in tree.includes(source):
            place = f"{tree.name(source)}:{number}"
            owner = target and box_of.get(target.parent, "no box")
            used_boxes.add(owner)
            if not target and library_of(header) is None:
                yield f"{place}: includes {header}, which is neither of this project nor of a known library"
            elif target and owner not in (box.name, *box.depends):
                yield f"{place}: includes {header} ({owner}), which the DEPENDS of {box.name} does not name"
        for target, way in tree.reached(source).items():
            if isinstance(target, str):
                lib = library_of(target)
                used_libs.add(lib)
                if lib and lib not in box.libs and lib not in told:
                    told.add(lib)
                    yield f"{tree.reach(source, way, target)}, and the LIBS of {box.name} does not name {lib}"
            elif way and (owner := box_of.get(target.parent)) not in below and owner not in told:
                told.add(owner)
                yield f"{tree.reach(source, way, tree.name(target))}, which {box.name} does not stand on"
    yield from (f"{box.name}: depends on {other} and includes nothing of it" for other in box.depends if other not in used_boxes)
    yield from (f"{box.name}: names {lib} in LIBS and includes nothing of it" for lib in box.libs if lib not in used_libs)


def page_with(page, text):
    """The page with this graph between its marks; None if it has none."""
    before, begin, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    return before + begin + text + end + after if end else None


def problems_of(root):
    tree = Tree(root)
    declared = declared_boxes(root)
    boxes = {box.name: box for box in declared}
    problems = list(declaration_problems(tree, declared, boxes))
    for box in boxes.values():
        problems += include_problems(tree, boxes, box)
    page = (root / PAGE).read_text()
    if not problems and page != page_with(page, graph(boxes)):
        problems.append(f"{PAGE}: shows another graph; run check_includes.py --update {root}")
    return boxes, problems


def main():
    option = sys.argv[1] if len(sys.argv) > 2 else ""
    root = pathlib.Path(sys.argv[-1]).resolve()
    boxes = {box.name: box for box in declared_boxes(root)}
    if option == "--graph":
        print(graph(boxes), end="")
    elif option == "--update":
        (root / PAGE).write_text(page_with((root / PAGE).read_text(), graph(boxes)))
    else:
        boxes, problems = problems_of(root)
        print(*problems, f"{len(boxes)} boxes, {len(problems)} problems", sep="\n")
        sys.exit(1 if problems or not boxes else 0)


if __name__ == "__main__":
    main()
