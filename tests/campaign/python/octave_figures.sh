#!/usr/bin/env bash
# Octave draws the paper's figures from two MAT-files. Each figure has the curves of its runs.
# usage: octave_figures.sh FOGLINE
set -euo pipefail
fogline=$1
root=$(cd "$(dirname "$0")/../../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

"$fogline" run "$root/scenario/paper.json" --transport direct --log with.lcm >run.txt
"$fogline" run "$root/scenario/paper.json" --set /arbitrator/policy=none --transport direct \
  --log without.lcm >run.txt
for run in with without; do "$fogline" export $run.lcm --out $run.mat >export.txt; done

# draw RUNS FOLDER: draws the figures of RUNS into FOLDER with tools/export/paper_figures.m.
draw() {
  octave-cli --norc --path "$root/tools/export" --eval "paper_figures($1, '$2');" 2>err.txt || {
    cat err.txt >&2
    exit 1
  }
}
draw "{'with.mat', 'without.mat'}" both
draw "'with.mat'" one

# Octave draws with gnuplot, which makes each curve a path with hundreds of points. A legend has a
# text for each curve.
for figure in speeds gaps conflict accelerations; do
  for kind in both one; do
    curves=$(tr -d '\n' <$kind/$figure.svg | grep -oE "<path[^>]* d='M[^']{1500,}'" | wc -l)
    echo "$kind/$figure.svg: $curves curves"
    # The figure gaps has two curves for each run. The other figures have three.
    wanted=$([ $figure = gaps ] && echo 2 || echo 3)
    [ "$curves" -ge $([ $kind = both ] && echo $((2 * wanted)) || echo "$wanted") ] || exit 1
  done
  ! cmp -s both/$figure.svg one/$figure.svg
done
grep -q 'following car' one/speeds.svg
grep -q 'Degree of Conflict' both/conflict.svg
