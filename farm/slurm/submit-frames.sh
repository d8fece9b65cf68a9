#!/bin/sh
# Submits an animation to Slurm: submit-frames.sh CHUNKS FIRST LAST SCENE PICTURE.####.exr [flags of gpt render]
# An array job with a task for each run of frames; #### stands for a frame's number. Prints the number of the job.
# All nodes see the scene, the pictures' folder and this one under the same names. GPT may name the program; SBATCH holds further flags of sbatch.
set -eu
farm=$(cd "$(dirname "$0")/.." && pwd)
chunks=$1
# shellcheck disable=SC2086 # flags of sbatch are words
exec sbatch --parsable --requeue --signal=B:TERM@60 --array="0-$((chunks - 1))" --job-name=gpt-frames ${SBATCH:-} \
    "$farm/slurm/chunk.sbatch" "$farm" frames.sh "$@"
