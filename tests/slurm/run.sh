#!/usr/bin/env bash
# A sweep as a job array of a real Slurm, with two nodes on this machine: cancelled half-way,
# submitted again and merged, it must give the bytes of the same sweep in one process.
#
#   tests/slurm/run.sh target/release/tilebind
#
# Needs root, and installs slurm-wlm and munge with apt-get where they are missing; where that is
# impossible it says so and succeeds. Daemons, key and state are of this run alone.
set -euo pipefail

binary=$(realpath "${1:?usage: tests/slurm/run.sh BINARY}")
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
[[ -x $binary ]] || {
    echo "slurm: there is no program $binary" >&2
    exit 2
}

points=24 parts=6
sweep=(shapes/tab-20mm.toml --vary "fixed.faces.east.profile.depth=0:0.046:$points"
    --milestones 500 --far-starts 20 --certify-cells 1000 --complete-cells 0 --quiet)

skip() {
    echo "slurm: skipped, $1"
    exit 0
}

fail() {
    echo "slurm: FAILED, $1" >&2
    tail -n 5 "$work"/*.log "$work"/jobs/* >&2 2>/dev/null || true
    exit 1
}

# within SECONDS COMMAND...: repeats the command until it succeeds; fails when time is up.
within() {
    local end=$((SECONDS + $1))
    shift
    until "$@"; do
        ((SECONDS < end)) || return 1
        sleep 0.2
    done
}

installed() {
    local program
    for program in munged slurmctld slurmd sbatch; do
        command -v "$program" >/dev/null || return 1
    done
}

install_packages() {
    local get=(timeout 300 apt-get -qq -o Acquire::Retries=0)
    export DEBIAN_FRONTEND=noninteractive
    "${get[@]}" update >/dev/null 2>&1 &&
        "${get[@]}" install -y --no-install-recommends slurm-wlm munge >/dev/null 2>&1
}

[[ $(id -u) == 0 ]] || skip "not root"
# slurmd does not start without control groups, whatever it tracks its jobs by.
[[ -n $(ls -A /sys/fs/cgroup 2>/dev/null) ]] || skip "no control groups are mounted"
PATH=$PATH:/usr/sbin:/sbin
installed || install_packages || skip "slurm-wlm and munge cannot be installed"
installed || skip "slurm-wlm and munge are not whole"
host=$(hostname)
host=${host%%.*}
getent hosts "$host" >/dev/null || skip "the host's name $host has no address"

work=$(mktemp -d /tmp/tilebind-slurm.XXXXXX)
daemons=()
export SLURM_CONF=$work/slurm.conf

no_jobs() {
    local jobs
    jobs=$(timeout 5 squeue --noheader 2>/dev/null) && [[ -z $jobs ]]
}

stop() {
    if ((${#daemons[@]})); then
        # Running jobs would outlive their daemons.
        no_jobs || timeout 5 scancel --user=root || true
        within 5 no_jobs || true
        kill "${daemons[@]}" 2>/dev/null || true
        wait "${daemons[@]}" 2>/dev/null || true
    fi
    rm -rf "$work"
}
trap stop EXIT
trap 'exit 1' INT TERM HUP

start_munge() {
    local munge=$work/munge
    install -d -o munge -m 755 "$munge"
    head -c 128 /dev/urandom >"$munge/key"
    chown munge "$munge/key"
    chmod 400 "$munge/key"
    # From `/`: the user munge may not enter the present folder.
    (cd / && exec setpriv --reuid=munge --regid=munge --clear-groups munged --foreground \
        --key-file="$munge/key" --socket="$munge/socket" --pid-file="$munge/pid" \
        --seed-file="$munge/seed" --log-file="$munge/log") >"$work/munged.log" 2>&1 &
    daemons+=($!)
    within 10 test -S "$munge/socket" || fail "munged does not start"
}

# Ports below those that the system hands out, others for another run beside this one.
write_configuration() {
    local port=$((20000 + $$ % 3000 * 3))
    cat >"$SLURM_CONF" <<END
ClusterName=tilebind
SlurmctldHost=$host
SlurmctldPort=$port
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
StateSaveLocation=$work/state
SlurmctldPidFile=$work/slurmctld.pid
SlurmdSpoolDir=$work/spool.%n
SlurmdPidFile=$work/%n.pid
MailProg=/bin/true
NodeName=one NodeHostname=$host NodeAddr=$host Port=$((port + 1)) CPUs=1
NodeName=two NodeHostname=$host NodeAddr=$host Port=$((port + 2)) CPUs=1
PartitionName=all Nodes=one,two Default=YES State=UP
END
    mkdir "$work/state" "$work/spool.one" "$work/spool.two" "$work/jobs"
}

both_idle() { [[ $(sinfo --noheader --Node --states=idle --format=%N 2>/dev/null | wc -l) == 2 ]]; }

start_slurm() {
    slurmctld -D -i >"$work/slurmctld.log" 2>&1 &
    daemons+=($!)
    local node
    for node in one two; do
        slurmd -D -N "$node" >"$work/$node.log" 2>&1 &
        daemons+=($!)
    done
    within 20 both_idle || fail "the two nodes do not come up"
}

plan=$work/array/plan.json

submit() {
    sbatch --parsable --array="1-$parts" --output="$work/jobs/%A_%a" "$here/sweep.sbatch" "$plan"
}

# How many points have results.
done_points() { tilebind sweep --status "$plan" --json | sed -n 's/.*"done": *\([0-9]*\).*/\1/p'; }

at_least() { (($(done_points) >= $1)); }

# The files of finished points; a file that was written again is another one.
kept() { find "$work/array/points" -name '*.json' -printf '%f %i %T@\n' | sort; }

# The numbers of an array's tasks in a state, or on a node.
tasks() { scontrol show job "$1" --oneliner | grep -c "$2" || true; }

# The binary under its usual name, for the tasks too.
mkdir "$work/bin"
ln -s "$binary" "$work/bin/tilebind"
PATH=$work/bin:$PATH
chmod 755 "$work"

start_munge
write_configuration
start_slurm

tilebind sweep "${sweep[@]}" --plan "$plan"
first=$(submit)
within 30 at_least $((points / 3)) || fail "the array does not get on"
scancel "$first"
within 15 no_jobs || fail "the array does not stop"
before=$(done_points)
((before < points)) || fail "the array was finished before it was cancelled"
(($(tasks "$first" JobState=CANCELLED) > 0)) || fail "no task was cancelled"
kept >"$work/before"
if tilebind sweep --merge "$plan" --quiet 2>/dev/null; then
    fail "an unfinished sweep was merged"
fi

second=$(submit)
within 45 no_jobs || fail "the second array does not end"
(($(tasks "$second" JobState=COMPLETED) == parts)) || fail "a task of the second array failed"
for node in one two; do
    (($(tasks "$second" " NodeList=$node") > 0)) || fail "node $node had nothing to do"
done
kept >"$work/after"
[[ -z $(comm -23 "$work/before" "$work/after") ]] || fail "finished points were worked on again"

tilebind sweep --merge "$plan" --quiet || fail "the parts cannot be merged"
tilebind sweep "${sweep[@]}" --out "$work/whole"
diff -r "$work/whole" "$work/array" || fail "the array's results are not those of one process"
echo "slurm: array cancelled at $before of $points points, submitted again: same bytes as one process"
