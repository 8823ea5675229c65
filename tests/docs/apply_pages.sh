#!/bin/sh
# apply_pages.sh ROOT FOLDER RUNNER [CMAKE-OPTION...] - the pages docs/add-a-*.md, done as they say: applied to a copy
# of the tree in FOLDER, built, and run. RUNNER is tests/main.cpp, compiled or not.
# apply_pages.sh --self-test FOLDER - pages that do not fit their tree are refused in one line.
#
# A comment before a block of code, which a reader of the page does not see, says what its prose says: where it goes.
#
#   <!-- file: PATH new -->                  the block is a file that is not there yet
#   <!-- file: PATH after: TEXT -->          it stands after the one line of that file that holds TEXT,
#   <!-- file: PATH before: TEXT -->         before it,
#   <!-- file: PATH instead of: TEXT -->     or in its place
#   <!-- run -->                             each line is a command, run in the tree, that must end with status 0
#
# Several comments before one block put it into several files. A block marked as c or cpp must have one. All pages are
# applied to one copy, in their order, so that it is built once. In a second run only what has changed is built.
set -eu

# apply_page PAGE TREE COMMANDS: changes TREE, and adds the page's commands to a file, one a line.
apply_page() {
  awk -v page="$1" -v tree="$2" -v commands="$3" '
    function fail(line, why) { printf "%s:%d: %s\n", page, line, why; failed = 1; exit 1 }
    function read_lines(path) {
      count = 0
      while ((getline text < path) > 0) lines[++count] = text
      close(path)
    }
    function lines_with(text,   found, k) {
      for (k = 1; k <= count; ++k) if (index(lines[k], text)) { ++found; place = k }
      return found + 0
    }
    function put(target,   path, k) {
      path = tree "/" name[target]
      read_lines(path)
      if (how[target] == "new") {
        if (count) fail(place_of[target], name[target] " is there already")
        system("mkdir -p \"$(dirname \"" path "\")\"")
        printf "%s", block > path
        close(path)
        return
      }
      if (!count) fail(place_of[target], name[target] " is not there")
      k = lines_with(anchor[target])
      if (k != 1) fail(place_of[target], k " lines of " name[target] " hold \"" anchor[target] "\"; one must")
      for (k = 1; k <= count; ++k) {
        if (k == place && how[target] != "after") printf "%s", block > path
        if (k != place || how[target] != "instead of") print lines[k] > path
        if (k == place && how[target] == "after") printf "%s", block > path
      }
      close(path)
    }
    function add_target(line) {
      sub(/^<!-- file: /, "", line)
      if (!sub(/ -->$/, "", line)) fail(NR, "the comment must end with its line")
      ++targets
      place_of[targets] = NR
      name[targets] = line
      sub(/ .*/, "", name[targets])
      sub(/^[^ ]* /, "", line)
      if (line == "new") { how[targets] = "new"; return }
      if (!match(line, /^(after|before|instead of): ./))
        fail(NR, "new, after:, before: or instead of: must follow the path")
      how[targets] = substr(line, 1, index(line, ":") - 1)
      anchor[targets] = substr(line, RLENGTH)
    }
    inside && /^```/ {
      for (k = 1; k <= targets; ++k) put(k)
      inside = targets = run = 0
      next
    }
    inside {
      block = block $0 "\n"
      if (run) print page ":" NR "\t" $0 >> commands
      next
    }
    /^<!-- file: / { add_target($0); next }
    /^<!-- run -->$/ { run = 1; next }
    /^```/ {
      if (/^```c/ && !targets) fail(NR, "code without a comment that says which file it goes to")
      inside = 1
      block = ""
      next
    }
    targets || run { fail(NR, "no block follows the comment before") }
    END { if (!failed && inside) fail(NR, "the last block does not end") }' "$1"
}

# What git would track, without its help: a copy of the sources need not have it.
copy_tree() {
  rm -rf "$2"
  mkdir -p "$2"
  (cd "$1" && tar -cf - CMakeLists.txt CONTRIBUTING.md LICENSE README.md cl cmake docs host \
    minicl shared tests tools) | (cd "$2" && tar -xf -)
}

# Files that are the same keep their time, so that nothing is compiled again for them.
take_changes() {
  mkdir -p "$2"
  (cd "$1" && find . -type f) | while read -r file; do
    cmp -s "$1/$file" "$2/$file" && continue
    mkdir -p "$(dirname "$2/$file")"
    cp "$1/$file" "$2/$file"
  done
  (cd "$2" && find . -type f) | while read -r file; do [ -e "$1/$file" ] || rm "$2/$file"; done
}

new_tests() { sed -n 's/^<!-- file: \(.*_test[.]cpp\) new -->$/\1/p' "$@" | tr '\n' ';'; }

run_commands() {
  while IFS='	' read -r place command; do
    echo "$place: $command"
    (cd "$1" && sh -c "$command") >"$1.log" 2>&1 </dev/null && continue
    cat "$1.log"
    echo "$place: failed: $command"
    return 1
  done
}

apply_and_run() {
  root=$1 folder=$2 runner=$3
  shift 3
  pages=$(cd "$root" && echo docs/add-a-*.md)
  copy_tree "$root" "$folder/applied"
  : >"$folder/commands"
  for page in $pages; do (cd "$root" && apply_page "$page" "$folder/applied" "$folder/commands"); done
  tests=$(cd "$root" && new_tests $pages)
  echo 'include(tests/docs/programs.cmake)' >>"$folder/applied/CMakeLists.txt"
  "$folder/applied/tests/checks/lines_and_links.sh" "$folder/applied"
  take_changes "$folder/applied" "$folder/tree"
  cmake -S "$folder/tree" -B "$folder/build" -G Ninja -DCMAKE_BUILD_TYPE=Debug "-DCMAKE_CXX_FLAGS_DEBUG=-O0 -g0" \
    "-DCMAKE_C_FLAGS_DEBUG=-O0 -g0" -DTANDEM_PORTABLE_KERNELS_ONLY=ON -DTANDEM_SHARED_LIBRARIES=OFF \
    -DTANDEM_PRECOMPILE_HEADERS=ON -DTANDEM_JOIN_SOURCES=ON -DTANDEM_BUILD_TESTS=OFF -DTANDEM_WARNINGS_AS_ERRORS=ON \
    "-DTANDEM_PAGE_TESTS=$tests" "-DTANDEM_TEST_RUNNER=$runner" "$@" >"$folder/configured" || {
    cat "$folder/configured"
    exit 1
  }
  cmake --build "$folder/build" --target page_tests page_command
  mkdir -p "$folder/tree/build/release/bin"
  ln -sf "$folder/build/bin/page_command" "$folder/tree/build/release/bin/tandem" # as the pages call it
  (cd "$folder" && build/bin/page_tests)
  run_commands "$folder/tree" <"$folder/commands"
}

# expect WHY PAGE-TEXT: a page of that text is refused with one line that holds WHY; none where it must be taken.
expect() {
  rm -rf "$planted/tree" && mkdir -p "$planted/tree/host"
  printf 'first\nsecond\ntwice\ntwice\n' >"$planted/tree/host/a.h"
  printf "$2" >"$planted/page.md"
  status=0
  apply_page "$planted/page.md" "$planted/tree" "$planted/commands" >"$planted/log" 2>&1 || status=$?
  if [ -z "$1" ] && [ "$status" -eq 0 ] && [ ! -s "$planted/log" ]; then return; fi
  if [ -n "$1" ] && [ "$status" -ne 0 ] && [ "$(wc -l <"$planted/log")" -eq 1 ] && grep -qF "$1" "$planted/log"; then
    return
  fi
  echo "self-test: status $status, where '$1' was expected:"
  cat "$planted/log"
  failed=1
}

expect_file() {
  [ "$(tr '\n' ' ' <"$planted/tree/$1")" = "$2" ] || { echo "self-test: $1 holds:"; cat "$planted/tree/$1"; failed=1; }
}

self_test() {
  planted=$1/apply-pages-self-test failed=0
  mkdir -p "$planted"
  block='```c\nadded\n```\n'
  expect '' "text\n<!-- file: host/a.h after: first -->\n<!-- file: host/b/c.h new -->\n$block"
  expect_file host/a.h 'first added second twice twice '
  expect_file host/b/c.h 'added '
  expect '' "<!-- file: host/a.h before: first -->\n$block"
  expect_file host/a.h 'added first second twice twice '
  expect '' "<!-- file: host/a.h instead of: second -->\n$block"
  expect_file host/a.h 'first added twice twice '
  rm -f "$planted/commands"
  expect '' '<!-- run -->\n```\ntrue\n```\n'
  run_commands "$planted/tree" <"$planted/commands" >/dev/null || { echo "self-test: 'true' is refused"; failed=1; }
  rm -f "$planted/commands"
  expect '' '<!-- run -->\n```\nfalse\n```\n'
  ! run_commands "$planted/tree" <"$planted/commands" >/dev/null || { echo "self-test: 'false' passes"; failed=1; }
  expect 'page.md:1: 0 lines of host/a.h hold "third"' "<!-- file: host/a.h after: third -->\n$block"
  expect 'page.md:1: 2 lines of host/a.h hold "twice"' "<!-- file: host/a.h after: twice -->\n$block"
  expect 'page.md:1: host/b.h is not there' "<!-- file: host/b.h after: first -->\n$block"
  expect 'page.md:1: host/a.h is there already' "<!-- file: host/a.h new -->\n$block"
  expect 'page.md:1: new, after:' "<!-- file: host/a.h behind: first -->\n$block"
  expect 'page.md:1: the comment must end' "<!-- file: host/a.h after: first --> and\n$block"
  expect 'page.md:1: code without a comment' "$block"
  expect 'page.md:2: no block follows' "<!-- file: host/a.h after: first -->\ntext\n$block"
  expect 'page.md:2: the last block does not end' '```\ntext\n'
  [ "$failed" -eq 0 ] || exit 1
  echo "self-test: pages that do not fit are refused, each in one line"
}

case ${1-} in
  --self-test) self_test "$2" ;;
  '' | -*) sed -n '2,4s/^# //p' "$0" >&2; exit 2 ;;
  *) apply_and_run "$@" ;;
esac
