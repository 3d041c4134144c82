#!/usr/bin/env bash
# A complete example: builds driftmesh, generates a bay with islands, meshes it coarsely, finely along its shores, and on two
# ranks, checks the meshes against the input, and plots them.
#   scripts/demo.sh [FOLDER]        (default: demo/ in the project)
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/env.sh"

case "${1:-}" in
  -h | --help)
    sed -n '2,4s/^# \{0,1\}//p' "$0"
    exit 0
    ;;
  -*)
    echo "demo.sh: unknown option '$1'; see --help" >&2
    exit 2
    ;;
esac
mkdir -p "${1:-$project_root/demo}"
folder=$(cd "${1:-$project_root/demo}" && pwd)

# Prints the command as a user would type it, then runs it.
driftmesh() {
  printf '\n$ driftmesh %s\n' "$*"
  (cd "$folder" && "$project_root/build/release/driftmesh" "$@")
}
on_two_ranks() {
  printf '\n$ mpirun -n 2 driftmesh %s\n' "$*"
  (cd "$folder" && mpirun -n 2 "$project_root/build/release/driftmesh" "$@")
}

"$project_root/scripts/setup.sh" build
say "Building driftmesh"
cd "$project_root"
cmake --preset release -Wno-dev -DDRIFTMESH_TESTS=OFF
cmake --build --preset release -j "$jobs" --target driftmesh

say "A bay: coastline, islands, a river"
driftmesh generate bay -o bay.poly

say "Coarse where the coast allows it, every angle at least 28 degrees"
driftmesh mesh bay.poly --angle 28 -o bay.vtu
driftmesh check bay.vtu bay.poly --angle 28 --quiet
driftmesh plot bay.vtu -o bay.png
driftmesh plot bay.vtu -o bay.svg
driftmesh plot bay.vtu --box 43000,17000,52000,25000 -o bay-detail.png

say "Fine along all shores: edges of 25 meters there, and longer ones in open water and toward the open sea, whose marker is 2"
shores=$(awk '!/^#/ && NF == 4 && segments { print $4 } NF == 2 && NR > 1 { segments = !segments }' "$folder/bay.poly" |
  sort -nu | grep -vx 2 | paste -sd,)
size="25 + 0.04*distance($shores)"
driftmesh mesh bay.poly --size "$size" --angle 20 -o bay-fine.vtu
driftmesh check bay-fine.vtu bay.poly --size "$size" --angle 20 --quiet
driftmesh plot bay-fine.vtu -o bay-fine.png

say "Two million triangles of at most 1,000 square meters in 60 subdomains on two ranks, which share out the work as they go"
on_two_ranks mesh bay.poly --area 1000 --angle 20 --subdomains 60 --balance stealing -o bay-parts.pvtu
driftmesh check bay-parts.pvtu bay.poly --area 1000 --angle 20 --quiet
driftmesh plot bay-parts.pvtu --color subdomain -o bay-parts.png

say "Done. Look at these:"
for file in bay.png bay-detail.png bay-fine.png bay-parts.png bay.svg; do echo "  $folder/$file"; done
echo "  $folder/bay.vtu, bay-fine.vtu and bay-parts.pvtu open in ParaView"
