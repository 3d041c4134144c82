# Sourced by the other scripts: the project folder, and the environment of every command that they start.
# shellcheck shell=bash disable=SC2034

project_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
jobs=$(nproc)
export LC_ALL=C.UTF-8
# Open MPI refuses to start as root, or with more ranks than cores, unless told that both are intended.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1

say() { printf '\n== %s\n' "$*"; }
