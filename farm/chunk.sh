#!/bin/sh
# Renders one chunk of a picture: chunk.sh INDEX CHUNKS SPP SCENE PICTURE.exr [flags of gpt render]
# The chunk has the samples from SPP * INDEX / CHUNKS on, as `gpt plan` cuts them, and goes to PICTURE.part-INDEX.exr. Its exit code is that of
# gpt: 5 and 130 mean again, 2, 3 and 4 mean that it would fail again. What is finished is not rendered again.
set -eu
index=$1 chunks=$2 spp=$3 scene=$4 picture=$5
shift 5
first=$((spp * index / chunks))
end=$((spp * (index + 1) / chunks))
gpt=${GPT:-gpt}
"$gpt" render "$scene" --first-sample "$first" --spp $((end - first)) --expected-spp "$spp" --resume -o "${picture%.exr}.part-$index.exr" "$@" &
child=$!
# A signal that asks for an end goes on to gpt, which saves what it has.
trap 'kill -TERM "$child" 2>/dev/null || true' TERM INT
code=0
wait "$child" || code=$?
# A shell that was sent a signal returns from `wait` before the child has ended.
while kill -0 "$child" 2>/dev/null; do
    code=0
    wait "$child" || code=$?
done
exit "$code"
