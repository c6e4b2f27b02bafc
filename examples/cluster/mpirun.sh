#!/bin/bash
# Draws a pyramid with mpirun (Open MPI; --shard auto also reads the variables that MPICH and Slurm's srun set):
#
#     mpirun.sh PROCESSES OUT.pmtiles INPUT [OPTION...]
#
# The script is three lines, which you can copy. The first makes a schedule, which all processes read. MPI does not
# retry: if one process fails, all end. Then run the same command again: finished shards take a second, and an
# interrupted one continues where it stopped. Set MPIRUN to options for mpirun.
set -eu
[ $# -ge 3 ] || { sed -n '2,8s/^# \{0,1\}//p' "$0" >&2; exit 2; }
n=$1 out=$2
shift 2
"${CAMBER:-camber}" tiles "$@" -o "$out" --dry-run --schedule "$out.schedule" --force
# shellcheck disable=SC2086 # several options
mpirun ${MPIRUN:-} -n "$n" "${CAMBER:-camber}" tiles "$@" -o "$out" --schedule "$out.schedule" --shard auto --resume
"${CAMBER:-camber}" tiles merge "${out%.*}".*-of-"$n"."${out##*.}" --force -o "$out"
rm -f "$out.schedule" "$out.schedule.features"
