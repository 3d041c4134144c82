#!/usr/bin/env python3
"""The container and the workflows call what exists: scripts, groups of packages, presets and options of the build.

usage: recipes_test.py PROJECT_FOLDER

Nothing is built here: what they do, other tests do step by step (install, packages, and scripts/test.sh itself).
"""

import json
import pathlib
import re
import subprocess
import sys

RECIPES = ("Containerfile", ".github/workflows/tests.yml", ".github/workflows/wheels.yml", "examples/workflow.yml", "packaging/conda/recipe.yaml",
           "packaging/debian/rules", "packaging/spack/package.py", "packaging/wheel/build.sh", "packaging/wheel/try.sh")


def faults_of(name, text, root):
    presets = {preset["name"] for preset in json.loads((root / "CMakePresets.json").read_text())["configurePresets"]}
    options = set(re.findall(r"(?:option|set)\((DRIFTMESH_\w+)", "".join(path.read_text() for path in
                                                                  [root / "CMakeLists.txt", root / "python/CMakeLists.txt", *(root / "cmake").glob("*.cmake")])))
    for script in re.findall(r"(?:\./|\b)((?:scripts|packaging/\w+)/[\w.-]+\.(?:sh|py))", text):
        if not (root / script).is_file():
            yield f"{name}: {script} does not exist"
    for groups in re.findall(r"setup\.sh((?: [a-z]+)*)", text):
        for group in groups.split():
            # It lists its groups where it does not know one.
            known = subprocess.run([root / "scripts" / "setup.sh", "?"], capture_output=True, text=True, check=False).stderr
            if not re.search(rf"\b{group}\b", known.split("use ")[-1]):
                yield f"{name}: setup.sh has no group {group}"
    for preset in re.findall(r"--preset (\w+)", text):
        if preset not in presets:
            yield f"{name}: there is no preset {preset}"
    for option in re.findall(r"(?:-D|define\(\"|define_from_variant\(\"|[;=\"])(DRIFTMESH_[A-Z_0-9]+)(?:=|\")", text):
        if option not in options:
            yield f"{name}: there is no option {option}"


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    texts = {name: (root / name).read_text() for name in RECIPES}
    faults = [fault for name, text in texts.items() for fault in faults_of(name, text, root)]
    # It would find mistakes:
    broken = texts["Containerfile"].replace("setup.sh build", "setup.sh bulid").replace("--preset release", "--preset relase") \
        .replace("DRIFTMESH_TESTS", "DRIFTMESH_TEST").replace("./scripts/setup.sh", "./scripts/set-up.sh && ./scripts/setup.sh")
    found = len(set(faults_of("broken", broken, root)))
    print("\n".join(faults) or f"{len(texts)} recipes without faults; of 4 mistakes {found} are found")
    return 0 if not faults and found == 4 else 1


if __name__ == "__main__":
    sys.exit(main())
