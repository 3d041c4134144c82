#!/usr/bin/env bash
# Makes the pictures of reports in docs/images anew, in a browser without a window: three minutes on two idle cores.
#   scripts/pictures.sh [PRESET]        PRESET: a build with the page of reports (default: release)
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/env.sh"

case "${1:-}" in
  -h | --help)
    sed -n '2,3s/^# \{0,1\}//p' "$0"
    exit 0
    ;;
  -*)
    echo "pictures.sh: unknown option '$1'; see --help" >&2
    exit 2
    ;;
esac
build=$project_root/build/${1:-release}
images=$project_root/docs/images
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
ln -s "$project_root/configs" configs
PATH=$build:$PATH
shoot() { node "$project_root/report/shoot.mjs" "$browser" "$@" --packages "$build/src/report/npm"; }
pick() { echo "!document.querySelector('#runs tbody tr:nth-child($1)').click()"; }
color() { echo "!{ const c = document.getElementById('color-by'); c.value = '$1'; c.dispatchEvent(new Event('change')); }"; }
at_the_end="!document.querySelectorAll('.one-run input[type=range]').forEach((s) => { s.value = 1; s.dispatchEvent(new Event('input')); })"

say "A study with its mesh"
size='x < 0.45 && y < 0.45 ? 0.0022 : 0.018'
driftmesh run configs/corner-refinement.yaml --quiet --set "sizing.size=$size" --set cluster.speed=4e5 \
  --set 'balance.policy=[none, diffusion, stealing]' -o study
driftmesh generate rectangle-hole -o domain.poly
driftmesh mesh domain.poly --quiet --size "$size" --subdomains 320 -o mesh.vtu
driftmesh report study --mesh mesh.vtu -o study.html
shoot study.html "$images" "$(pick 3)" "$(color 'rank over time')" report= \
  "$(color area)" '!{ const m = document.getElementById("mesh"); m.focus();
    for (let k = 0; k < 4; ++k) m.dispatchEvent(new KeyboardEvent("keydown", { key: "+" }));
    for (let k = 0; k < 25; ++k) m.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft" }));
    for (let k = 0; k < 2; ++k) m.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowDown" })); }' \
  report-mesh=section:has\(#mesh\)

say "Two real ranks, of which one works half of the time"
mpirun -n 2 driftmesh run configs/corner-refinement.yaml --quiet --set cluster.kind=real --set cluster.ranks=2 \
  --set 'cluster.drag=[1,0.5]' --set 'sizing.size=x < 0.45 && y < 0.45 ? 0.00025 : 0.0022' \
  --set decomposition.subdomains-per-rank=300 --set balance.policy=stealing -o two
shoot two/report.html "$images" "$at_the_end" corner-moves=.timeline corner-load=.load corner-owners=.map

say "144 ranks of three speeds"
driftmesh run configs/sciclone-144.yaml --quiet --set input.generate=pipe --set balance.policy=none -o sciclone
shoot sciclone/report.html "$images" sciclone-144-time=.rank-times

say "Water on two ranks"
mpirun -n 2 "$build/examples/dam_break/dam_break" 0.2 6 dam.pvd
driftmesh report dam.pvd --field depth -o dam.html
shoot dam.html "$images" '!{ const s = document.getElementById("series-time"); s.value = 35; s.dispatchEvent(new Event("input")); }' \
  following-page=section:has\(#series\)
