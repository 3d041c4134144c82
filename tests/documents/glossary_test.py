#!/usr/bin/env python3
"""docs/glossary.md is in alphabetical order, and the files that it names contain what it says that they define.

usage: glossary_test.py PROJECT_FOLDER
"""

import pathlib
import re
import sys


def faults_of(page, root):
    """What is wrong, one line each, and how many terms there are."""
    faults, terms, last = [], 0, ""
    terms_page, _, words_page = page.partition("\n## ")
    for term, where in re.findall(r"^\| ([^|]+) \| [^|]+ \| (`[^|]+`) \|$", terms_page, re.MULTILINE):
        terms += 1
        name = re.sub(r"[^a-z ]", " ", term.lower())
        if name <= last:
            faults.append(f"{term}: comes after {last}")
        last = name
        file, _, defined = where.replace("`", "").partition(": ")
        faults += missing(root, file, defined, re.compile(rf"\b{re.escape(defined)}\b"))
    for word, files in re.findall(r"^\| (\w+) \| [^|]+ \| (`[^|]+`) \|$", words_page, re.MULTILINE):
        terms += 1
        for file in re.findall(r"`([^`]+)`", files):
            faults += missing(root, file, word, re.compile(word, re.IGNORECASE))
    return faults, terms


def missing(root, file, name, pattern):
    if not (root / file).is_file():
        return [f"{name}: there is no {file}"]
    return [] if pattern.search((root / file).read_text()) else [f"{file} has no {name}"]


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    page = (root / "docs/glossary.md").read_text()
    faults, terms = faults_of(page, root)
    # It would find mistakes:
    broken = page.replace("| advice |", "| zeal |").replace("`Cavity`", "`Cavern`").replace("src/mesh/cdt.hpp", "src/mesh/dct.hpp")
    found = len(faults_of(broken, root)[0])
    print("\n".join(faults) or f"{terms} terms without faults; of 3 mistakes {found} are found")
    return 0 if not faults and terms > 100 and found >= 3 else 1


if __name__ == "__main__":
    sys.exit(main())
