#!/usr/bin/env bash
# Installs a wheel in a root of Debian with nothing but Python and numpy, and lets it mesh, check, draw and write there.
#   packaging/wheel/try.sh WHEEL [--root FOLDER] [--release NAME]
#     --root     made by debootstrap if it is not there (default: build/wheel-bare); takes root's rights
#     --release  of Debian (default: bookworm)
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../../scripts/env.sh"
cd "$project_root"

wheel=${1:?name a wheel}
shift
root=build/wheel-bare
release=bookworm
while (($#)); do
  case "$1" in
    --root) root=$2 ;;
    --release) release=$2 ;;
    *)
      sed -n '2,5s/^# \{0,1\}//p' "$0"
      exit 2
      ;;
  esac
  shift 2
done

if [[ ! -d $root/etc ]]; then
  say "Making $root of $release"
  debootstrap --variant=minbase --include=ca-certificates,python3,python3-numpy,python3-pip "$release" "$root"
fi
for command in cmake c++ mpirun; do
  if chroot "$root" sh -c "command -v $command" >/dev/null; then
    echo "try.sh: $root has $command, so it proves nothing" >&2
    exit 1
  fi
done
rm -rf "$root/try"
mkdir -p "$root/try/work"
cp "$wheel" packaging/wheel/try.py "$root/try/"
chroot "$root" python3 -m pip install -q --root-user-action ignore --no-index --no-deps --target /try/site "/try/$(basename "$wheel")"
chroot "$root" env PYTHONPATH=/try/site sh -c 'cd /try/work && python3 ../try.py'
