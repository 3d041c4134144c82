#!/usr/bin/env python3
"""The tests that docs/theory.md names as those that would notice a false step exist under these names.

usage: named_tests_test.py ROOT
"""

import pathlib
import re
import sys

NAMED = re.compile(r'([a-z_]+/[a-z_]+\.(?:cpp|py))((?:[^"]{0,3}(?:: )?"[^"]+")*)')
CASE = re.compile(r'TEST_CASE\(\s*((?:"(?:[^"\\]|\\.)*"\s*)+)')


def cases_of(source):
    """The names of the test cases in a file; C++ joins literals that follow each other."""
    return {"".join(re.findall(r'"((?:[^"\\]|\\.)*)"', literals)) for literals in CASE.findall(source)}


def main():
    root = pathlib.Path(sys.argv[1])
    text = " ".join((root / "docs" / "theory.md").read_text().split())
    named, missing = 0, []
    for file, quoted in NAMED.findall(text):
        path = root / "tests" / file
        if not path.exists():
            missing.append(file)
            continue
        cases = cases_of(path.read_text())
        for case in re.findall(r'"([^"]+)"', quoted):
            named += 1
            if case not in cases:
                missing.append(f'{file}: "{case}"')
    if missing:
        sys.exit("docs/theory.md names tests that do not exist:\n" + "\n".join(missing))
    quoted = text.count('"') // 2
    if named < 40:
        sys.exit(f"only {named} names of tests were found in docs/theory.md, of {quoted} quotations: has its form changed?")
    print(f"{named} tests exist as docs/theory.md names them ({quoted} quotations)")


if __name__ == "__main__":
    main()
