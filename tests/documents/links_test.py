#!/usr/bin/env python3
"""Every link between documents leads somewhere: to a file that exists, and to a heading in it if it names one.

usage: links_test.py PROJECT_FOLDER
"""

import pathlib
import re
import sys

LINK = re.compile(r"\[[^]]*\]\(([^)\s]+)\)")


def without_code(text):
    text = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"^ {4}.*$", "", text, flags=re.MULTILINE)
    return re.sub(r"`[^`\n]*`", "", text)


def anchors(page):
    """Of all headings, as sites for repositories and mkdocs make them."""
    found = {}
    for heading in re.findall(r"^#+ +(.*)$", re.sub(r"^```.*?^```", "", page.read_text(), flags=re.M | re.S), re.MULTILINE):
        name = re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")
        found[name] = found.get(name, 0) + 1
    return {name if i == 0 else f"{name}-{i}" for name, count in found.items() for i in range(count)}


def faults_of(page, root):
    for target in LINK.findall(without_code(page.read_text())):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        if not file.exists():
            yield f"{page.relative_to(root)}: {target}: no such file"
        elif anchor and anchor not in anchors(file):
            yield f"{page.relative_to(root)}: {target}: no such heading"


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    pages = [*root.glob("*.md"), *(root / "docs").rglob("*.md")]
    links = sum(len(LINK.findall(without_code(page.read_text()))) for page in pages)
    faults = [fault for page in pages for fault in faults_of(page, root)]
    listed = (root / "mkdocs.yml").read_text()
    faults += [f"mkdocs.yml does not list {page.relative_to(root)}" for page in pages
               if page.name != "CONTRIBUTING.md" and f" {page.relative_to(root)}\n" not in listed]
    print("\n".join(faults))
    print(f"{len(pages)} pages, {links} links, {len(faults)} faults")
    return 1 if faults or links < 50 else 0


if __name__ == "__main__":
    sys.exit(main())
