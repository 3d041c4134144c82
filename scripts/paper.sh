#!/usr/bin/env bash
# Makes the tables and figures of the paper (PCDM, TOMS Algorithm 872) and sets them beside the published ones (docs/paper.md):
# FOLDER/paper.html and paper.md with all tables, each as .csv, too; pictures of each run; report-*.html. Builds driftmesh unless given.
#   scripts/paper.sh [--small] [--program DRIFTMESH] [FOLDER]    (default: paper/ in the project; --small: tiny, for tests)
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/env.sh"

small=no program='' folder=''
while (($#)); do
  case "$1" in
    -h | --help)
      sed -n '2,4s/^# \{0,1\}//p' "$0"
      exit 0
      ;;
    --small) small=yes ;;
    --program)
      (($# > 1)) || { echo "paper.sh: --program needs a file" >&2; exit 2; }
      program=$(realpath "$2")
      shift
      ;;
    -*)
      echo "paper.sh: unknown option '$1'; see --help" >&2
      exit 2
      ;;
    *) folder=$1 ;;
  esac
  shift
done
mkdir -p "${folder:=$project_root/paper}"
folder=$(cd "$folder" && pwd)
configs=$project_root/configs

if [[ -z $program ]]; then
  "$project_root/scripts/setup.sh" build report
  say "Building driftmesh"
  cd "$project_root"
  cmake --preset release -Wno-dev -DDRIFTMESH_TESTS=OFF
  cmake --build --preset release -j "$jobs" --target driftmesh
  program=$project_root/build/release/driftmesh
fi

# experiment NAME FILE SMALL...: runs it into FOLDER/NAME; SMALL are settings that make it tiny.
run_experiment() {
  local name=$1 file=$2 settings=()
  shift 2
  if [[ $small == yes ]]; then
    for setting in "$@"; do settings+=(--set "$setting"); done
  fi
  rm -rf "${folder:?}/$name"
  "$program" run "$configs/$file.yaml" -o "$folder/$name" --quiet "${settings[@]}"
  if [[ -e $folder/$name/report.html ]]; then mv "$folder/$name/report.html" "$folder/report-$name.html"; fi
  say "$name: done in $SECONDS s"
}

# Simulated time does not depend on what else runs here: two experiments at a time, as many as there is memory for.
running=0
experiment() {
  ((running < (jobs < 2 ? 1 : 2))) || one_more_done
  run_experiment "$@" &
  ((++running))
}
one_more_done() {
  wait -n
  ((running--)) || true
}
trap 'kill $(jobs -p) 2>/dev/null || true' EXIT

few=(bounds.triangles-per-rank=2e3 decomposition.subdomains=600)
# First, since it takes longest.
experiment fig-10-modern scaled-speedup bounds.triangles-per-rank=3e3 'cluster.ranks=[1, 8, 64]'
experiment table-1 paper/table-1 "${few[@]}"
experiment table-2 paper/table-2 "${few[@]}"
experiment table-3 paper/table-3 input.generate=pipe "${few[@]}"
experiment table-3-pdr paper/table-3-pdr input.generate=pipe bounds.triangles-per-rank=5e3 cluster.ranks=16
experiment fig-7 paper/fig-7 bounds.triangles-per-rank=2e4 decomposition.subdomains-per-rank=25 'run.aggregation=[1, 16, 512]'
experiment fig-10 paper/fig-10 bounds.triangles-per-rank=1e3 decomposition.subdomains-per-rank=5
experiment fig-11 paper/fig-11 "${few[@]}"
for model in pipe flow chesapeake; do
  experiment "published-$model" "published-$model" "${few[@]}" 'balance.policy=[none, greedy]'
done

while ((running > 0)); do one_more_done; done

say "This machine"
if [[ $small == yes ]]; then work=(1e5 1) caution=(small); else work=(2e6 3) caution=(); fi
python3 "$project_root/scripts/paper/measure.py" "$program" "$folder" "${work[@]}"
python3 "$project_root/scripts/paper/compare.py" "$folder" "${caution[@]}"
say "Done: $folder/paper.html, $folder/paper.md"
