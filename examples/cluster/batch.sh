#!/bin/bash
# Draws a pyramid on AWS Batch: a job makes the schedule, an array job draws the shards from it, and a job merges them
# when all have finished.
#
#     batch.sh QUEUE SHARDS INPUT OUT.pmtiles [ZOOM]
#
# INPUT and OUT are paths in the container. In batch.json, next to this script, set the image (none is published: build
# one with a shell and with camber on its PATH) and the file system that all containers share. An array has 2 to 10,000
# children. Each has an AWS_BATCH_JOB_ARRAY_INDEX, which --shard auto reads. Batch retries failed jobs; camber then
# continues an interrupted shard where it stopped, and a finished shard takes a second.
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
