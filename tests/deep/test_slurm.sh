#!/usr/bin/env bash
# Shards on a Slurm cluster, which is two nodes on this machine without systemd, and by mpirun:
# test_slurm.sh TOOL FOLDER_OF_JOB_SCRIPTS INPUT
#
# An array of four shards. One task is killed, and one node is lost while it draws. Slurm requeues both, and the merge
# behind the array has the bytes of a single run. However the test ends, what holds a file of its folder is killed.
set -euo pipefail
tool=$(realpath "$1") scripts=$(realpath "$2") input=$(realpath "$3")
options=(--max-zoom 17 --tile-size 256)
PATH=$PATH:/usr/sbin

skip() { echo "skipped: $*"; exit 77; }
[ "$(id -u)" -eq 0 ] || skip "the daemons of Slurm's nodes want root"
for program in munged:munge slurmctld:slurm-wlm slurmd:slurm-wlm sbatch:slurm-wlm mpirun:openmpi-bin; do
    command -v "${program%:*}" >/dev/null || skip "no ${program%:*} (Debian: ${program#*:})"
done
export TMPDIR=/tmp # a socket's path is short
work=$(mktemp -d /tmp/camber-slurm-XXXXXX)
cd "$work"

# Numbers of the processes that have a path below the test's folder open, or a variable with that folder in it.
holders() { # "": the folder itself; or node n1, n2
    local node=${1:+SLURMD_NODENAME=$1}
    {
        find /proc/[0-9]*/fd -lname "$work/${1:+$1.}*" 2>/dev/null || true
        grep -lsaF "$work/" /proc/[0-9]*/environ | xargs -r grep -lsaF "${node:-$work/}" || true
    } | cut -d/ -f3 | sort -un | grep -vx "$$" || true
}

clean_up() {
    local status=$?
    trap - EXIT INT TERM HUP
    for _ in 1 2 3; do
        # shellcheck disable=SC2046 # several numbers
        kill -9 $(holders) 2>/dev/null || true
        sleep 0.2
    done
    [ $status -eq 0 ] || tail -n 15 "$work"/*.log || true
    cd /
    rm -rf "$work"
    exit $status
}
trap clean_up EXIT
trap 'exit 143' INT TERM HUP

die() { echo "FAILED: $*"; exit 1; }
# Runs a condition again and again until it holds.
await() { # seconds, what, command...
    local end=$((SECONDS + $1)) what=$2
    shift 2
    until "$@"; do
        [ $SECONDS -lt $end ] || die "in vain: $what"
        sleep 0.1
    done
}

# ---- The cluster ----

# Whether both ports that follow are free, and this one.
ports_are_free() { # port
    ! ss -Htln 2>/dev/null | awk '{print $4}' | grep -qE ":($1|$(($1 + 1))|$(($1 + 2)))\$"
}

start_cluster() {
    local host port=$((20000 + $$ % 12000)) node # below those from which a system takes ports of connections
    host=$(hostname -s)
    until ports_are_free $port; do port=$((port + 3)); done
    mkdir -m 755 munge state
    dd if=/dev/urandom of=munge/key bs=1024 count=1 status=none
    chmod 400 munge/key
    # cred_expire is also how long a requeued task waits; Slurm's own is two minutes.
    cat >slurm.conf <<CONF
ClusterName=camber
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmctldPort=$port
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket,cred_expire=5
CredType=cred/munge
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/%n.spool
SlurmctldPidFile=$work/ctld.pid
SlurmdPidFile=$work/%n.pid
SlurmctldLogFile=$work/ctld.log
SlurmdLogFile=$work/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_min_interval=100000,batch_sched_delay=0,defer_batch
SlurmdParameters=config_overrides
ReturnToService=2
SlurmdTimeout=6
KillWait=1
RequeueExit=137
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=2
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=2
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
CONF
    export SLURM_CONF=$work/slurm.conf
    munged --force --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munge/pid" \
        --log-file="$work/munge/log" --seed-file="$work/munge/seed"
    slurmctld -D -c >/dev/null 2>&1 &
    for node in n1 n2; do slurmd -D -N $node >/dev/null 2>&1 & done
    disown -a # the shell need not tell that they were killed
    await 400 "two idle nodes" nodes_are_idle
}
nodes_are_idle() { [ "$(sinfo -h -t idle -o %D 2>/dev/null)" = 2 ]; }

# ---- The tool, whose first runs as task 1 and 2 do not end well ----

write_tool() {
    cat >camber <<TOOL
#!/bin/bash
# Notes who draws what. Task 1 is killed the first time; task 2 is stopped, and says so.
[ "\$2" != merge ] && [ "\$2" != verify ] && [ -n "\${SLURM_ARRAY_TASK_ID:-}" ] || exec "$tool" "\$@"
echo "\$SLURM_ARRAY_TASK_ID \${SLURM_RESTART_COUNT:-0} \$SLURMD_NODENAME" >>$work/runs
case "\${SLURM_RESTART_COUNT:-0} \$SLURM_ARRAY_TASK_ID" in "0 1" | "0 2") ;; *) exec "$tool" "\$@" ;; esac
[ -e $work/calm ] && exec "$tool" "\$@"
"$tool" "\$@" &
until [ -s $work/city.\$((SLURM_ARRAY_TASK_ID + 1))-of-4.pmtiles.camber-units ]; do
    kill -0 \$! || { echo "over before it could be killed" >&2; exit 70; }
    sleep 0.005
done
if [ \$SLURM_ARRAY_TASK_ID = 1 ]; then
    kill -9 \$!
else
    kill -STOP \$!
    echo "\$SLURMD_NODENAME" >$work/stopped.new
    mv $work/stopped.new $work/stopped
fi
wait \$!
TOOL
    chmod +x camber
}

# ---- The test ----

lose_node() { # name
    # shellcheck disable=SC2046 # several numbers
    kill -9 $(holders "$1")
    echo "$1 is lost"
}

queue_is_empty() { [ -z "$(squeue -h 2>/dev/null || echo unknown)" ]; }
times_of_parts() { stat -c '%n %y' city.?-of-4.pmtiles; }

test_array() {
    local node
    "$scripts/slurm.sh" 4 "$work/city.pmtiles" "$input" "${options[@]}"
    await 400 "task 2 draws" [ -s stopped ]
    node=$(cat stopped)
    lose_node "$node"
    await 400 "the array and its merge end" queue_is_empty
    cmp single/city.pmtiles city.pmtiles || die "the merge of four shards is not what a single run writes"
    for task in 0 1 2 3; do
        sort -u runs | grep -q "^$task 0 " || die "task $task was not run: $(cat runs)"
    done
    grep -q '^1 1 ' runs || die "the killed task was not requeued: $(cat runs)"
    grep "^2 [1-9] " runs | grep -qv " $node\$" || die "the lost node's task was not requeued on the other: $(cat runs)"
}

# The same command again draws nothing.
test_again() {
    times_of_parts >times.txt
    touch calm
    "$scripts/slurm.sh" 4 "$work/city.pmtiles" "$input" "${options[@]}"
    await 400 "finished shards end at once" queue_is_empty
    times_of_parts | cmp - times.txt || die "a finished shard was drawn again"
    cmp single/city.pmtiles city.pmtiles
}

# Shards that cannot be drawn: each log says why, and nothing is merged.
test_failing() {
    "$scripts/slurm.sh" 2 "$work/none.pmtiles" "$input" --style "$work/missing.json"
    await 400 "a merge without its parts ends" queue_is_empty
    [ ! -e none.pmtiles ] || die "there is an archive without parts"
    grep -q missing.json none.0.log || die "the log does not say why: $(cat none.0.log)"
    grep -q '1-of-2' none.merge.log || die "the merge does not name what is missing: $(cat none.merge.log)"
}

test_mpirun() {
    CAMBER=$tool MPIRUN="--allow-run-as-root --oversubscribe" "$scripts/mpirun.sh" 3 mpi/city.pmtiles "$input" "${options[@]}"
    [ "$(echo mpi/city.?-of-3.pmtiles | wc -w)" = 3 ] || die "not three parts: $(ls)"
    cmp single/city.pmtiles mpi/city.pmtiles || die "the merge of mpirun's three shards is not what a single run writes"
}

mkdir single mpi
"$tool" tiles "$input" -o single/city.pmtiles "${options[@]}" # its name is in the metadata
write_tool
start_cluster
export CAMBER=$work/camber
for test in test_array test_again test_failing test_mpirun; do
    begin=$SECONDS
    $test
    echo "$test: $((SECONDS - begin)) s"
done
