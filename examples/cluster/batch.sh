#!/bin/bash
# A pyramid on AWS Batch: a job that looks where lines are, an array job of shards that read what it has found, and a job
# that merges them once all are there.
#
#     batch.sh QUEUE SHARDS INPUT OUT.pmtiles [ZOOM]
#
# INPUT and OUT are paths in the container. To change in batch.json, beside this script: the image (none is published:
# yours, with camber on its PATH and a shell) and the file system that all containers share. An array has 2 to 10,000
# children; each has its AWS_BATCH_JOB_ARRAY_INDEX, which --shard auto reads. Batch tries again, not camber: a shard
# that was cut off goes on where it stopped, and one that is finished takes a second.
set -eu
[ $# -ge 4 ] || { sed -n '2,10s/^# \{0,1\}//p' "$0" >&2; exit 2; }
queue=$1 shards=$2 input=$3 out=$4 zoom=${5:-16}

aws batch register-job-definition --cli-input-json "file://$(dirname "$0")/batch.json" >/dev/null
look="camber tiles $input -o $out --max-zoom $zoom --dry-run --schedule $out.schedule --force"
schedule=$(aws batch submit-job --job-name tiles-schedule --job-queue "$queue" --job-definition camber-tiles \
    --container-overrides "{\"command\": [\"sh\", \"-c\", \"$look\"]}" --query jobId --output text)
array=$(aws batch submit-job --job-name tiles --job-queue "$queue" --job-definition camber-tiles \
    --depends-on "jobId=$schedule" --array-properties "size=$shards" \
    --parameters "input=$input,output=$out,zoom=$zoom,shards=$shards,schedule=$out.schedule" \
    --query jobId --output text)
merge="camber tiles merge ${out%.*}.*-of-$shards.${out##*.} --force -o $out && camber tiles verify $out"
aws batch submit-job --job-name tiles-merge --job-queue "$queue" --job-definition camber-tiles \
    --depends-on "jobId=$array" --container-overrides "{\"command\": [\"sh\", \"-c\", \"$merge\"]}" \
    --query jobId --output text
