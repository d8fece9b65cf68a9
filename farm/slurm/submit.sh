#!/bin/sh
# Submits a picture to Slurm: submit.sh CHUNKS SPP SCENE PICTURE.exr [flags of gpt render]
# An array job with a task for each chunk, and a job that joins them once all have ended well. Prints the number of the second job.
# All nodes see the scene, the picture's folder and this one under the same names. GPT may name the program; SBATCH holds further flags of sbatch.
set -eu
farm=$(cd "$(dirname "$0")/.." && pwd)
chunks=$1 spp=$2 scene=$3 picture=$4
shift 4
# shellcheck disable=SC2086 # flags of sbatch are words
array=$(sbatch --parsable --requeue --signal=B:TERM@60 --array="0-$((chunks - 1))" --job-name=gpt ${SBATCH:-} \
    "$farm/slurm/chunk.sbatch" "$farm" chunk.sh "$chunks" "$spp" "$scene" "$picture" "$@")
# shellcheck disable=SC2086
sbatch --parsable --dependency="afterok:${array%%;*}" --kill-on-invalid-dep=yes --job-name=gpt-merge ${SBATCH:-} \
    "$farm/slurm/merge.sbatch" "$farm" "$chunks" "$spp" "$picture"
