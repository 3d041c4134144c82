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

# beside LOG COMMAND...: starts the command while tests run, on cores that these leave idle: at the lowest priority, so that they do not
# wait for it. `finish LOG` waits, and shows what it said.
beside() {
  local log=$1
  shift
  mkdir -p "$(dirname "$log")"
  set -m  # in a group of its own, which can be ended as one
  (renice -n 19 "$BASHPID" >/dev/null && "$@") >"$log" 2>&1 &
  set +m
  group=$!
}
group=
trap '[[ -z $group ]] || kill -- "-$group" 2>/dev/null || true' EXIT

finish() {
  local result=0
  wait "$group" || result=$?
  group=
  cat "$1"
  return "$result"
}

# Adds what the preset's tests report; a preset that reports nothing, as when it was not built, is one failure.
test_preset() {
  local preset=$1 report=$project_root/build/$1/ctest.xml
  shift
  rm -f "$report"
  say "Testing $preset"
  # Twice as many as there are cores: half of the time tests wait, for ranks to start or for what happens by the clock.
  ctest --preset "$preset" "$@" -j "$((2 * jobs))" --timeout 300 --no-tests=error --output-junit "$report" || true
  if [[ ! -s $report ]]; then
    one "tests of preset $preset" false
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
  say "Building ci"
  one "build of preset ci" build ci
  beside build/asan-ubsan.log build asan-ubsan
  test_preset ci --label-exclude '^night$'
  say "Building asan-ubsan"
  one "build of preset asan-ubsan" finish build/asan-ubsan.log
  beside build/tidy.log scripts/tidy.sh ci
  test_preset asan-ubsan --label-exclude '^(night|long)$'
  say "clang-tidy"
  one "clang-tidy" finish build/tidy.log
else
  scripts/setup.sh build python test
  say "Building ci"
  one "build of preset ci" build ci
  test_preset ci --label-exclude '^long$'
fi

echo
untested ci | sed '/^$/d; s/^/skipped, needs /'
printf '%d passed, %d failed\n' "$passed" "$failed"
((failed == 0))
