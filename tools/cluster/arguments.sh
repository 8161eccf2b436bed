# Parses the arguments N OUT.csv SCENARIO ... of the scripts in this folder. Sets $count, $out, $stem,
# $shards and FOGLINE; the arguments from SCENARIO on stay in "$@".
if [ $# -lt 3 ] || ! [[ $1 =~ ^[1-9][0-9]*$ ]]; then
  echo "usage: $0 N OUT.csv SCENARIO [options of fogline sweep]" >&2
  exit 2
fi
count=$1
out=$(realpath --canonicalize-missing "$2")
shift 2
if [ -e "$out" ]; then
  echo "$out: error: the file exists" >&2
  exit 2
fi
stem=${out%.csv}
shards=()
for ((i = 1; i <= count; ++i)); do shards+=("$stem.shard-$i-of-$count.csv"); done
mkdir -p "$(dirname "$out")"
: "${FOGLINE:=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../../build/bin/fogline")}"
export FOGLINE
