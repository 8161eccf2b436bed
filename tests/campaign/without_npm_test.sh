#!/usr/bin/env bash
# without_npm_test.sh: builds a copy of the tree that has no packages of npm. The programs must
# build and run. The verbs that need a page must say what is missing.
set -euo pipefail
cd "$(dirname "$0")/../.."
folder=$(mktemp -d "${TMPDIR:-/tmp}/fogline-without-npm-XXXXXX")
trap 'rm -rf "$folder"' EXIT
tar --create --exclude=./build --exclude=./node_modules --exclude=./.git --exclude=./logs . |
  tar --extract --directory "$folder"
cd "$folder"

fail() {
  echo "without_npm_test: $*" >&2
  exit 1
}
# expect CODE TEXT COMMAND...: the command ends with the code CODE, and its stderr contains TEXT.
expect() {
  local code=0 said
  said=$("${@:3}" 2>&1 >/dev/null) || code=$?
  [ "$code" -eq "$1" ] || fail "${*:3} ends with $code: $said"
  [[ "$said" == *"$2"* ]] || fail "${*:3} says: $said"
}

cmake -S . -B build -G Ninja -DFOGLINE_TESTS=OFF >configured
grep -q "fogline view will have no page" configured || fail "cmake does not say that pages are missing"
grep -q "fogline report and fogline study will have no pages" configured || fail "nor that of the report"
ninja -C build fogline_demo >built || { tail -n 20 built; fail "does not build"; }

fogline=build/bin/fogline
"$fogline" run scenario/paper.json --quiet --log run.lcm >/dev/null || fail "no run"
"$fogline" metrics run.lcm >/dev/null || fail "no measures"
missing="packages of npm were missing when it was configured; install and build: tools/setup run"
expect 3 "this build has no page, because $missing" "$fogline" view run.lcm
expect 3 "this build has no charts, because $missing" "$fogline" report run.lcm
# fogline view still serves other programs: only its page is missing.
exec 3< <(exec "$fogline" view --no-browser --port 0 2>said)
view=$!
read -r -t 60 address <&3 || fail "fogline view --no-browser prints no address: $(cat said)"
kill -INT "$view"
wait "$view" || fail "fogline view --no-browser ends with $?: $(cat said)"
[[ "$address" == http://127.0.0.1:* ]] || fail "the address is $address"
grep -q "warning: this build has no page" said || fail "no warning: $(cat said)"
