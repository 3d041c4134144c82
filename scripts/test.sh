#!/usr/bin/env bash
# Builds with warnings as errors and runs the functional tests. The last line is "N passed, N failed"; the exit code is 0 if none
# failed. What is not tested for want of a program is named above it.
#   scripts/test.sh [--all]        --all: the long tests, too (installation, documents, other programs, models, browser),
#                                  then those without it under the address and undefined-behavior sanitizers, and clang-tidy
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$project_root"

all=no
for argument in "$@"; do
  case "$argument" in
    --all) all=yes ;;
    -h | --help)
      sed -n '2,5s/^# \{0,1\}//p' "$0"
      exit 0
      ;;
    *)
      echo "test.sh: unknown option '$argument'; see --help" >&2
      exit 2
      ;;
  esac
done

passed=0
failed=0

# one NAME COMMAND...: runs a check that counts as one test.
one() {
  local name=$1
  shift
  if "$@"; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAILED: $name"
  fi
}

build() { cmake --preset "$1" -Wno-dev && cmake --build --preset "$1" -j "$jobs"; }

# The value of an attribute of the test suite in ctest's report.
reported() { grep -om1 "[[:space:]]$1=\"[0-9]*\"" "$2" | tr -dc '0-9'; }

# Builds the preset and adds what its tests report; a preset that does not build, or reports nothing, is one failure.
run_preset() {
  local preset=$1 report=$project_root/build/$1/ctest.xml
  shift
  say "Building $preset"
  rm -f "$report"
  if build "$preset"; then
    say "Testing $preset"
    # Twice as many as there are cores: half of the time tests wait, for ranks to start or for what happens by the clock.
    ctest --preset "$preset" "$@" -j "$((2 * jobs))" --timeout 300 --no-tests=error --output-junit "$report" || true
  fi
  if [[ ! -s $report ]]; then
    one "preset $preset" false
    return
  fi
  local total bad skipped
  total=$(reported tests "$report")
  bad=$(reported failures "$report")
  skipped=$(($(reported skipped "$report") + $(reported disabled "$report")))
  passed=$((passed + total - bad - skipped))
  failed=$((failed + bad))
}

# What the build left out, and tests that skipped all or some of their cases, as "NEED: test".
untested() {
  cat "build/$1/untested.txt"
  python3 - "build/$1/ctest.xml" <<'PYTHON'
import re, sys, xml.etree.ElementTree as tree
for case in tree.parse(sys.argv[1]).iter("testcase"):
    cases = re.findall(r"skipped=(\d+)", case.findtext("system-out", ""))
    if case.get("status") == "notrun":
        print(f"its programs: {case.get('name')}")
    elif cases:
        print(f"their programs: {cases[0]} cases of {case.get('name')}")
PYTHON
}

if [[ $all == yes ]]; then
  scripts/setup.sh build gis report python test all readers hosts site
  one "clang-format-14, without which the formatting is not tested" command -v clang-format-14
  run_preset ci
  run_preset asan-ubsan --label-exclude '^(night|long)$'
  say "clang-tidy"
  one "clang-tidy" scripts/tidy.sh ci
else
  scripts/setup.sh build python test
  run_preset ci --label-exclude '^long$'
fi

echo
untested ci | sed '/^$/d; s/^/skipped, needs /'
printf '%d passed, %d failed\n' "$passed" "$failed"
((failed == 0))
