# Turns CHANGELOG.md into Debian's form. Needs the variables `package` and `maintainer`.
function end_version() { if (date != "") printf "\n -- %s  %s\n\n", maintainer, date }
/^## \[[0-9]/ {
  end_version()
  match($0, /\[[^]]*/)
  version = substr($0, RSTART + 1, RLENGTH - 1)
  ("LC_ALL=C date -u -R -d " substr($0, length($0) - 9)) | getline date
  printf "%s (%s) unstable; urgency=medium\n", package, version
  next
}
date == "" { next }
/^### / { printf "\n  [ %s ]\n", substr($0, 5); next }
/^- / { printf "  * %s\n", substr($0, 3); next }
/^  / { printf "  %s\n", $0 }
END { end_version() }
