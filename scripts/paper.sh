#!/usr/bin/env bash
# Makes the tables and figures of the paper (PCDM, TOMS Algorithm 872) and sets them beside the published ones (docs/paper.md):
# FOLDER/paper.html and paper.md with all tables, each as .csv, too; pictures of each run; report-*.html. Builds driftmesh unless given.
#   scripts/paper.sh [--small] [--update] [--program DRIFTMESH] [FOLDER]    (default: paper/ in the project; --small: tiny, for tests;
#                                                     --update: also writes them into docs/results/paper.md, with date, commit, machine)
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/experiments.sh"

read_options '--small --update --program' "$@"
((${#chosen[@]} == 0)) || refuse "'${chosen[0]}' is one word too many; see --help"
use_folder paper
build_program build report
find_origin

after_experiment() {
  if [[ -e $folder/$1/report.html ]]; then mv "$folder/$1/report.html" "$folder/report-$1.html"; fi
}

# of_paper NAME FILE SMALL...: SMALL are settings that make it tiny.
of_paper() {
  local name=$1 file=$2
  shift 2
  [[ $small == yes ]] || set --
  experiment "$name" "$file" "$@"
}

few=(bounds.triangles-per-rank=2e3 decomposition.subdomains=600)
# First, since it takes longest.
of_paper fig-10-modern scaled-speedup bounds.triangles-per-rank=3e3 'cluster.ranks=[1, 8, 64]'
of_paper table-1 paper/table-1 "${few[@]}"
of_paper table-2 paper/table-2 "${few[@]}"
of_paper table-3 paper/table-3 input.generate=pipe "${few[@]}"
of_paper table-3-pdr paper/table-3-pdr input.generate=pipe bounds.triangles-per-rank=5e3 cluster.ranks=16
of_paper fig-7 paper/fig-7 bounds.triangles-per-rank=2e4 decomposition.subdomains-per-rank=25 'run.aggregation=[1, 16, 512]'
of_paper fig-10 paper/fig-10 bounds.triangles-per-rank=1e3 decomposition.subdomains-per-rank=5
of_paper fig-11 paper/fig-11 "${few[@]}"
for model in pipe flow chesapeake; do
  of_paper "published-$model" "published-$model" "${few[@]}" 'balance.policy=[none, greedy]'
done
all_done

say "This machine"
if [[ $small == yes ]]; then work=(1e5 1) how=(--small); else work=(2e6 3) how=(); fi
[[ -z $origin ]] || how+=(--update "$origin")
python3 "$project_root/scripts/paper/measure.py" "$program" "$folder" "${work[@]}"
python3 "$project_root/scripts/paper/compare.py" "$folder" "${how[@]}"
say "Done: $folder/paper.html, $folder/paper.md"
