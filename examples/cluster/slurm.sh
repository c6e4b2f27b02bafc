#!/bin/bash
# A pyramid on a Slurm cluster: a job that looks where lines are, an array of shards, and their merge behind it.
#
#     slurm.sh SHARDS OUT.pmtiles INPUT [OPTION...]
#     slurm.sh 64 /shared/city.pmtiles /shared/city.osm.pbf --style /shared/roads.json --max-zoom 16
#
# It prints the numbers of array and merge. Shards read what the first job has found, beside OUT; where it failed, each
# looks for itself. Paths are on a disk that all nodes share. SBATCH_OPTIONS goes to sbatch for the
# array: "--cpus-per-task=4 --mem=4G --time=2:00:00". CAMBER names the tool where it is not on PATH.
#
# Slurm tries again, not camber. A task whose node is lost is requeued. For one that was killed slurm.conf says so:
# RequeueExit=137 (for want of memory: 137 too). After anything else run the same command again: finished shards take
# a second, and one that was cut off goes on where it stopped. Exit status 65 (the input) or 2 (an option) stays one.
set -eu
CAMBER=${CAMBER:-camber}

part_of() { # OUT.pmtiles, SHARDS: the names of the parts, in order
    for ((k = 1; k <= $2; k++)); do printf '%s\n' "${1%.*}.$k-of-$2.${1##*.}"; done
}

case "${1:-}" in
--schedule)
    schedule=$2
    shift 2
    "$CAMBER" tiles "$@" --dry-run --schedule "$schedule" --force
    exit
    ;;
--task)
    schedule=$2
    shift 2
    [ ! -e "$schedule" ] || set -- "$@" --schedule "$schedule"
    # Not exec: the shell makes status 137 of a SIGKILL, which RequeueExit can name.
    "$CAMBER" tiles "$@" --shard auto --resume --threads "${SLURM_CPUS_PER_TASK:-${SLURM_CPUS_ON_NODE:-1}}"
    exit
    ;;
--merge)
    mapfile -t parts < <(part_of "$3" "$2")
    "$CAMBER" tiles merge "${parts[@]}" --force -o "$3"
    "$CAMBER" tiles verify "$3"
    rm -f "$3.schedule" "$3.schedule.features"
    exit
    ;;
esac

if [ $# -lt 3 ] || [[ ! $1 =~ ^[1-9][0-9]*$ ]]; then
    sed -n '2,14s/^# \{0,1\}//p' "$0" >&2
    exit 2
fi
shards=$1 out=$(realpath -m "$2") input=$(realpath "$3")
shift 3
mkdir -p "${out%/*}"
rm -f "$out.schedule" # of a run with another input or style
schedule=$(sbatch --parsable --job-name=tiles-schedule --requeue --open-mode=append --output="${out%.*}.schedule.log" \
    "$0" --schedule "$out.schedule" "$input" -o "$out" "$@")
# shellcheck disable=SC2086 # several options
array=$(sbatch --parsable --job-name=tiles --array="0-$((shards - 1))" --requeue --open-mode=append \
    --dependency="afterany:$schedule" --output="${out%.*}.%a.log" ${SBATCH_OPTIONS:-} "$0" --task "$out.schedule" "$input" -o "$out" "$@")
# Not afterok: to that an array has failed for good once a task has, though Slurm requeued it (22.05). The merge itself
# names the shards that are missing, and writes nothing then.
merge=$(sbatch --parsable --job-name=tiles-merge --dependency="afterany:$array" --requeue \
    --open-mode=append --output="${out%.*}.merge.log" "$0" --merge "$shards" "$out")
echo "array $array, merge $merge"
