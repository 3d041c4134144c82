#!/usr/bin/env bash
# Makes the tables of what balancing recovers (docs/results/balancing.md) from the experiments in configs: FOLDER/TABLE.md and .csv,
# and FOLDER/balancing.md with all. Builds driftmesh unless given.
#   scripts/balancing.sh [--small] [--update] [--program DRIFTMESH] [--inputs DATA] [FOLDER [TABLE...]]
# FOLDER: balancing/ in the project by default. TABLE: all by default. --small: tiny, for tests. --update: also writes the tables into
# docs/results/balancing.md, with date, commit and machine, and into documents and comments of configs below the lines that name them.
# --inputs: a folder with chesapeake.poly, which is not shipped; without it there is no table `chesapeake`.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/experiments.sh"

read_options '--small --update --program --inputs' "$@"
tables() { python3 "$project_root/scripts/balancing/command.py" "$@"; }
small_option=() inputs_option=()
[[ $small == no ]] || small_option=(--small)
[[ -z $inputs ]] || inputs_option=(--inputs "$inputs")
experiments=$(tables experiments "${small_option[@]}" "${inputs_option[@]}" "${chosen[@]}") || exit 2
use_folder balancing
build_program build
find_origin

while IFS=$'\t' read -ra words; do experiment "${words[@]}"; done <<<"$experiments"
all_done

tables write "${small_option[@]}" "$folder" "${chosen[@]}"
[[ $update == no ]] || tables update "$folder" "$project_root" "$origin" "${chosen[@]}"
say "Done: $folder/balancing.md"
