#!/usr/bin/env bash
# Checks the sources of the program and its library with clang-tidy, as configured in .clang-tidy.
#   scripts/tidy.sh [PRESET]        (default: ci)   the preset of a configured build folder
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

# The sources of the boxes: those that are compiled together are checked together, in a third of the time. The most of them
# come first, so that none is left to a single core at the end.
sources() {
  python3 -c '
import json, re, sys
found = [entry["file"] for entry in json.load(open(sys.argv[1]))
         if re.search(r"-o \S*CMakeFiles/(dm_|driftmesh\.dir)", entry["command"]) and not entry["file"].endswith(".S")]
print(*sorted(found, key=lambda file: -open(file).read().count("\n#include")), sep="\n")' "$database"
}

result=0
found=$(sources | xargs -d '\n' -P "$jobs" -n 1 clang-tidy -p "build/$preset" --quiet \
  --extra-arg=-Wno-unknown-warning-option 2>&1) || result=1
grep -v '^[0-9]* warnings\? generated\|^Suppressed\|^Use -header-filter' <<<"$found" || true
exit "$result"
