#!/usr/bin/env bash
# cluster_test.sh FOGLINE HOW: makes a sweep of seven shards with tools/cluster/HOW (parallel or
# slurm). The merged file must have the same bytes as the file of an unsplit sweep. This must also
# hold after one shard was truncated and another shard was lost.
set -euo pipefail
cd "$(dirname "$0")/../../.."
export FOGLINE=$1
how=$2
folder=$(mktemp -d "${TMPDIR:-/tmp}/fogline-cluster-XXXXXX")
trap 'rm -rf "$folder"' EXIT
# A folder name with a space, which a shell must not split.
mkdir "$folder/my sweep"
out="$folder/my sweep/made.csv"
sweep=(scenario/paper.json --grid /arbitrator/threshold=0.2,0.5,0.8 --seeds 1:1000
       --set "/title=two  spaces")

fail() {
  echo "cluster_test: $*" >&2
  tail -n 5 "$folder"/*/*.log >&2 || true
  exit 1
}
make() {
  case $how in
    parallel) tools/cluster/parallel 7 "$out" "${sweep[@]}" ;;
    slurm) WAIT=1 tools/cluster/slurm 7 "$out" "${sweep[@]}" ;;
  esac
}
compare() {
  cmp "$folder/whole.csv" "$out" || fail "$1: other rows"
  cmp "$folder/whole.csv.json" "$out.json" || fail "$1: another description"
}

"$FOGLINE" sweep "${sweep[@]}" --out "$folder/whole.csv"
make || fail "failed"
compare "seven shards"

# One shard is truncated, as after a kill. Another shard and the merged file are missing.
truncate --size=-10000 "${out%.csv}.shard-3-of-7.csv"
rm "${out%.csv}.shard-5-of-7.csv" "$out" "$out.json"
make || fail "failed the second time"
compare "resumed shards"

# A mistake in a sweep makes the script fail, and there is no merged file.
rm "$out" "$out.json"
sweep+=(--set /fog/bias_m=1)
if make; then fail "took shards of another sweep"; fi
[ ! -e "$out" ] || fail "made a file of a failed sweep"
echo "$how: equal to the unsharded sweep"
