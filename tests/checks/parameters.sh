#!/bin/sh
# parameters.sh ROOT - no function of shared/ takes more than 12 parameters; buffers that travel together are one, by a
# group of shared/argument_groups.h.
# parameters.sh --self-test DIRECTORY - plants functions in a tree there, and must name those with too many.
#
# Headers are read behind the preprocessor, so that a macro hides no parameter. Exit status 77 (skipped) without gcc.
set -eu

# FILE:LINE: of every definition with more parameters than it may have; then how many definitions were read.
too_long='
  function count_of(text,    at, depth, commas, c) {
    commas = depth = 0
    for (at = index(text, "(") + 1; depth >= 0 && at <= length(text); ++at) {
      c = substr(text, at, 1)
      if (c ~ /[(\[{]/) ++depth
      else if (c ~ /[)\]}]/) --depth
      else if (c == "," && depth == 0) ++commas
    }
    return commas + 1
  }
  function definition(text,    name, count) {
    name = substr(text, 1, index(text, "(") - 1)
    sub(/ *$/, "", name)
    sub(/.*[ *]/, "", name)
    count = count_of(text)
    ++definitions
    if (count > 12) printf "%s:%d: %s takes %d parameters; 12 are the most\n", file, start, name, count
  }
  /^# [0-9]+ "/ {
    line = $2 - 1
    file = $3
    gsub(/"/, "", file)
    sub(/^\.\//, "", file)
    is_shared = file ~ /^shared\//
    next
  }
  { ++line }
  !is_shared || /^#/ { next }
  { # outside of braces, what stands before one and has a parenthesis is the head of a function
    rest = $0
    while (match(rest, /[{};]/)) {
      c = substr(rest, RSTART, 1)
      if (depth == 0) {
        if (head !~ /[^ ]/) start = line
        head = head substr(rest, 1, RSTART - 1)
        if (c == "{" && head ~ /^[^=]*\(/ && head !~ /typedef/) definition(head)
        head = ""
      }
      if (c == "{") ++depth
      if (c == "}") --depth
      rest = substr(rest, RSTART + 1)
    }
    if (depth == 0 && rest ~ /[^ ]/) {
      if (head !~ /[^ ]/) start = line
      head = head rest " "
    }
  }
  END { printf "%d functions read\n", definitions }'

check() {
  command -v gcc > /dev/null || { echo "gcc is not installed: skipped"; exit 77; }
  code=$(cd "$1" && find shared -name '*.h' | sort | sed 's/.*/#include "&"/' | gcc -x c -std=c99 -E -I . -)
  found=$(printf '%s\n' "$code" | LC_ALL=C awk "$too_long")
  echo "$found"
  case $found in
    *"12 are the most"* | "0 functions read") return 1 ;;
  esac
}

self_test() {
  tree=$1/parameters-self-test
  rm -rf "$tree"
  mkdir -p "$tree/shared/solve"
  twelve='int a, const int *b, int c[2], void (*d)(int, int), int e, int f, int g, int h, int i, int j, int k, int l'
  printf '%s\n' 'typedef struct {' '  int a, b, c, d, e, f, g, h, i, j, k, l, m, n;' '} wide;' \
    'static const int table[] = {1, (2), 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14};' \
    "static inline int twelve($twelve)" '{' '  return a;' '}' > "$tree/shared/solve/a.h"
  status=0
  (check "$tree") > "$tree/log" || status=$?
  [ $status -ne 77 ] || { cat "$tree/log"; exit 77; }
  [ $status -eq 0 ] || { echo "self-test: 12 parameters are refused"; cat "$tree/log"; exit 1; }
  printf '%s\n' '/* int one(int a) { */' 'static inline int *thirteen(' "    $twelve," '    int m)' '{' '  return 0;' \
    '}' "#define MANY $twelve" 'static inline int hidden(int z, MANY) { return z; }' > "$tree/shared/b.h"
  ! (check "$tree") > "$tree/log" || { echo "self-test: nothing was found"; exit 1; }
  for expected in 'shared/b.h:2: thirteen takes 13 parameters' 'shared/b.h:9: hidden takes 13 parameters' \
    '3 functions read'; do
    grep -q "^$expected" "$tree/log" || { echo "self-test: not told: $expected"; cat "$tree/log"; exit 1; }
  done
  rm -rf "$tree"
  echo "self-test: functions with too many parameters are found, also where a macro holds them"
}

case ${1-} in
  --self-test) self_test "$2" ;;
  '') echo "usage: parameters.sh ROOT | --self-test DIRECTORY" >&2; exit 2 ;;
  *) check "$1" ;;
esac
