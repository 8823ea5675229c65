#!/bin/sh
# readme_commands.sh PAGE BIN FOLDER - runs each command `$ tandem ...` of a page, with BIN in the path and FOLDER as
# the working folder: it must end with status 0 and print what the page shows.
# readme_commands.sh --self-test FOLDER - pages that show something else are refused.
#
# The lines that a page shows must come in their order; others may stand between them. They are equal to the letter, but
# for what is no result:
#   - times: numbers before "ms", and all numbers with a decimal point that `bench` prints;
#   - of `devices`, what it finds here: all its numbers, and the name of an OpenCL device;
#   - how many blanks stand between two words, since numbers are as wide as they are.
# Sizes, counts and hashes are results. A command that is about an OpenCL device is left out where there is none.
set -eu

# Commands go to FOLDER/1.command ..., without the comments behind them; what is shown of each to FOLDER/1.shown ...
split_page() {
  awk -v folder="$2" '
    /^```/ { inside = !inside; shown = ""; next }
    !inside { next }
    /^\$ / {
      shown = ""
      if ($2 != "tandem") next
      shown = folder "/" ++count ".shown"
      printf "" > shown
      sub(/^\$ /, "")
      sub(/ +# .*/, "")
      print > (folder "/" count ".command")
      next
    }
    shown != "" && !/^ *[.][.][.]$/ { print > shown }
  ' "$1"
}

canonical() {
  case $1 in
    "tandem devices"*) sed -E 's/[0-9]+(, [0-9]+)*/N/g; s/^(cl:[^ ]*) .*/\1/' ;;
    "tandem bench"*) sed -E 's/[0-9]+[.][0-9]+/TIME/g' ;;
    *) sed -E 's/[0-9.]+( to [0-9.]+)? ms/TIME ms/g' ;;
  esac | sed -E 's/ +/ /g; s/ $//'
}

# The first line of a file that does not come in another, behind those before it.
missing_line() {
  awk 'FILENAME == ARGV[1] { printed[++count] = $0; next }
    { while (++at <= count && printed[at] != $0);
      if (at > count) { print; exit } }' "$2" "$1"
}

is_about_device() { cat "$1.command" "$1.shown" | grep -q 'cl:'; }

# run_command NUMBER PAGE: 1 where the page is wrong.
run_command() {
  command=$(cat "$1.command")
  echo "\$ $command"
  ending=0
  sh -c "$command" >"$1.printed" 2>&1 </dev/null || ending=$?
  [ "$ending" -eq 0 ] || { cat "$1.printed"; echo "$2: ends with status $ending: $command"; return 1; }
  canonical "$command" <"$1.shown" >"$1.shown.canonical"
  canonical "$command" <"$1.printed" >"$1.printed.canonical"
  missing=$(missing_line "$1.shown.canonical" "$1.printed.canonical")
  [ -s "$1.shown" ] && [ -z "$missing" ] && return
  cat "$1.printed"
  echo "$2: '$command' does not print, or not in this place: $missing"
  return 1
}

run_page() {
  page=$1
  PATH=$2:$PATH
  rm -rf "$3"
  mkdir -p "$3"
  split_page "$page" "$3"
  cd "$3"
  [ -e 1.command ] || { echo "$page: no command"; return 1; }
  left_out=
  has_device=$(tandem devices | grep '^cl:' || true)
  number=0
  while number=$((number + 1)) && [ -e "$number.command" ]; do
    if [ -z "$has_device" ] && is_about_device "$number"; then
      left_out="$left_out; $(cat "$number.command")"
      continue
    fi
    run_command "$number" "$page" || return 1
  done
  [ "$left_out" ] || return 0
  echo "skipped: no OpenCL device for$left_out"
  [ "${CI-}" != true ] || return 1
  return 77
}

# expect STATUS SHOWN...: the page of a command `tandem run`, of which the planted one prints three lines.
expect() {
  wanted=$1
  shift
  { echo '```'; echo '$ tandem run it  # and so on'; printf '%s\n' "$@"; echo '```'; } >"$planted/page.md"
  status=0
  (run_page "$planted/page.md" "$planted/bin" "$planted/folder") >"$planted/log" 2>&1 || status=$?
  [ "$status" -eq "$wanted" ] && return
  echo "self-test: status $status, not $wanted, of a page that shows:"
  cat "$planted/page.md" "$planted/log"
  failed=1
}

self_test() {
  planted=$1/readme-commands-self-test failed=
  mkdir -p "$planted/bin"
  cat >"$planted/bin/tandem" <<'END'
#!/bin/sh
[ "$*" = "run it" ] || exit 0
echo 'first  2.5 to 3 ms, 7 pairs'
echo 'second 1.5 MiB'
echo 'third'
END
  chmod +x "$planted/bin/tandem"
  expect 0 'first 1 to 2.25 ms, 7 pairs' '  ...' 'third'
  expect 0 'second 1.5 MiB'
  expect 1 'first 2.5 to 3 ms, 8 pairs'
  expect 1 'second 1.6 MiB'
  expect 1 'third' 'second 1.5 MiB'
  expect 1 'third' 'third'
  expect 1 'fourth'
  expect 1 '...'
  expect 1 'third' '$ tandem fails' 'third'
  CI=true expect 1 'first 2.5 to 3 ms, 7 pairs' '$ tandem run cl:0.0' 'third'
  CI='' expect 77 'first 2.5 to 3 ms, 7 pairs' '$ tandem run cl:0.0' 'third'
  [ -z "$failed" ] || exit 1
  echo "self-test: pages that show what is not printed are refused"
}

case ${1-} in
  --self-test) self_test "$2" ;;
  '' | -*) sed -n '2,4s/^# //p' "$0" >&2; exit 2 ;;
  *) run_page "$@" ;;
esac
