#!/bin/sh
# Renders a chunk of an animation's frames: frames.sh INDEX CHUNKS FIRST LAST SCENE PICTURE.####.exr [flags of gpt render]
# The chunk has every frame from FIRST to LAST whose place is in its part of them, as `gpt plan --frames FIRST-LAST` cuts them. Its exit code is that of
# gpt: 5 and 130 mean again, 2, 3 and 4 mean that it would fail again. Frames that are finished are not rendered again.
set -eu
index=$1 chunks=$2 first=$3 last=$4 scene=$5 picture=$6
shift 6
count=$((last - first + 1))
start=$((first + count * index / chunks))
end=$((first + count * (index + 1) / chunks - 1))
[ "$end" -ge "$start" ] || exit 0
gpt=${GPT:-gpt}
"$gpt" render "$scene" --frames "$start-$end" --resume -o "$picture" "$@" &
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
