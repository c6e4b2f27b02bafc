#!/bin/bash
# A pyramid by mpirun (Open MPI; MPICH and Slurm's srun set variables that --shard auto reads as well):
#
#     mpirun.sh PROCESSES OUT.pmtiles INPUT [OPTION...]
#
# It is three lines, to be copied. The first looks where lines are, and processes read what it has found. MPI tries
# nothing again: one process that fails ends all. Run the same line then: finished shards take a second, and one that
# was cut off goes on where it stopped. MPIRUN has mpirun's options.
set -eu
[ $# -ge 3 ] || { sed -n '2,8s/^# \{0,1\}//p' "$0" >&2; exit 2; }
n=$1 out=$2
shift 2
"${CAMBER:-camber}" tiles "$@" -o "$out" --dry-run --schedule "$out.schedule" --force
# shellcheck disable=SC2086 # several options
mpirun ${MPIRUN:-} -n "$n" "${CAMBER:-camber}" tiles "$@" -o "$out" --schedule "$out.schedule" --shard auto --resume
"${CAMBER:-camber}" tiles merge "${out%.*}".*-of-"$n"."${out##*.}" --force -o "$out"
rm -f "$out.schedule" "$out.schedule.features"
