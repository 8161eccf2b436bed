#!/usr/bin/env bash
# run_memory.sh FOGLINE TRANSPORT: checks that the largest process of a run of 50,000 steps needs at
# most a tenth more memory than the largest process of a run of 5,000 steps.
set -euo pipefail
cd "$(dirname "$0")/../../.."
fogline=$1
transport=$2
# tools/test removes the files of killed tests in this folder.
scratch="$(dirname "$fogline")/../Testing/tmp"
mkdir -p "$scratch"
folder=$(mktemp -d "$scratch/memory-XXXXXX")
trap 'rm -rf "$folder"' EXIT

# Prints the peak resident memory, in KiB, of the largest process of a run with $1 steps.
peak() {
  /usr/bin/time --format=%M --output="$folder/peak" "$fogline" run scenario/paper.json --quiet \
    --transport "$transport" --set "/steps=$1" --log "$folder/$1.lcm" >&2
  rm "$folder/$1.lcm"
  cat "$folder/peak"
}
few=$(peak 5000)
many=$(peak 50000)
echo "peak memory over $transport: 5000 steps $few KiB, 50000 steps $many KiB"
[ "$few" -gt 0 ] && [ $((10 * many)) -le $((11 * few)) ]
