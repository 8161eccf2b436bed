#!/usr/bin/env bash
# mcap_memory.sh FOGLINE: checks that the export of 50,000 steps as MCAP needs at most a tenth more
# memory than the export of 5,000 steps.
set -euo pipefail
cd "$(dirname "$0")/../../.."
fogline=$1
# tools/test removes the files of killed tests in this folder.
scratch="$(dirname "$fogline")/../Testing/tmp"
mkdir -p "$scratch"
folder=$(mktemp -d "$scratch/mcap-XXXXXX")
trap 'rm -rf "$folder"' EXIT

# Prints the peak resident memory, in KiB, of the export of a log with $1 steps.
peak() {
  "$fogline" run scenario/paper.json --quiet --transport direct --set "/steps=$1" \
    --log "$folder/run.lcm" --force >&2
  /usr/bin/time --format=%M --output="$folder/peak" \
    "$fogline" export "$folder/run.lcm" --mcap "$folder/run.mcap" --force >&2
  cat "$folder/peak"
}
few=$(peak 5000)
many=$(peak 50000)
echo "peak memory: 5000 steps $few KiB, 50000 steps $many KiB"
[ "$few" -gt 0 ] && [ $((10 * many)) -le $((11 * few)) ]
