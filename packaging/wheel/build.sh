#!/usr/bin/env bash
# Builds the wheel for Linux in a root of Debian of its own, so that it needs no newer C library than that release has.
#   packaging/wheel/build.sh [--root FOLDER] [--release NAME] [--to FOLDER]
#     --root     the root, made by debootstrap if it is not there (default: build/wheel-root); takes root's rights
#     --release  of Debian (default: bookworm, the oldest whose compiler knows C++20 well enough)
#     --to       where the wheel is put (default: build)
# JOBS=N compiles with N processes (default: as many as there are cores); DEFINE="NAME=VALUE;..." are more options of CMake.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../../scripts/env.sh"
cd "$project_root"

root=build/wheel-root
release=bookworm
to=build
while (($#)); do
  case "$1" in
    --root) root=$2 ;;
    --release) release=$2 ;;
    --to) to=$2 ;;
    *)
      sed -n '2,7s/^# \{0,1\}//p' "$0"
      [[ $1 == -h || $1 == --help ]]
      exit
      ;;
  esac
  shift 2
done
export JOBS=${JOBS:-$jobs}

if [[ ! -d $root/etc ]]; then
  say "Making $root of $release"
  debootstrap --variant=minbase --include=ca-certificates "$release" "$root"
  sed -i 's/^deb \(.*\)/deb \1\ndeb-src \1/' "$root/etc/apt/sources.list"
  cp /etc/apt/apt.conf.d/*proxy* "$root/etc/apt/apt.conf.d/" 2>/dev/null || true
fi
root=$(realpath "$root")
inside() { chroot "$root" env DEBIAN_FRONTEND=noninteractive JOBS="$JOBS" LC_ALL=C.UTF-8 "$@"; }

say "Installing what it takes"
inside apt-get update -q
inside apt-get install -y -q --no-install-recommends g++ cmake ninja-build make pkg-config dpkg-dev pybind11-dev python3-dev python3-numpy python3-pip nlohmann-json3-dev

say "Building the libraries that it carries"
mkdir -p "$root/driftmesh-wheel"
cp packaging/wheel/libraries.sh "$root/driftmesh-wheel/"
[[ -e $root/driftmesh-wheel/libraries/done ]] || inside /driftmesh-wheel/libraries.sh /driftmesh-wheel/libraries
touch "$root/driftmesh-wheel/libraries/done"

# C libraries since 2.34 will do, as the releases 9 of Red Hat and its kin have: of hypot() the older version is taken, which does the same,
# and libgcc is that of the system, since ours asks for a newer one.
older=
if [[ $(uname -m) == x86_64 ]]; then
  inside gcc -O2 -fPIC -x c -c - -o /driftmesh-wheel/hypot.o <<'C'
double older_hypot(double x, double y);
__asm__(".symver older_hypot,hypot@GLIBC_2.2.5");
double __wrap_hypot(double x, double y) { return older_hypot(x, y); }
C
  older=" -Wl,--wrap=hypot /driftmesh-wheel/hypot.o"
fi

say "Building the wheel"
rm -rf "$root/driftmesh-wheel/"{source,sdist,wheels}
mkdir -p "$root/driftmesh-wheel/sdist" "$to"
python3 -c 'import sys; sys.path.insert(0, "python/backend"); import driftmesh_backend; driftmesh_backend.build_sdist(sys.argv[1])' \
  "$root/driftmesh-wheel/sdist"
define="CMAKE_PREFIX_PATH=/driftmesh-wheel/libraries;PKG_CONFIG_ARGN=--static;DRIFTMESH_GDAL=OFF;DRIFTMESH_CAIRO=ON;DRIFTMESH_HDF5=ON"
define+=";DRIFTMESH_JSON=ON;DRIFTMESH_METIS=ON;DRIFTMESH_ZLIB=ON"
define+=";CMAKE_MODULE_LINKER_FLAGS=-static-libstdc++ -Wl,--gc-sections$older${DEFINE:+;$DEFINE}"
inside env PKG_CONFIG_PATH=/driftmesh-wheel/libraries/lib/pkgconfig sh -c '
  exec python3 -m pip wheel --no-deps --no-index --no-build-isolation --wheel-dir /driftmesh-wheel/wheels "$@" /driftmesh-wheel/sdist/*.tar.gz' sh \
  --config-settings "define=$define" --config-settings licenses=/driftmesh-wheel/libraries/licenses
cp "$root"/driftmesh-wheel/wheels/*.whl "$to/"
ls -l "$to"/driftmesh-*.whl
