#!/bin/sh
# Runs a job array with its merge on a Slurm of its own: a controller and two nodes as plain processes on the loopback interface.
#   slurm.sh FOLDER PORT CHUNKS SPP SCENE PICTURE.exr [flags of gpt render]
# GPT names the program. One of its processes is killed by SIGKILL and one asked to stop by SIGTERM on the way, unless SIGNALS names others. Exit
# code 0 once the merged picture is there.
set -eu
folder=$1 port=$2 chunks=$3 spp=$4 scene=$5 picture=$6
shift 6
farm=$(cd "$(dirname "$0")/../../farm" && pwd)
user=$(id -un)
export SLURM_CONF="$folder/slurm.conf"
mkdir -p "$folder/state" "$folder/spool.node1" "$folder/spool.node2"
cat > "$SLURM_CONF" <<CONF
ClusterName=gpt
SlurmctldHost=$(hostname)(127.0.0.1)
SlurmctldPort=$port
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/none
AuthInfo=cred_expire=5
CredType=cred/none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
SchedulerParameters=sched_interval=2,bf_interval=2
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool.%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.%n.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.%n.log
NodeName=node1 NodeAddr=127.0.0.1 NodeHostname=$(hostname) Port=$((port + 1)) CPUs=1 State=UNKNOWN
NodeName=node2 NodeAddr=127.0.0.1 NodeHostname=$(hostname) Port=$((port + 2)) CPUs=1 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
slurmctld -D -c > "$folder/slurmctld.out" 2>&1 &
daemons=$!
for node in node1 node2; do
    slurmd -D -N $node > "$folder/slurmd.$node.out" 2>&1 &
    daemons="$daemons $!"
done
trap 'scancel -u "$user" 2>/dev/null || true; kill $daemons 2>/dev/null || true' EXIT

# Where daemons cannot run at all, as in some containers, status 77 says so.
tries=0
until [ "$(sinfo -h -o %T 2> "$folder/sinfo.err")" = idle ]; do
    tries=$((tries + 1))
    [ "$tries" -lt 60 ] || { cat "$folder/sinfo.err" "$folder"/*.out "$folder"/*.log >&2; exit 77; }
    sleep 1
done

tries=0
until SBATCH="--output=$folder/job-%j.out --open-mode=append" sh "$farm/slurm/submit.sh" "$chunks" "$spp" "$scene" "$picture" "$@" 2> "$folder/submit.err"; do
    tries=$((tries + 1))
    [ "$tries" -lt 30 ] || { cat "$folder/submit.err" >&2; exit 1; }
    sleep 1
done

# A process that renders a part of this picture.
renderer() {
    for process in /proc/[0-9]*; do
        if tr '\0' ' ' < "$process/cmdline" 2> /dev/null | grep -q "^[^ ]*gpt render .*${picture%.exr}.part-"; then
            echo "${process#/proc/}"
            return
        fi
    done
}
for signal in ${SIGNALS-KILL TERM}; do
    waited=0
    # One that ends by itself before it is reached is none: then the next.
    while process=$(renderer); sleep 0.3; [ -z "$process" ] || ! kill -$signal "$process" 2> /dev/null; do
        waited=$((waited + 1))
        [ "$waited" -lt 300 ] || { echo "no chunk ever ran" >&2; squeue >&2; cat "$folder"/*.out "$folder"/*.log >&2; exit 1; }
    done
    echo "sent SIG$signal to a chunk"
    sleep 2
done

waited=0
while [ ! -e "$picture" ]; do
    waited=$((waited + 1))
    [ "$waited" -lt "${MOST_WAITS:-400}" ] || { squeue -t all >&2; tail -n 20 "$folder"/*.out "$folder"/*.log >&2; exit 1; }
    sleep 0.5
done
