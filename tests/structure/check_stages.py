#!/usr/bin/env python3
"""Checks that the order of stages is written down once, in src/job/make.cpp.

Below each stage of a mesh stand the functions that carry it out. A file of the product that calls two of them, or that calls
one of a stage that is not its own, composes stages: commands, bindings and entry points of the library call job::make instead.

usage: check_stages.py PROJECT
"""

import pathlib
import re
import sys

COMPOSER = "src/job/make.cpp"

# What each stage is called by those above it, and the files of src/job that carry it out.
STAGES = {
    "read": (r"read_domain|clean_input", {"src/job/domain.cpp"}),
    "triangulate": (r"triangulate_domain", {"src/job/triangulated.cpp"}),
    "limits": (r"find_limits|check_forecast|check_capacity", {"src/job/limits.cpp"}),
    "cut and map": (r"prepare|job::cut|decompose_for|plan_run", {"src/job/prepare.cpp", "src/runtime/plan_run.cpp"}),
    "refine": (r"refine_domain|refine_in_one_piece|RefinementInRounds|ThreadRun|RankRun|place\.refine|simulate",
               {"src/job/one_piece.cpp", "src/job/thread_run.cpp", "src/job/rank_run.cpp"}),
}

# Where stages are called from. What lies below (mesh, decompose, runtime, ...) is what stages consist of.
CALLERS = ["src/job", "src/app", "src/api", "src/config", "src/study", "python"]


def without_comments(text):
    return re.sub(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"", " ", text, flags=re.DOTALL)


def stages_called(text):
    """By the names of their functions, where these are called or constructed."""
    code = without_comments(text)
    return {stage for stage, (names, _) in STAGES.items() if re.search(rf"(?<![\w:.])(?:job::)?(?:{names})\s*(?:\(|\s\w+\s*\(|>\()", code)}


def problems(project):
    project = pathlib.Path(project)
    found = []
    for folder in CALLERS:
        for path in sorted((project / folder).rglob("*.cpp")):
            name = path.relative_to(project).as_posix()
            called = stages_called(path.read_text())
            own = {stage for stage, (_, files) in STAGES.items() if name in files}
            if name != COMPOSER and len(called - own) > 1:
                found.append(f"{name}: calls the stages {', '.join(sorted(called - own))}; only {COMPOSER} composes stages")
    composer = project / COMPOSER
    missing = set(STAGES) - stages_called(composer.read_text()) if composer.exists() else set(STAGES)
    if missing:
        found.append(f"{COMPOSER}: does not call {', '.join(sorted(missing))}; correct the names in check_stages.py")
    return found


if __name__ == "__main__":
    all_problems = problems(sys.argv[1])
    print("\n".join(all_problems) or f"only {COMPOSER} composes stages")
    sys.exit(1 if all_problems else 0)
