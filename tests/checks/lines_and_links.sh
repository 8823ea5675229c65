#!/bin/sh
# lines_and_links.sh ROOT - no line of a source or of a document's text is longer than 120 columns, and no link of a
#                           document leads nowhere.
# lines_and_links.sh --self-test DIRECTORY - plants one of each in a tree there, and must see them.
#
# Columns are bytes here. Tables, code and notes to programs (<!-- -->) of documents may be wider.
set -eu

check() {
  root=$1
  sources=$(cd "$root" && find CMakeLists.txt cmake cl host minicl shared tests tools -type f \
    \( -name '*.h' -o -name '*.c' -o -name '*.cpp' -o -name '*.cl' -o -name '*.def' -o -name '*.inc' \
    -o -name '*.cmake' -o -name 'CMakeLists.txt' -o -name '*.sh' \) | sort)
  documents=$(cd "$root" && find . -name build -prune -o -name '*.md' -print | sort)
  faults=$(cd "$root" && printf '%s\n' "$sources" "$documents" | LC_ALL=C xargs awk '
    FNR == 1 { document = FILENAME ~ /[.]md$/; code = 0 }
    document && /^ *```/ { code = !code }
    document && (code || /^ *([|]|<!--)/) { next }
    length($0) > 120 { printf "%s:%d: %d columns; 120 are the most\n", FILENAME, FNR, length($0) }')
  dead=$(dead_links "$root")
  [ -z "$faults" ] || echo "$faults"
  [ -z "$dead" ] || echo "$dead"
  echo "$(printf '%s\n' "$sources" "$documents" | wc -l) sources read"
  [ -z "$faults$dead" ]
}

# Links to files of the tree, without their #place; code, in backticks or in a block, is no link.
dead_links() {
  find "$1" -name build -prune -o -name '*.md' -print | sort | while read -r document; do
    sed -e '/^```/,/^```/d' -e 's/`[^`]*`//g' "$document" | grep -o ']([^)#]*' | cut -c3- | while read -r target; do
      case $target in '' | *://* | mailto:*) continue ;; esac
      [ -e "$(dirname "$document")/$target" ] || echo "$document: links to $target, which is not there"
    done
  done
}

self_test() {
  tree=$1/lines-and-links-self-test
  rm -rf "$tree"
  mkdir -p "$tree/cmake" "$tree/cl" "$tree/host" "$tree/minicl" "$tree/shared" "$tree/tests" "$tree/tools"
  : > "$tree/CMakeLists.txt"
  printf '[there](host/a.h#place) [elsewhere](https://example.org) `[no](link)`\n' > "$tree/README.md"
  printf '%0120d\n' 0 > "$tree/host/a.h"
  printf '| %0121d |\n```\n%0121d\n```\n' 0 0 > "$tree/host/wide.md"
  check "$tree" > "$tree/log" || { echo "self-test: 120 columns and a good link are refused"; cat "$tree/log"; exit 1; }
  printf '\n%0121d\n' 0 > "$tree/host/b.def"
  printf '[gone](host/gone.h)\n%0121d\n' 0 > "$tree/host/page.md"
  ! check "$tree" > "$tree/log" || { echo "self-test: nothing was found"; exit 1; }
  grep -q 'host/b.def:2: 121 columns' "$tree/log" || { echo "self-test: the long line is not named"; exit 1; }
  grep -q 'host/page.md:2: 121 columns' "$tree/log" || { echo "self-test: the long text is not named"; exit 1; }
  grep -q 'links to host/gone.h' "$tree/log" || { echo "self-test: the dead link is not named"; exit 1; }
  rm -rf "$tree"
  echo "self-test: a long line and a dead link are found"
}

case ${1-} in
  --self-test) self_test "$2" ;;
  '') echo "usage: lines_and_links.sh ROOT | --self-test DIRECTORY" >&2; exit 2 ;;
  *) check "$1" ;;
esac
