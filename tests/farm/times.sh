#!/bin/sh
# Runs a job array on a Slurm of its own (slurm.sh, whose arguments these are) and prints when each process of gpt began and ended, in seconds from
# the first one on, with its exit code and its task (none: the merge): what the model of docs/scaling.md is held against.
set -eu
folder=$1
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$folder"
times=$folder/times
cat > "$folder/timed" <<TIMED
#!/bin/sh
begin=\$(date +%s.%N)
code=0
"${GPT:-gpt}" "\$@" || code=\$?
echo "\$begin \$(date +%s.%N) \$code \${SLURM_ARRAY_TASK_ID:-none}" >> "$times"
exit \$code
TIMED
chmod +x "$folder/timed"
GPT="$folder/timed" sh "$here/slurm.sh" "$@"
sort -n "$times" | awk 'NR == 1 { first = $1 } { printf "task %s: %.2f to %.2f s, exit code %d\n", $4, $1 - first, $2 - first, $3 }'
