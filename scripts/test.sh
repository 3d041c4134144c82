#!/usr/bin/env bash
# Builds and runs every test: optimized with warnings as errors, then under the address and undefined-behavior
# sanitizers, then clang-tidy. The last line is "N passed, N failed"; the exit code is 0 if none failed.
#   scripts/test.sh [--quick]        --quick skips the sanitizers
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$project_root"

quick=no
for argument in "$@"; do
  case "$argument" in
    --quick) quick=yes ;;
    -h | --help)
      sed -n '2,4s/^# \{0,1\}//p' "$0"
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
  say "Building $preset"
  rm -f "$report"
  if build "$preset"; then
    say "Testing $preset"
    # One more than there are cores: some tests wait for what happens by the clock.
    ctest --preset "$preset" -j "$((jobs + 1))" --timeout 300 --no-tests=error --output-junit "$report" || true
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

scripts/setup.sh build gis report python test readers hosts site
one "clang-format-14, without which the formatting is not tested" command -v clang-format-14
run_preset ci
[[ $quick == yes ]] || run_preset asan-ubsan
say "clang-tidy"
one "clang-tidy" scripts/tidy.sh ci

printf '\n%d passed, %d failed\n' "$passed" "$failed"
((failed == 0))
