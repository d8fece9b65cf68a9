#!/bin/sh
# Joins the chunks of a picture: merge.sh CHUNKS SPP PICTURE.exr
# The parts are removed once the picture is in its place.
set -eu
chunks=$1 spp=$2 picture=$3
gpt=${GPT:-gpt}
set --
index=0
while [ "$index" -lt "$chunks" ]; do
    set -- "$@" "${picture%.exr}.part-$index.exr"
    index=$((index + 1))
done
"$gpt" merge "$@" --spp "$spp" -o "$picture"
rm -f "$@"
