#!/usr/bin/env bash
# Looks for mistakes in the sources of the program and its library with clang-tidy, by the checks in .clang-tidy.
#   scripts/tidy.sh [PRESET]        (default: ci)   the preset of a build folder that has been configured
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$project_root"

preset=${1:-ci}
case "$preset" in
  -h | --help)
    sed -n '2,3s/^# \{0,1\}//p' "$0"
    exit 0
    ;;
  -*)
    echo "tidy.sh: unknown option '$preset'; see --help" >&2
    exit 2
    ;;
esac
database=build/$preset/compile_commands.json
if [[ ! -s $database ]]; then
  echo "tidy.sh: there is no $database; run cmake --preset $preset first" >&2
  exit 2
fi

# What the boxes are compiled from: sources that are compiled together are read together, in a third of the time.
sources() {
  python3 -c '
import json, re, sys
for entry in json.load(open(sys.argv[1])):
    if re.search(r"-o \S*CMakeFiles/(dm_|driftmesh\.dir)", entry["command"]): print(entry["file"])' "$database"
}

result=0
found=$(sources | xargs -d '\n' -P "$jobs" -n 1 clang-tidy -p "build/$preset" --quiet \
  --extra-arg=-Wno-unknown-warning-option 2>&1) || result=1
grep -v '^[0-9]* warnings\? generated\|^Suppressed\|^Use -header-filter' <<<"$found" || true
exit "$result"
