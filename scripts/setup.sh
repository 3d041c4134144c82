#!/usr/bin/env bash
# Installs the Debian packages that the named groups need and that are missing.
#   scripts/setup.sh [build] [gis] [report] [python] [test] [all] [readers] [bench] [fuzz] [wheel] [hosts] [site]        (default: build)
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/env.sh"

# The packages that the project needs from Debian 12.
packages_of() {
  case "$1" in
    build) echo g++ cmake ninja-build pkg-config libcli11-dev libfmt-dev libhdf5-dev nlohmann-json3-dev \
      libyaml-cpp-dev libcairo2-dev libmetis-dev libtrilinos-zoltan-dev \
      libboost-serialization-dev libopenmpi-dev openmpi-bin zlib1g-dev ;;
    gis) echo libgdal-dev ;;  # 160 MB with what it needs; users of what is built with it need libgdal32 alone, if they read such files
    report) { command -v node && command -v npm; } >/dev/null || echo nodejs npm ;;  # others than Debian's will do
    python) echo pybind11-dev python3-dev python3-mpi4py python3-numpy ;;
    test) echo doctest-dev libboost-dev python3 python3-yaml ;;
    all) echo chromium clang-format clang-tidy dpkg-dev file fish gdal-bin gmsh gmt-gshhg-full libcgal-dev man-db mypy python3-pip \
      python3-h5py python3-scipy python3-shapely python3-venv spin zsh ;;  # what scripts/test.sh --all needs besides
    readers) echo gmsh openmpi-bin python3-dolfinx python3-geopandas python3-h5py python3-matplotlib python3-meshio python3-netcdf4 python3-petsc4py \
      python3-vtk9 python3-xarray ;;
    bench) echo libbenchmark-dev libcgal-dev ;;
    wheel) echo debootstrap binutils ;;
    fuzz) echo clang libclang-rt-14-dev libfuzzer-14-dev ;;
    hosts) echo iproute2 nftables ;;
    site) echo doxygen mkdocs ;;
    *)
      echo "setup.sh: unknown group '$1'; use build, gis, report, python, test, all, readers, bench, fuzz, wheel, hosts or site" >&2
      return 2
      ;;
  esac
}

missing_of() {
  local package
  for package in "$@"; do
    [[ $(dpkg-query -W -f='${Status}' "$package" 2>/dev/null) == *" installed" ]] || echo "$package"
  done
}

as_root() {
  if ((EUID == 0)); then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    echo "setup.sh: installing packages needs root: run this as root, or install sudo" >&2
    return 1
  fi
}

install() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "$@"
}

if ! command -v apt-get >/dev/null; then
  echo "setup.sh: this is not a Debian system; install the equivalents of the packages listed in $0" >&2
  exit 1
fi

needed=()
for group in "${@:-build}"; do
  packages=$(packages_of "$group")
  read -ra words <<<"$packages"
  needed+=("${words[@]}")
done
mapfile -t missing < <(missing_of "${needed[@]}" | sort -u)
((${#missing[@]})) || exit 0

say "Installing ${missing[*]}"
# Package lists that are absent or out of date show as unknown or unavailable packages: refresh them then, and only then.
if ! { apt-cache show "${missing[@]}" >/dev/null 2>&1 && install "${missing[@]}"; }; then
  as_root apt-get update -q
  install "${missing[@]}"
fi
