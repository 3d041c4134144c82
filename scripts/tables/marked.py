"""Tables in documents, and in the comments of YAML files, below a line that says which they are and what makes them:

    <!-- table: NAME, by scripts/NAME.sh -->        # table: NAME, by scripts/NAME.sh
                                                    # | column | ...
    | column | ...
"""

import re

MARK = re.compile(r"(# |)(?:<!-- )?table: ([\w-]+), by ([\w/.]+)(?: -->)?")


def mark_of(name, script):
    """The line of a document above a table."""
    return f"<!-- table: {name}, by {script} -->"


def marks_of(text):
    """The marks in a text: name of the table, and path of the script."""
    return [(mark[2], mark[3]) for line in text.splitlines() if (mark := MARK.fullmatch(line))]


def lines_below(text, script):
    """{name: the lines of the table below its mark, without what makes them comments}, of the tables that the script makes."""
    found, lines = {}, text.splitlines()
    for at, line in enumerate(lines):
        if (mark := MARK.fullmatch(line)) and mark[3] == script:
            begin, end = _extent(lines, at, mark[1])
            found[mark[2]] = [row[len(mark[1]):] for row in lines[begin:end]]
    return found


def with_tables(text, tables):
    """The text with the lines of each of `tables` ({name: lines}) below its mark, in place of those that were there."""
    lines, at = text.splitlines(), 0
    while at < len(lines):
        mark = MARK.fullmatch(lines[at])
        at += 1
        if mark and mark[2] in tables:
            _, end = _extent(lines, at - 1, mark[1])
            blank = [] if mark[1] else [""]
            after = blank if end < len(lines) and lines[end] else []
            lines[at:end] = [*blank, *(mark[1] + row for row in tables[mark[2]]), *after]
    return "\n".join(lines) + "\n"


def _extent(lines, mark, prefix):
    """Where the table below a mark begins and ends; it may be missing."""
    begin = mark + 1
    if not prefix and begin < len(lines) and not lines[begin]:
        begin += 1
    end = begin
    while end < len(lines) and lines[end].startswith(f"{prefix}|"):
        end += 1
    return begin, end
