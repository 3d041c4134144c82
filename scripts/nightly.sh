#!/usr/bin/env bash
# The tests of threads under the thread sanitizer, the property tests with new seeds, whether the tests notice mutated sources, the tests that scripts/test.sh does not run
# under the other sanitizers, a build with nothing but the standard library, the wheel in roots of its own, 100,000 mutated files and 20,000 mutated meshes, read and checked under them by driftmesh-mutants, and
# a million adversarial schedules of real meshing with driftmesh-sim, and 100,000 in which ranks are killed and resumed, on all
# cores: prints the failing seeds, and totals. The exit code is 0 if none fails.
#   scripts/nightly.sh [--mutants FIRST..LAST] [--meshes FIRST..LAST]      which mutated files and meshes; 0..0: none
#                      [--seeds FIRST..LAST]                              which schedules
#                      [--faults FIRST..LAST]                             which schedules with faults
#                      [--properties N]                                   so many runs of the property tests (20; 0: none)
#                      [--no-threads]                                     without the thread sanitizer
#                      [--no-night]                                       without the tests with the label `night`
#                      [--no-alone]                                       without compiling every header and source alone
#                      [--no-wheel]                                       without building packages and wheel, and trying them, which take root's rights
#                      [--no-mutation]                                    without asking which mutated sources the tests miss
#                      [--mutants-program PATH] [--program PATH]          without a build first
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$project_root"

seeds=1..1000000
faults=1..100000
mutants=1..100000
meshes=1..20000
program=
mutants_program=
threads=yes
night=yes
alone=yes
wheel=yes
mutation=yes
properties=20
while [[ $# -gt 0 ]]; do
  case "$1" in
    --seeds | --faults | --mutants | --meshes)
      [[ ${2-} =~ ^([0-9]+)\.\.([0-9]+)$ ]] || { echo "nightly.sh: $1 must be FIRST..LAST, such as 1..5000" >&2; exit 2; }
      declare "${1#--}=$2"
      shift
      ;;
    --properties)
      [[ ${2-} =~ ^[0-9]+$ ]] || { echo "nightly.sh: --properties must be a number of runs" >&2; exit 2; }
      properties=$2
      shift
      ;;
    --no-threads) threads=no ;;
    --no-night) night=no ;;
    --no-alone) alone=no ;;
    --no-wheel) wheel=no ;;
    --no-mutation) mutation=no ;;
    --program)
      program=${2-}
      shift
      ;;
    --mutants-program)
      mutants_program=${2-}
      shift
      ;;
    -h | --help)
      sed -n '2,16s/^# \{0,1\}//p' "$0"
      exit 0
      ;;
    *)
      echo "nightly.sh: unknown option '$1'; see --help" >&2
      exit 2
      ;;
  esac
  shift
done

result=0
if [[ $threads == yes ]]; then
  cmake --preset tsan -Wno-dev && cmake --build --preset tsan -j "$jobs"
  say "Threads under the thread sanitizer"
  # Without random addresses, which some kernels spread beyond what the sanitizer expects.
  DRIFTMESH_CASES=300 setarch -R ctest --preset tsan --no-tests=error || result=1
fi
if [[ $properties -gt 0 ]]; then
  cmake --preset release -Wno-dev && cmake --build --preset release -j "$jobs"
  say "Property tests with new seeds, $properties runs of each"
  DRIFTMESH_SEED=random ctest --preset release -L property --no-tests=error -j "$jobs" --repeat "until-fail:$properties" || result=1
fi
if [[ $alone == yes ]]; then
  cmake --preset release -Wno-dev
  say "Every header and source alone"
  tests/structure/check_alone.py --sources . build/release || result=1
fi
if [[ $night == yes ]]; then
  cmake --preset asan-ubsan -DDRIFTMESH_SANITIZE_SCOPES=ON -Wno-dev && cmake --build --preset asan-ubsan -j "$jobs"
  say "Tests of the night, and the long ones, under the address and undefined-behavior sanitizers"
  ctest --preset asan-ubsan -L '^(night|long)$' --no-tests=error -j "$jobs" --timeout 600 || result=1
fi
if [[ $wheel == yes ]]; then
  say "A build with nothing but the standard library"
  { cmake --preset ci -Wno-dev && ctest --preset ci -L '^night$' --no-tests=error; } || result=1
  say "The wheel"
  rm -rf build/wheels
  { scripts/setup.sh wheel && packaging/wheel/build.sh --to build/wheels && packaging/wheel/try.sh build/wheels/driftmesh-*.whl; } || result=1
fi
if [[ $mutation == yes ]]; then
  say "Mutated sources"
  tests/mutation/mutation.py -j "$jobs" || result=1
fi
if [[ $mutants != 0..0 || $meshes != 0..0 ]]; then
  if [[ -z $mutants_program ]]; then
    cmake --preset asan-ubsan -Wno-dev && cmake --build --preset asan-ubsan -j "$jobs" --target driftmesh-mutants
    mutants_program=build/asan-ubsan/driftmesh-mutants
  fi
fi
if [[ $mutants != 0..0 ]]; then
  say "Mutated files $mutants on $jobs cores"
  "$mutants_program" --seeds "$mutants" --keep build/mutants || result=1
fi
if [[ $meshes != 0..0 ]]; then
  say "Mutated meshes $meshes on $jobs cores"
  "$mutants_program" --meshes --seeds "$meshes" --keep build/mutated-meshes || result=1
fi
[[ $seeds != 0..0 || $faults != 0..0 ]] || exit "$result"

if [[ -z $program ]]; then
  cmake --preset release -Wno-dev && cmake --build --preset release -j "$jobs" --target driftmesh-sim
  program=build/release/driftmesh-sim
fi
logs=$(mktemp -d)
trap 'rm -rf "$logs"' EXIT

# schedules FIRST..LAST PART [OPTION]: in parts small enough for all cores to finish together; each ends with its totals.
schedules() {
  local first=${1%..*} last=${1#*..} part=$2 begin end
  [[ $last -gt 0 ]] || return 0
  say "Seeds $first to $last${3:+ with $3} on $jobs cores"
  rm -f "$logs"/*
  for ((begin = first; begin <= last; begin += part)); do
    end=$((begin + part - 1))
    echo "$begin..$((end < last ? end : last))"
  done | xargs -P "$jobs" -I{} sh -c '"$0" --seeds {} $2 >"$1/{}"' "$program" "$logs" "${3-}" || result=1
  cat "$logs"/* | grep -A1 '^seed [0-9]' || true

  # Each total is a number and what it counts.
  say "What was done"
  awk -F '[,;] ' '
    /^seeds / { split($0, words, " "); schedules += words[4] - words[2] + 1; failed += words[5]; next }
    /^ *FAILED|^seed [0-9]/ { next }
    { for (i = 1; i <= NF; ++i) {
        number = $i + 0; what = $i; sub(/^[0-9.]+ /, "", what); if (what == "s") what = "seconds of cores"
        if (!(what in sum)) order[++kinds] = what
        if (what ~ /at most$/) { if (number > sum[what]) sum[what] = number } else sum[what] += number } }
    END { for (i = 1; i <= kinds; ++i) printf "%15d %s\n", sum[order[i]], order[i]
          printf "%d schedules, %d failed\n", schedules, failed }' "$logs"/*
}
schedules "$seeds" 2000
schedules "$faults" 500 --faults
exit "$result"
