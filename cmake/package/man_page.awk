# Corrects the page that help2man makes of a help text of CLI11. Examples keep their lines.
# Arguments, verbs and exit codes have sections of their own.
function end_example() { if (example) print ".fi"; example = 0 }
$0 == ".SS \"Positionals:\"" { print ".SH ARGUMENTS"; next }
$0 == ".SS \"Subcommands:\"" { print ".SH VERBS"; next }
$0 == ".IP" { end_example(); print; print ".nf"; example = 1; next }
$0 == ".HP" && example { continued = 1; next }  # the second line of a command
/^\./ { end_example() }
continued { printf "    "; continued = 0 }
/^Exit codes: / { print ".SH EXIT STATUS"; sub(/^Exit codes: /, ""); print; notes = 1; next }
notes && $0 == ".PP" { print ".SH NOTES"; notes = 0; next }
{ print }
END { end_example() }
