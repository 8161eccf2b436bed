#!/usr/bin/env bash
# same_output.sh PROGRAM...: fails if the programs print different texts, or an empty text.
set -euo pipefail
expected=$("$1")
[ -n "$expected" ]
for program in "${@:2}"; do
  diff <(echo "$expected") <("$program") || { echo "$program differs from $1"; exit 1; }
done
echo "$expected"
