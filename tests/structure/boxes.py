"""The boxes of the project as the build files declare them, and the graph of their dependencies."""

import dataclasses
import pathlib
import re

# The folders of boxes, and the folders that their headers are named from.
TOPS = ("include", "src", "protocol", "migration", "balancer", "python")
INCLUDE_ROOTS = ("src", ".", "include")

SECTIONS = ("SOURCES", "NEED", "ELSE", "DEPENDS", "LIBS")


@dataclasses.dataclass
class Box:
    """One driftmesh_library(name SOURCES ... NEED lib ... ELSE ... DEPENDS ... LIBS ...), which is the folder that declares it."""

    name: str
    folder: pathlib.Path
    sources: list
    depends: list
    libs: list


def declared_boxes(root):
    """Every box that a CMakeLists.txt under the folders of boxes declares, in a list: names and folders may repeat."""
    boxes = []
    for path in sorted(path for top in TOPS for path in (root / top).rglob("CMakeLists.txt")):
        for call in re.findall(r"driftmesh_library\(([^)]*)\)", without_remarks(path)):
            name, *words = call.split()
            sections, section = {name: [] for name in SECTIONS}, None
            for word in words:
                if word in SECTIONS:
                    section = word
                elif section:
                    sections[section].append(word)
            sources = sections["SOURCES"] + sections["NEED"][1:] + sections["ELSE"]
            boxes.append(Box(name, path.parent, sources, sections["DEPENDS"], sections["LIBS"]))
    return boxes


def without_remarks(path):
    return re.sub(r"#.*", "", path.read_text())


def closure(boxes, name):
    """The names of all boxes that the box of this name depends on, including itself."""
    found, open_names = set(), [name]
    while open_names:
        name = open_names.pop()
        if name in boxes and name not in found:
            found.add(name)
            open_names += boxes[name].depends
    return found


def cycle_in(boxes):
    """The names along one cycle, or [] when there is none."""
    done = set()

    def visit(name, way):
        if name in way:
            return way[way.index(name):] + [name]
        if name in done or name not in boxes:
            return []
        for other in boxes[name].depends:
            found = visit(other, way + [name])
            if found:
                return found
        done.add(name)
        return []

    return next(filter(None, (visit(name, []) for name in boxes)), [])


def graph(boxes):
    """The graph as text: a line for each box, with its dependencies except those implied by others, and its
    outside libraries. Lowest boxes first; boxes between two empty lines stand on those above the line. No cycle, please."""
    level = {}

    def level_of(name):
        if name not in level:
            level[name] = 1 + max(map(level_of, boxes[name].depends), default=0)
        return level[name]

    def nearest(name):
        depends = boxes[name].depends
        return sorted(other for other in depends
                      if not any(other in closure(boxes, third) for third in depends if third != other))

    width = max(map(len, boxes), default=0)
    lines, last = [], 1
    for name in sorted(boxes, key=lambda name: (level_of(name), name)):
        if level[name] != last:
            lines.append("")
        last = level[name]
        arrow = " -> " + " ".join(nearest(name)) if boxes[name].depends else ""
        libs = "  [" + " ".join(sorted(boxes[name].libs)) + "]" if boxes[name].libs else ""
        lines.append((f"{name:<{width}}" + arrow + libs).rstrip())
    return "\n".join(lines) + "\n"
