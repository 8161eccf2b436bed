#!/usr/bin/env bash
# same_output.sh PROGRAM...: fails unless all programs print the same text, and that text is not
# empty.
set -euo pipefail
expected=$("$1")
[ -n "$expected" ]
for program in "${@:2}"; do
  diff <(echo "$expected") <("$program") || { echo "$program differs from $1"; exit 1; }
done
echo "$expected"
