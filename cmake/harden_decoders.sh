#!/bin/sh
# harden_decoders.sh HEADER...: adds missing checks to the decoders that lcm-gen has written.
#
# LCM's decoders check the lengths in a message too late or only in part, and do not overwrite every
# part of an object:
#
# 1. An array is allocated before its length is checked: a message of 100 bytes can make the decoder
#    allocate 16 GB. The added check refuses a length below 0 or above the number of bytes left in
#    the message.
# 2. A string may lack its terminator, have the length 0 or less, or have a zero byte before its
#    end. If a message with such a string were encoded again, its bytes would differ. The added
#    check refuses all three cases.
# 3. If an array of numbers is empty in the message, the decoder does not change the object's array.
#    Then the object would keep the elements of an earlier message. The array is cleared first.
#
# The script fails if it cannot add all these checks. In this case, the installed lcm-gen writes
# other code than Debian 12's lcm-gen. The script works for any message type.
set -eu

# count PATTERN FILE: prints how many lines of FILE match PATTERN
count() { grep -cE -- "$1" "$2" || true; }
fail() {
  echo "harden_decoders.sh: error: $1: $2: this lcm-gen writes code that the script does not know" >&2
  exit 1
}

for header in "$@"; do
  arrays=$(count 'this->[a-z0-9_]+[.]resize[(]' "$header")
  strings=$(count 'const char[*][)]buf' "$header")
  numbers=$(count 'std::vector< (double|float|u?int[0-9]+_t) > ' "$header")

  sed -i -E 's/^( *)(this->[a-z0-9_]+)[.]resize[(](this->[a-z0-9_]+)[)];/\1if (\3 < 0 || \3 > maxlen) return -1;\n\1\2.resize(static_cast<std::size_t>(\3));/' "$header"
  # lcm-gen names the length of a string __NAME_len__. The length of a string in an array is
  # __elem_len, without underscores at the end.
  sed -i -E 's/if[(](__[a-z0-9_]+_len(__)?) > maxlen - pos[)] return -1;/if(\1 < 1 || \1 > maxlen - pos) return -1;\n    if(memchr((const char*)buf + offset + pos, 0, \1) != (const char*)buf + offset + pos + \1 - 1) return -1;/' "$header"
  sed -i -z -E 's/if[(](this->[a-z0-9_]+)[)] [{]\n( *if [(][^\n]*\n *)(this->[a-z0-9_]+)[.]resize/\3.clear();\n    if(\1) {\n\2\3.resize/g' "$header"

  [ "$(count '< 0 [|][|] this->[a-z0-9_]+ > maxlen[)] return -1;' "$header")" -eq "$arrays" ] ||
    fail "$header" "an array without a check of its length"
  [ "$(count 'if[(]memchr[(]' "$header")" -eq "$strings" ] ||
    fail "$header" "a string without a check of its end"
  [ "$(count 'this->[a-z0-9_]+[.]clear[(][)];' "$header")" -eq "$numbers" ] ||
    fail "$header" "an array that keeps its elements"
done
