#!/bin/bash
# Draws a pyramid on a Slurm cluster: a job makes the schedule, an array draws the shards, and a job merges them.
#
#     slurm.sh SHARDS OUT.pmtiles INPUT [OPTION...]
#     slurm.sh 64 /shared/city.pmtiles /shared/city.osm.pbf --style /shared/roads.json --max-zoom 16
#
# It prints the job numbers of the array and the merge. Shards read the schedule from the folder of OUT; if the first
# job has failed, each finds the lines itself. All paths must be on a disk that all nodes share. SBATCH_OPTIONS are
# options of sbatch for the array: "--cpus-per-task=4 --mem=4G --time=2:00:00". Set CAMBER to the path of the tool if it
# is not on PATH.
#
# Slurm retries, not camber. It requeues a task whose node is lost. To requeue killed tasks, too, put RequeueExit=137
# into slurm.conf (137 also means out of memory). After any other failure run the same command again: finished shards
# take a second, and an interrupted one continues where it stopped. Exit statuses 65 (the input) and 2 (an option) will
# not go away by running it again.
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
    # Do not use exec: the shell turns a SIGKILL into status 137, which RequeueExit can name.
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
# Do not use afterok, which treats an array as failed as soon as one task has failed, even if Slurm requeues it (22.05).
# If shards are missing, the merge names them and writes nothing.
merge=$(sbatch --parsable --job-name=tiles-merge --dependency="afterany:$array" --requeue \
    --open-mode=append --output="${out%.*}.merge.log" "$0" --merge "$shards" "$out")
echo "array $array, merge $merge"
