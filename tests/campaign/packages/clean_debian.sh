#!/usr/bin/env bash
# clean_debian.sh BUILD [MIRROR]: makes the packages of a build, and installs them in a minimal
# Debian 12. Makes the paper's run there as an ordinary user, also from Python. Checks the manual,
# the completion and the systemd unit. Then it removes the packages. Needs root and debootstrap.
# Exit codes: 0 if everything is correct, 1 if something is wrong, 4 if this machine cannot make a
# Debian system.
set -euo pipefail
cd "$(dirname "$0")/../../.."
build=$(realpath "$1")
mirror=${2:-http://deb.debian.org/debian}
if [ "$(id -u)" -ne 0 ] || ! command -v debootstrap >/dev/null; then
  echo "this machine lacks root or debootstrap"
  [ -z "${FOGLINE_TEST_NO_SKIP:-}" ] || exit 1
  exit 4
fi
tree=$(mktemp -d /var/tmp/fogline-packages-XXXXXX)
chmod 755 "$tree"  # other users of the new system need to enter its root folder
trap 'rm -rf --one-file-system "$tree"' EXIT
# shellcheck source=tests/support/debian_tree.sh
source tests/support/debian_tree.sh
fail() { echo "FAILED: $*"; exit 1; }

cpack --config "$build/CPackConfig.cmake" -B "$tree/packages" >"$tree.log" 2>&1 || { cat "$tree.log"; exit 1; }
rm "$tree.log"
make_debian "$mirror" ca-certificates >/dev/null
trust_own_certificates >/dev/null

# Files in this folder could make dpkg leave out the manual pages, as in many minimal Debian
# systems.
rm -f "$tree"/etc/dpkg/dpkg.cfg.d/*
install="apt-get install -qq -y --no-install-recommends"
inside / "set -e; export DEBIAN_FRONTEND=noninteractive; apt-get update -qq
  $install man-db bash-completion systemd python3 >/dev/null 2>&1
  $install ./packages/fogline_*.deb ./packages/python3-fogline-lab_*.deb >/dev/null 2>&1
  useradd --create-home driver"
inside / "dpkg -L fogline python3-fogline-lab | grep /" >"$tree/files"

want=$("$build/bin/fogline" run scenario/paper.json --transport direct --json | sed -n 's/.*"digest": "\(.*\)".*/\1/p')
[ ${#want} -eq 64 ] || fail "the build has no digest"
have=$(inside /home/driver "runuser -u driver -- fogline run /usr/share/fogline/scenario/paper.json --json" |
  sed -n 's/.*"digest": "\(.*\)".*/\1/p')
[ "$have" = "$want" ] || fail "digest $have of the installed package, $want of the build"
echo "fogline run: $have"
have=$(inside /home/driver "runuser -u driver -- python3 -c '
import fogline_lab as fl
print(fl.run(\"/usr/share/fogline/scenario/paper.json\", transport=\"direct\").digest)'")
[ "$have" = "$want" ] || fail "digest $have of the run from Python, $want of the build"
echo "fogline_lab: $have"

inside / "MANWIDTH=80 man fogline-run" >"$tree/manual" || fail "there is no man fogline-run"
grep -q -- '--transport' "$tree/manual" || fail "man fogline-run does not name --transport"
for program in "$tree"/usr/bin/fogline*; do
  inside / "man -w 1 $(basename "$program")" >/dev/null || fail "$program has no manual"
done

completed=$(inside / 'source /usr/share/bash-completion/bash_completion; _completion_loader fogline
  COMP_LINE="fogline run scenario/paper.json --set /arb" COMP_POINT=${#COMP_LINE}
  COMP_WORDS=($COMP_LINE) COMP_CWORD=4 COMP_TYPE=9
  _fogline fogline /arb --set 2>/dev/null; echo "${COMPREPLY[@]}"')
[ "$completed" = /arbitrator/ ] || fail "--set /arb is completed to \"$completed\""
echo "completion: --set /arb is $completed"

inside / "systemd-analyze verify fogline@fusion.service" >"$tree/verified" 2>&1 ||
  { cat "$tree/verified"; fail "systemd-analyze verify"; }
if grep fogline "$tree/verified"; then fail "systemd-analyze has a remark"; fi
echo "systemd-analyze verify: no remark"

inside / "DEBIAN_FRONTEND=noninteractive apt-get purge -qq -y fogline python3-fogline-lab >/dev/null 2>&1"
left=""
while read -r file; do
  [ -e "$tree$file" ] || [ -L "$tree$file" ] || continue
  inside / "dpkg -S '$file' >/dev/null 2>&1" || left+=" $file"
done <"$tree/files"
left+=$(inside / "find / -xdev -path /packages -prune -o -path /home -prune -o -path /var/cache -prune -o \
  -path /var/lib/apt -prune -o -path /var/log -prune -o -path /proc -prune -o -path /sys -prune -o -name '*fogline*' -print")
[ -z "$left" ] || fail "left after the removal: $left"
echo "nothing is left after the removal"
