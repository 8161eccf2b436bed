# Turns CHANGELOG.md into Debian's form. Needs the variables `package` and `maintainer`.
# Prints the item in lines of at most 80 characters.
function end_item(  words, count, line, i) {
  count = split(item, words)
  if (count == 0) return
  line = "  *"
  for (i = 1; i <= count; ++i) {
    if (length(line) + 1 + length(words[i]) > 80) { print line; line = "   " }
    line = line " " words[i]
  }
  print line
  item = ""
}
function end_version() { end_item(); if (date != "") printf "\n -- %s  %s\n\n", maintainer, date }
/^## \[[0-9]/ {
  end_version()
  match($0, /\[[^]]*/)
  version = substr($0, RSTART + 1, RLENGTH - 1)
  ("LC_ALL=C date -u -R -d " substr($0, length($0) - 9)) | getline date
  printf "%s (%s) unstable; urgency=medium\n", package, version
  next
}
date == "" { next }
/^### / { end_item(); printf "\n  [ %s ]\n", substr($0, 5); next }
/^- / { end_item(); item = substr($0, 3); next }
/^  / { item = item $0 }
END { end_version() }
