#!/usr/bin/env bash
# cluster_test.sh FOGLINE HOW: a sweep made of seven shards by HOW (parallel or slurm, of tools/cluster)
# has the bytes of the sweep that was never split, also after one of its shards was lost half-way.
set -euo pipefail
cd "$(dirname "$0")/../../.."
export FOGLINE=$1
how=$2
folder=$(mktemp -d "${TMPDIR:-/tmp}/fogline-cluster-XXXXXX")
trap 'rm -rf "$folder"' EXIT
# A folder's name that a shell must not take apart.
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

# One shard torn as by a kill, one gone, and the merged file not made yet.
truncate --size=-10000 "${out%.csv}.shard-3-of-7.csv"
rm "${out%.csv}.shard-5-of-7.csv" "$out" "$out.json"
make || fail "failed the second time"
compare "resumed shards"

# What is wrong with a sweep comes out as a failure, and no merged file.
rm "$out" "$out.json"
sweep+=(--set /fog/bias_m=1)
if make; then fail "took shards of another sweep"; fi
[ ! -e "$out" ] || fail "made a file of a failed sweep"
echo "$how: equal to the unsharded sweep"
