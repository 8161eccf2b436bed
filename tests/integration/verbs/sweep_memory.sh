#!/usr/bin/env bash
# sweep_memory.sh FOGLINE RUNS [options of fogline sweep]: checks that a sweep of RUNS runs needs at
# most a fifth more peak memory than a sweep of 1,000 runs.
set -euo pipefail
cd "$(dirname "$0")/../../.."
fogline=$1
runs=$2
shift 2
# tools/test removes the files of killed tests in this folder.
scratch="$(dirname "$fogline")/../Testing/tmp"
mkdir -p "$scratch"
folder=$(mktemp -d "$scratch/memory-XXXXXX")
trap 'rm -rf "$folder"' EXIT

# Prints the peak resident memory, in KiB, of a sweep of $1 runs. A sweep compares the run of each
# row with a run without traded control. With the policy `none` both runs are equal, and the sweep
# computes equal runs only once. So each row is one run.
peak() {
  /usr/bin/time --format=%M --output="$folder/peak" "$fogline" sweep scenario/paper.json "${@:2}" \
    --set /arbitrator/policy=none --seeds "1:$1" --jobs 2 --out "$folder/$1.csv" >&2
  [ "$(wc -l <"$folder/$1.csv")" -eq $(($1 + 1)) ]
  cat "$folder/peak"
}
few=$(peak 1000 "$@")
many=$(peak "$runs" "$@")
echo "peak memory: 1000 runs $few KiB, $runs runs $many KiB"
[ "$few" -gt 0 ] && [ $((5 * many)) -le $((6 * few)) ]
