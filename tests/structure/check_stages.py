#!/usr/bin/env python3
"""Checks that the order of stages is written down once, in src/job/make.cpp.

Below each stage of a mesh stand the functions that carry it out. A file of the product that calls two of them, or that calls
one of a stage that is not its own, composes stages: commands, bindings and entry points of the library call job::make instead.

Tests prove what users run, so they call job::make or the library, too (tests/support/made_mesh.hpp). Tests of a single stage make
what it starts from by the functions of boxes; those are listed, with their stage.

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
    "refine": (r"refine_in_one_piece|RefinementInRounds|ThreadRun|RankRun|place\.refine|simulate",
               {"src/job/one_piece.cpp", "src/job/thread_run.cpp", "src/job/rank_run.cpp"}),
}

# Where stages are called from. What lies below (mesh, decompose, runtime, ...) is what stages consist of.
CALLERS = ["src/job", "src/app", "src/api", "src/config", "src/study", "python"]


# What stages consist of. A test that triangulates and then refines or cuts is a second maker, unless it is one of a stage.
PARTS = {
    "triangulate": r"triangulate|prepare_corners|prepared",
    "cut and map": r"decompose|decompose_for|plan_run",
    "refine": r"Refiner|RefinementInRounds|SubdomainLoop|RankRun|refine_together",
}

# Tests and benchmarks of a stage, by what they ask of it that no request can say; those of tests/unit are all of that kind.
OF_A_STAGE = {
    "tests/fuzz/fuzz_unpack.cpp": "packed subdomains that were changed",
    "tests/mpi/api_mpi_test.cpp": "a decomposition of other segments, which is refused",
    "tests/mpi/mesh_on_ranks.cpp": "messages that arrive late, and moves at random",
    "tests/property/decompose_property_test.cpp": "cuts by themselves, and subdomains without presplit interfaces",
    "tests/property/further_cut_property_test.cpp": "cuts of subdomains by themselves, in the middle of refinement",
    "tests/property/join_property_test.cpp": "joins of subdomains by themselves",
    "tests/property/migration_property_test.cpp": "subdomains that move in the middle of a slice",
    "tests/property/threads_property_test.cpp": "threads that take subdomains at every occasion, and ranks with crews",
    "tests/sim/domains.cpp": "domains of simulated ranks",
    "tests/support/": "what tests of stages share",
    "bench/cgal_mesher.cpp": "the stages of CGAL",
    "bench/costs_bench.cpp": "what single steps cost",
    "bench/decompose_bench.cpp": "cuts by themselves",
    "bench/forecast_bench.cpp": "forecasts of subdomains, one by one",
    "bench/migration_bench.cpp": "packing against refining",
}

TESTS = ["tests", "bench"]


def without_comments(text):
    return re.sub(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"", " ", text, flags=re.DOTALL)


def calls(names, code):
    """Whether one of these functions is called, or one of these classes constructed."""
    return re.search(rf"(?<![\w:.])(?:(?:driftmesh::)?(?:job|testing)::)?(?:{names})\s*(?:\(|\s\w+\s*[({{]|>\()", code)


def stages_called(text):
    code = without_comments(text)
    return {stage for stage, (names, _) in STAGES.items() if calls(names, code)}


def problems_of_tests(project):
    """Second makers in tests, and entries of the list that are none."""
    found, excused = [], set()
    for folder in TESTS:
        for path in sorted((project / folder).rglob("*.[ch]pp")):
            name = path.relative_to(project).as_posix()
            if name.startswith("tests/unit/"):
                continue
            code = without_comments(path.read_text())
            parts = [stage for stage, names in PARTS.items() if calls(names, code)]
            if len(parts) < 2:
                continue
            excuses = {listed for listed in OF_A_STAGE if name.startswith(listed)}
            excused |= excuses
            if not excuses:
                found.append(f"{name}: composes {', '.join(parts)}; make the mesh as users do, by tests/support/made_mesh.hpp")
    return found + [f"{listed}: composes no stages; remove it from OF_A_STAGE" for listed in sorted(set(OF_A_STAGE) - excused)]


def problems(project):
    project = pathlib.Path(project)
    found = problems_of_tests(project)
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
