# expect.sh - a check of a command's exit status, for the shell tests beside it: `. expect.sh`, then `expect STATUS
# COMMAND...`. STATUS: a number, or `failed`, which is any from 1 to 125 but 77 (skipped): a crash or a missing program
# is not what is checked.
expect() { # STATUS COMMAND...
  wanted=$1 found=0
  shift
  said=$("$@" 2>&1) || found=$?
  [ "$wanted" = failed ] && [ "$found" -ge 1 ] && [ "$found" -le 125 ] && [ "$found" != 77 ] && return 0
  [ "$found" = "$wanted" ] || { printf '%s\n%s: status %s, not %s\n' "$said" "$*" "$found" "$wanted"; exit 1; }
}
