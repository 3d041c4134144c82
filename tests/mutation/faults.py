"""One-line faults as data, and sources that contain them all.

A file of faults (faults/*.faults) is read line by line:

    file migration/subdomain.cpp                     the source of the faults that follow
    ? a subdomain forgets where it came from         begins a fault: what it means
    @ void Subdomain::sleep()                        look behind this text (lines of @ follow each other); without: from the top
    - dormant->counters = refiner.counters;          what stands there: statements, if it ends with ; or }, otherwise an expression
    +                                                what is put there; nothing: the statement is missing
    = it is overwritten at once                      why it changes nothing that a test could see; only for such faults
    # remark
"""

import dataclasses
import pathlib
import re
import zlib

FOLDER = pathlib.Path(__file__).resolve().parent / "faults"


@dataclasses.dataclass
class Fault:
    box: str
    file: str
    meaning: str
    anchors: list
    right: str
    wrong: str
    harmless: str  # why nobody can notice; empty for those that a test must notice
    line: str      # where it is written, as file:line

    @property
    def number(self):
        """What the environment calls it: depends on the fault alone."""
        text = "\n".join([self.file, *self.anchors, self.right, "becomes", self.wrong])
        return zlib.crc32(text.encode()) or 1


class BadFault(Exception):
    pass


def parse(text, box, name="text"):
    faults, file, current = [], None, None

    def finish():
        if current is None:
            return
        where = f"{name}:{current['line']}"
        if file is None or not current["right"]:
            raise BadFault(f"{where}: a fault needs a file and a line that begins with -")
        if not current["changed"]:
            raise BadFault(f"{where}: a fault needs a line that begins with +")
        faults.append(Fault(box, file, current["meaning"], current["anchors"], "\n".join(current["right"]), "\n".join(current["wrong"]).strip(),
                            " ".join(current["harmless"]), where))

    for number, raw in enumerate(text.splitlines(), 1):
        line = raw.strip()
        if not line or line.startswith("#"):
            continue
        head, rest = line[0], line[1:].strip()
        if line.startswith("file "):
            finish()
            current, file = None, line[5:].strip()
        elif head == "?":
            finish()
            current = {"meaning": rest, "anchors": [], "right": [], "wrong": [], "harmless": [], "line": number, "changed": False}
        elif current is None or head not in "@-+=":
            raise BadFault(f"{name}:{number}: {line!r} belongs to no fault")
        elif head == "+":
            current["changed"] = True
            current["wrong"].append(rest)
        else:
            current[{"@": "anchors", "-": "right", "=": "harmless"}[head]].append(rest)
    finish()
    return faults


def read(folder=FOLDER):
    faults = [f for path in sorted(pathlib.Path(folder).glob("*.faults")) for f in parse(path.read_text(), path.stem, path.name)]
    numbers = {}
    for fault in faults:
        if fault.number in numbers:
            raise BadFault(f"{fault.line}: the same fault as {numbers[fault.number].line}")
        numbers[fault.number] = fault
    return faults


def span_of(fault, source):
    """Where the right text stands, from and to; blanks and ends of lines are all the same."""
    def find(text, start):
        found = re.compile(r"\s+".join(re.escape(word) for word in text.split())).search(source, start)
        return found and found.span()

    start = 0
    for anchor in fault.anchors:
        place = find(anchor, start)
        if place is None:
            raise BadFault(f"{fault.line}: {fault.file} has no {anchor!r}")
        start = place[1]
    place = find(fault.right, start)
    if place is None:
        raise BadFault(f"{fault.line}: {fault.file} has no {fault.right!r}" + (f" behind {fault.anchors[-1]!r}" if fault.anchors else ""))
    if is_statement(fault.right) and not may_begin_statement(source[:place[0]]):
        raise BadFault(f"{fault.line}: {fault.right!r} ends as a statement does, but is not the whole of one")
    if not fault.anchors and find(fault.right, place[1]) is not None:
        raise BadFault(f"{fault.line}: {fault.file} has {fault.right!r} more than once; say behind what, by a line that begins with @")
    if not is_statement(fault.right) and not (is_whole(fault.right, source[:place[0]], source[place[1]:]) and is_whole(fault.wrong, "", "")):
        raise BadFault(f"{fault.line}: {fault.right!r} is not the whole of an expression there")
    return place


BINDS = {operator: rank for rank, level in enumerate(["? :", "||", "&&", "== !=", "< > <= >=", "+ -", "* / %"]) for operator in level.split()}


def is_whole(text, before, behind):
    """Whether it is an expression, and the same in parentheses: no operator beside it binds more tightly than one within it. Operators stand between blanks."""
    depth, loosest = 0, len(BINDS)
    if re.match(r"(if|else|for|while|return|throw)\b", text):
        return False
    for word in re.findall(r"[()\[\]{}]|(?<=\s)(?:[|&=!<>]=?=?|\|\||&&|[-+*/%?:])(?=\s)", " " + text + " "):
        depth += (word in "([{") - (word in ")]}")
        if depth < 0:
            return False
        if depth == 0 and word in BINDS:
            loosest = min(loosest, BINDS[word])
    if depth != 0:
        return False
    left = re.search(r"\s(\|\||&&|[=!<>]=|[-+*/%<>])\s+$", before)
    right = re.match(r"\s+(\|\||&&|[=!<>]=|[-+*/%<>?])\s", behind)
    if re.search(r"[(\s]!$", before):
        return loosest == len(BINDS)
    if left and BINDS[left[1]] >= loosest + (left[1] in ("||", "&&")):  # these alone mean the same wherever they are begun
        return False
    return not right or BINDS[right[1]] <= loosest


def may_begin_statement(before):
    before = re.sub(r"//[^\n]*$", "", re.sub(r"(\s*//[^\n]*\n\s*)+$", "", before)).rstrip()
    return not before or before.endswith((";", "{", "}", ")", ":", "else"))


def is_statement(text):
    return text.rstrip().endswith((";", "}"))


def choice(right, faults):
    """C++ that is `right`, or wrong if one of these faults is on."""
    if is_statement(faults[0].right):
        text = "{ "
        for fault in faults:
            text += f"if (driftmesh_fault({fault.number}U)) {{ {fault.wrong} }} else "
        return text + "{ " + right + " } }"
    text = right
    for fault in reversed(faults):
        text = f"(driftmesh_fault({fault.number}U) ? ({fault.wrong}) : ({text}))"
    return text


def schemata(source, faults):
    """The source with all these faults in it, each behind its switch."""
    places = {}
    for fault in faults:
        places.setdefault(span_of(fault, source), []).append(fault)

    def write(begin, end, inside):
        """source[begin:end] with the places inside, which are in order."""
        text, at = "", begin
        while inside:
            (first, last), here = inside[0]
            within = [p for p in inside[1:] if p[0][0] < last]
            if any(p[0][1] > last for p in within):
                raise BadFault(f"{here[0].line} overlaps {next(p for p in within if p[0][1] > last)[1][0].line}")
            text += source[at:first] + choice(write(first, last, within), here)
            at, inside = last, inside[1 + len(within):]
        return text + source[at:end]

    ordered = sorted(places.items(), key=lambda p: (p[0][0], -p[0][1]))
    return '#include "tests/mutation/fault.hpp"\n' + write(0, len(source), ordered)
