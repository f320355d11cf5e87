#!/bin/sh
# A city on a Slurm cluster: shards of the blocks, then the run that publishes.
#
#   CITY=/shared/city deploy/slurm/city.sh 16
#
# CITY is a folder that all nodes mount, or a bucket (s3://archive/city); its manifest is
# there (`nostalgin index`). A shard whose node fails is run again by Slurm; one that is
# killed is not, and the last run makes what it left. What was kept is not made twice.
set -eu
shards=${1:?how many shards}
: "${CITY:?the city folder}"
: "${WORKERS:=4}"
array=$(
    sbatch --parsable --job-name=nostalgin --array="1-$shards" --requeue \
        --cpus-per-task="$WORKERS" --mem-per-cpu=3G --export=ALL \
        --wrap="exec nostalgin build '$CITY' --json --max-rejected 1 \
            --shard \"\$SLURM_ARRAY_TASK_ID/$shards\" --direct_num_workers $WORKERS"
)
sbatch --job-name=nostalgin-publish --dependency="afterany:$array" \
    --cpus-per-task="$WORKERS" --mem-per-cpu=3G --export=ALL \
    --wrap="exec nostalgin build '$CITY' --json --direct_num_workers $WORKERS"
