# Sourced by the scripts that make tables from experiments: their options, the program, and experiments two at a time.
# shellcheck shell=bash disable=SC2034
. "$(dirname "${BASH_SOURCE[0]}")/env.sh"

script=${0##*/}
configs=$project_root/configs
export PYTHONPATH=$project_root/scripts/tables PYTHONDONTWRITEBYTECODE=1

refuse() {
  echo "$script: $*" >&2
  exit 2
}

# read_options OPTIONS ARGUMENT...: sets small and update (yes or no), program, inputs, folder, and chosen, the words after the
# folder. OPTIONS are those that the script has; its first comment is the help.
read_options() {
  local offered=" $1 "
  shift
  small=no update=no program='' inputs='' folder='' chosen=()
  while (($#)); do
    case "$1" in
      -h | --help)
        sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"
        exit 0
        ;;
      -*)
        [[ $offered == *" $1 "* ]] || refuse "unknown option '$1'; see --help"
        ;;&
      --small) small=yes ;;
      --update) update=yes ;;
      --program | --inputs)
        (($# > 1)) || refuse "$1 needs a file or folder"
        [[ -e $2 ]] || refuse "$2 does not exist"
        printf -v "${1#--}" '%s' "$(realpath "$2")"
        shift
        ;;
      *) if [[ -z $folder ]]; then folder=$1; else chosen+=("$1"); fi ;;
    esac
    shift
  done
  [[ $small == no || $update == no ]] || refuse "--small figures say nothing: no --update with them"
}

# Of the tables to come, if they are to be written into docs/results: when, of which sources, where. Before anything here changes.
find_origin() {
  origin=''
  [[ $update == no ]] || origin=$(python3 "$project_root/scripts/tables/results.py" "$program")
}

# use_folder DEFAULT: makes the folder of the results.
use_folder() {
  mkdir -p "${folder:=$project_root/$1}"
  folder=$(cd "$folder" && pwd)
}

# Unless the program was given. GROUPS of packages (scripts/setup.sh).
build_program() {
  [[ -z $program ]] || return 0
  "$project_root/scripts/setup.sh" "$@"
  say "Building driftmesh"
  (cd "$project_root" && cmake --preset release -Wno-dev -DDRIFTMESH_TESTS=OFF &&
    cmake --build --preset release -j "$jobs" --target driftmesh)
  program=$project_root/build/release/driftmesh
}

# run_experiment NAME FILE SETTING...: into FOLDER/NAME; the seconds of the processor, user and system, into FOLDER/NAME.seconds.
run_experiment() {
  local name=$1 file=$2 setting settings=() TIMEFORMAT='%U %S'
  shift 2
  for setting in "$@"; do settings+=(--set "$setting"); done
  rm -rf "${folder:?}/$name"
  { time "$program" run "$configs/$file.yaml" -o "$folder/$name" --quiet "${settings[@]}" 2>&3; } 3>&2 2>"$folder/$name.seconds"
  after_experiment "$name"
  say "$name: done in $SECONDS s"
}
after_experiment() { :; } # NAME: for scripts that do more with it

# Simulated time does not depend on what else runs here: two experiments at a time if there is memory for the largest, 6.5 GB each.
available_kib=$(awk '/^MemAvailable:/ { print $2 }' /proc/meminfo)
if ((jobs > 1 && available_kib > 14000000)); then at_once=2; else at_once=1; fi
running=0
experiment() {
  ((running < at_once)) || one_more_done
  run_experiment "$@" &
  ((++running))
}
one_more_done() {
  wait -n
  ((running--)) || true
}
all_done() {
  while ((running > 0)); do one_more_done; done
}
trap 'kill $(jobs -p) 2>/dev/null || true' EXIT
