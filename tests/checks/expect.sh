# expect.sh - a check of a command's exit status, for the shell tests beside it: `. expect.sh`, then `expect STATUS COMMAND...`.
# STATUS: a number, or `failed`, which is any but 0 and 77 (skipped).
expect() { # STATUS COMMAND...
  wanted=$1 found=0
  shift
  said=$("$@" 2>&1) || found=$?
  [ "$wanted" = failed ] && [ "$found" != 0 ] && [ "$found" != 77 ] && return 0
  [ "$found" = "$wanted" ] || { printf '%s\n%s: status %s, not %s\n' "$said" "$*" "$found" "$wanted"; exit 1; }
}
