#!/usr/bin/env bash
# Several hosts on one machine: network namespaces, each with its own name, address and link to a switch, which make a
# distributed mesh over TCP as on a cluster. The last host is slower than the others, and work is balanced during the
# run. The mesh is checked against the input and compared with the one that a single host makes.
#   scripts/hosts.sh [OPTIONS]
# Options:
#   --hosts N           number of hosts, from 2 to 99 (3)
#   --slots N           ranks on each host (1)
#   --latency MS        latency between hosts, in milliseconds (0.2)
#   --rate MBIT         bandwidth of each link, in Mbit/s (1000)
#   --loss PERCENT      percentage of packets that are lost (0.1)
#   --slow FRACTION     fraction of the time that the last host works (0.5)
#   --balance POLICY    load balancing policy: none, zoltan, stealing, diffusion or greedy (stealing)
#   --input FILE.poly   the domain (a generated bay)
#   --area AREA         largest area of a triangle (1000; required with --input)
#   --subdomains N      number of subdomains, which can move between ranks (20 per rank)
#   --presplit MODE     on: shared edges are split to size before refinement; off: during refinement, with messages
#                       between the ranks, so that each run makes a different mesh (on)
#   -o, --output FOLDER folder for the results (demo/hosts in the project)
#   --program FILE      the program (build/release/driftmesh in the project)
#   --dry-run           print the commands instead of running them
# Hosts and switch have their own namespaces: the machine's network is not touched, and the kernel removes everything when
# the script ends, however it ends. Only on Linux; as root, or where users may create namespaces.
# Exit code: 0 done, 1 something failed, 2 wrong usage, 77 not possible on this machine.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/env.sh"
PATH=$PATH:/usr/sbin:/sbin # the location of ip, tc and nft, not in every user's PATH

fail() { # fail CODE MESSAGE
  printf 'hosts.sh: %s\n' "$2" >&2
  exit "$1"
}

hosts=3 slots=1 latency=0.2 rate=1000 loss=0.1 slow=0.5 balance=stealing
input='' area='' subdomains='' presplit=on folder=$project_root/demo/hosts program=$project_root/build/release/driftmesh
dry=no
all=("$@")
while (($#)); do
  case "$1" in
    -h | --help)
      sed -n '2,/^set -/s/^# \{0,1\}//p' "$0"
      exit 0
      ;;
    --dry-run)
      dry=yes
      shift
      continue
      ;;
    --hosts | --slots | --latency | --rate | --loss | --slow | --balance | --input | --area | --subdomains | \
      --presplit | --output | -o | --program) (($# > 1)) || fail 2 "$1 needs a value; see --help" ;;
    *) fail 2 "unknown option '$1'; see --help" ;;
  esac
  case "$1" in
    -o | --output) folder=$2 ;;
    *) declare "${1#--}=$2" ;;
  esac
  shift 2
done

whole() { # whole OPTION VALUE LEAST MOST
  if ! [[ $2 =~ ^(0|[1-9][0-9]{0,7})$ ]] || (($2 < $3 || $2 > $4)); then
    fail 2 "$1 is a whole number from $3 to $4, not '$2'"
  fi
}
decimal() { # decimal OPTION VALUE MOST
  if ! [[ $2 =~ ^[0-9]+(\.[0-9]+)?$ ]] || awk -v v="$2" -v most="$3" 'BEGIN { exit v <= most }'; then
    fail 2 "$1 is a number from 0 to $3, not '$2'"
  fi
}
whole --hosts "$hosts" 2 99
whole --slots "$slots" 1 1000
whole --rate "$rate" 1 100000
decimal --latency "$latency" 10000
decimal --loss "$loss" 50
decimal --slow "$slow" 1
[[ -z $input || -n $area ]] || fail 2 "--input needs --area: what is small depends on the domain"
[[ -z $input || -r $input ]] || fail 2 "cannot read '$input'"
ranks=$((hosts * slots))
area=${area:-1000}
subdomains=${subdomains:-$((20 * ranks))}
whole --subdomains "$subdomains" "$ranks" 1000000
[[ $presplit == on || $presplit == off ]] || fail 2 "--presplit is on or off, not '$presplit'"

# ---- Outside: create the namespaces for everything that follows, and clean up ----

need() { # need COMMAND...
  local command
  for command in "$@"; do
    command -v "$command" >/dev/null || fail 77 "'$command' is not installed; run scripts/setup.sh build hosts"
  done
}

# Separates the hosts from the machine: they have their own network, mounts, host name and processes. When the first
# process inside ends, all others end with it, and the namespaces end with the last process.
apart=(setpriv --pdeathsig KILL unshare --net --mount --uts --pid --fork --kill-child --mount-proc)
((EUID == 0)) || apart+=(--user --map-root-user)

if [[ $dry == no && -z ${DRIFTMESH_HOSTS_WORK:-} ]]; then
  need setpriv unshare ip tc mpirun
  [[ -x $program ]] || fail 1 "there is no $program; build it, as scripts/demo.sh does, or name it with --program"
  if ! "${apart[@]}" true 2>/dev/null; then
    ((EUID == 0)) || fail 77 "users may not create namespaces on this machine; run this as root"
    fail 77 "namespaces cannot be created; in a container, they need more privileges (docker run --privileged)"
  fi
  work=$(mktemp -d)
  export DRIFTMESH_HOSTS_WORK=$work

  inside=
  take_down() {
    trap '' INT TERM
    if [[ -n $inside ]]; then
      # First politely, so that incomplete files are removed; what is left after some seconds is killed.
      kill -TERM -- "-$inside" 2>/dev/null || true
      for _ in {1..50}; do
        kill -0 "$inside" 2>/dev/null || break
        sleep 0.1
      done
      kill -KILL "$inside" 2>/dev/null || true
      wait "$inside" 2>/dev/null || true
    fi
    rm -rf "$work"
  }
  trap take_down EXIT
  trap 'exit 129' HUP
  trap 'exit 130' INT
  trap 'exit 143' TERM
  set -m # a process group of its own, which take_down can end as a whole
  "${apart[@]}" "${BASH_SOURCE[0]}" ${all+"${all[@]}"} </dev/null &
  inside=$!
  status=0
  wait "$inside" || status=$?
  inside=
  exit "$status"
fi

# ---- Inside: hosts, switch and links ----

work=${DRIFTMESH_HOSTS_WORK:-/tmp/hosts}
trap 'exit 143' TERM

print() { # print COMMAND...: as a user would type it
  local word
  printf '$'
  for word in "$@"; do
    if [[ $word =~ ^[A-Za-z0-9_./,:=%+-]+$ ]]; then printf ' %s' "$word"; else printf ' %q' "$word"; fi
  done
  echo
}
# show COMMAND...: prints the command as a user would run it, then runs it.
show() {
  printf '\n'
  [[ $dry == yes ]] || print "$@"
  "$@"
}
# fill FILE: writes its input to the file.
fill() { cat >"$1"; }
driftmesh() { "$program" "$@"; }
# mpirun and its processes run on the first host, or on the one they name.
mpirun() { ip netns exec host1 unshare --uts sh -c 'hostname host1 && exec mpirun "$@"' sh "$@"; }

if [[ $dry == yes ]]; then
  for command in cd chmod driftmesh ip mkdir modprobe mount mpirun tc; do
    eval "$command() { print $command \"\$@\"; }"
  done
  fill() { printf '# %s contains:\n' "$1" && sed 's/^/#   /'; }
  tee() { cat; }
fi

names() { seq -f 'host%.0f' "$hosts"; }
address() { echo "10.0.0.${1#host}"; }

make_hosts() {
  local host port
  # The names of network namespaces are files in /run/netns. Inside, /run is not that of the machine.
  mount -t tmpfs tmpfs /run
  mkdir /run/netns
  {
    echo "127.0.0.1 localhost"
    for host in $(names); do echo "$(address "$host") $host"; done
  } | fill "$work/names"
  mount --bind "$work/names" /etc/hosts
  ip link set lo up
  ip link add name switch type bridge || fail 77 "this kernel has no bridges (module bridge)"
  ip link set switch up
  for host in $(names); do
    port=port${host#host}
    ip netns add "$host"
    ip link add name "$port" type veth peer name eth0 netns "$host" ||
      fail 77 "this kernel has no virtual links (module veth)"
    ip link set "$port" master switch up
    ip -n "$host" link set lo up
    # Packets as on a wire, not several merged into one: each loss is one packet.
    ip -n "$host" link set eth0 gso_max_segs 1 up
    ip -n "$host" address add "$(address "$host")/24" dev eth0
  done
}

# queue DISCIPLINE...: how packets leave each host.
queue() {
  local host
  for host in $(names); do tc -n "$host" qdisc replace dev eth0 root "$@" || return; done
}
lose_packets() {
  local of_100000
  of_100000=$(awk -v p="$loss" 'BEGIN { printf "%d", p * 1000 }')
  nft add table bridge loss &&
    nft add chain bridge loss forward '{ type filter hook forward priority 0; }' &&
    nft add rule bridge loss forward numgen random mod 100000 '<' "$of_100000" drop
}
# Sets latency, bandwidth and loss of the links as requested. If the kernel has no netem, other tools do what they can,
# and the script says what they cannot do.
shape_links() {
  modprobe -q sch_netem 2>/dev/null || true
  if queue netem delay "${latency}ms" rate "${rate}mbit" loss "$loss%" 2>/dev/null; then
    echo "links: latency $latency ms, $rate Mbit/s, $loss % packet loss"
    return
  fi
  echo "links: this kernel has no netem (module sch_netem), so"
  echo "  the latency is the machine's own, not $latency ms,"
  if queue tbf rate "${rate}mbit" burst "$((10000 + 500 * rate))" latency 50ms 2>/dev/null; then
    echo "  the bandwidth of $rate Mbit/s is set by tbf,"
  else
    echo "  the bandwidth is the machine's own, not $rate Mbit/s (there is no tbf either),"
  fi
  if lose_packets 2>/dev/null; then
    echo "  and $loss % packet loss is set by nftables"
  else
    echo "  and no packets are lost (there is no nftables either; scripts/setup.sh hosts)"
  fi
}

# What a cluster has: a list of its hosts, and a way to start a program on another host, usually ssh.
make_cluster() {
  local host
  for host in $(names); do echo "$host slots=$slots"; done | fill "$folder/hostfile"
  fill "$work/agent" <<'AGENT'
#!/bin/sh
# agent HOST COMMAND...: like ssh, joins the words of the command, which a shell on the host splits again.
host=$1
shift
exec ip netns exec "$host" unshare --uts sh -c 'hostname "$1" && eval "exec $2"' sh "$host" "$*"
AGENT
  chmod +x "$work/agent"
}

# ---- The runs ----

# Ranks communicate only by TCP. The last line is for more ranks than cores, since Open MPI takes each host for a machine
# with all the cores.
on_all_hosts=(mpirun --hostfile hostfile -n "$ranks" --bind-to none
  --mca plm_rsh_agent "$work/agent" --mca oob_tcp_if_include eth0
  --mca pml ob1 --mca btl tcp,self --mca btl_tcp_if_include eth0
  --mca mpi_yield_when_idle 1)
# The fraction of its time that each rank works.
drags() {
  local rank
  for ((rank = 0; rank < ranks - slots; ++rank)); do printf '1,'; done
  for ((; rank < ranks - 1; ++rank)); do printf '%s,' "$slow"; done
  echo "$slow"
}
digest_of() { sed -n 's/.*"digest": "\([0-9a-f]*\)".*/\1/p' "$1"; }
interface_splits() { awk '/"interface_splits":/ { sum += $2 } END { print sum + 0 }' "$@"; }
# What each host has sent so far: its name, bytes, packets, and retransmitted TCP segments.
# shellcheck disable=SC2016
sent() {
  local host
  for host in $(names); do
    ip netns exec "$host" sh -c 'cd /sys/class/net/eth0/statistics && echo "$0" $(cat tx_bytes tx_packets) \
      $(awk "/^Tcp: [0-9]/ { print \$13 }" /proc/net/snmp)' "$host"
  done
}

if [[ $dry == no ]]; then
  [[ -z $input ]] || input=$(readlink -f "$input")
  program=$(readlink -f "$program")
  folder=$(mkdir -p "$folder" && readlink -f "$folder")
fi
cd "$folder"

say "$hosts hosts and a switch"
make_hosts
shape_links
make_cluster
# Temporary files of Open MPI are removed with the rest.
mkdir "$work/tmp"
export TMPDIR=$work/tmp

say "The hosts"
show "${on_all_hosts[@]}" --tag-output hostname | tee "$work/who"
[[ $dry == yes || $(grep -o 'host[0-9]*$' "$work/who" | sort -u | wc -l) == "$hosts" ]] ||
  fail 1 "not every host has answered"

say "A mesh made by all hosts, of which the last works $slow of its time"
if [[ -z $input ]]; then
  input=bay.poly
  show driftmesh generate bay -o bay.poly
fi
[[ $dry == yes ]] || sent >"$work/sent"
show "${on_all_hosts[@]}" "$program" mesh "$input" --area "$area" --subdomains "$subdomains" --presplit "$presplit" \
  --balance "$balance" --drag "$(drags)" -o hosts.pvtu --json hosts.json
[[ $dry == yes ]] || sent >>"$work/sent"

say "Check the mesh against the input"
show driftmesh check hosts.pvtu "$input" --area "$area" --angle 20 --quiet

say "The same mesh made by one host"
show driftmesh mesh "$input" --area "$area" --subdomains "$subdomains" --presplit "$presplit" --json one-host.json --quiet
[[ $dry == no ]] || exit 0
together=$(digest_of hosts.json)
alone=$(digest_of one-host.json)
splits=$(interface_splits hosts.json one-host.json)
printf 'digest of the mesh: %s by %d hosts, %s by one\n' "$together" "$hosts" "$alone"
if ((splits > 0)); then
  echo "The two meshes may differ: edges between subdomains were split while refining, $splits times in both runs"
  echo "(docs/guarantees.md). With --presplit on and small triangles (--area), they are split beforehand."
elif [[ -z $alone || $together != "$alone" ]]; then
  fail 1 "$hosts hosts and one host did not make the same mesh"
fi

say "Network traffic"
awk '!($1 in bytes) { bytes[$1] = $2; packets[$1] = $3; again[$1] = $4; next }
  { printf "%s: %.2f MB in %d packets, %d retransmitted\n", $1, ($2 - bytes[$1]) / 1e6, $3 - packets[$1], $4 - again[$1] }
  $3 == packets[$1] { silent = 1 }
  END { exit silent }' "$work/sent" || fail 1 "a host has sent nothing: the ranks did not communicate over the links"
printf '\nhosts.pvtu and the record of the run (hosts.json) are in %s\n' "$folder"
