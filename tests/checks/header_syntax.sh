#!/bin/sh
# header_syntax.sh - every header of shared/ must stand on its own as strict C99, C++ and OpenCL C.
#
# The shared source is compiled by whichever OpenCL compiler a user's driver brings; what all three front ends accept
# without a warning is the portable part of the language. Each header is included alone, so it must include what it
# uses.
#
# Usage: header_syntax.sh c99|cxx|opencl ROOT     exit status 77 (skipped) where the compiler is not installed
#        header_syntax.sh --self-test DIR         plants a wrong header for each language and expects its refusal
set -eu

# Compiles standard input as one language: compile LANGUAGE ROOT OPTION...
compile() {
  language=$1 root=$2
  shift 2
  set -- -Wall -Wextra -Werror -Wno-unused-function -fsyntax-only -I "$root" "$@" -
  case $language in
    c99) gcc -x c -std=c99 -pedantic-errors "$@" ;;
    cxx) g++ -x c++ -std=c++20 "$@" ;;
    opencl) clang -x cl -cl-std=CL1.2 -Xclang -finclude-default-header "$@" ;;
  esac
}

# The CPU also builds the shared source in double precision, as the reference.
check_header() {
  echo "#include \"$3\"" | compile "$1" "$2" || return 1
  [ "$1" = opencl ] || echo "#include \"$3\"" | compile "$1" "$2" -DTANDEM_REFERENCE
}

check() {
  case $1 in
    c99) compiler=gcc ;;
    cxx) compiler=g++ ;;
    opencl) compiler=clang ;;
    *) echo "header_syntax.sh: unknown language '$1': c99, cxx or opencl" >&2; exit 2 ;;
  esac
  command -v "$compiler" >/dev/null || { echo "$compiler is not installed: skipped"; exit 77; }
  count=0 wrong=0
  for header in $(cd "$2" && find shared -name '*.h' | sort); do
    count=$((count + 1))
    check_header "$1" "$2" "$header" || { wrong=$((wrong + 1)); echo "$header: not $1 on its own"; }
  done
  echo "$1: $count headers, $wrong wrong"
  [ "$count" -gt 0 ] && [ "$wrong" -eq 0 ]
}

# expect STATUS LANGUAGE CODE: a tree whose one header holds CODE.
expect() {
  mkdir -p "$planted/shared/solve"
  printf '%s\n' "$3" >"$planted/shared/solve/planted.h"
  status=0
  (check "$2" "$planted") >"$planted/log" 2>&1 || status=$?
  case $status in
    77 | "$1") ;;
    *) echo "self-test: status $status instead of $1 for $2: $3"; cat "$planted/log"; failed=1 ;;
  esac
}

self_test() {
  planted=$1/header-syntax-self-test failed=0
  rm -rf "$planted"
  for language in c99 cxx opencl; do
    expect 0 "$language" 'static inline float twice(float x) { return x + x; }'
    expect 1 "$language" 'static inline vec3 nowhere(vec3 x) { return x; }'
    expect 1 "$language" '#include "shared/absent.h"'
  done
  expect 1 c99 'static inline int f(void) { return 0b11; }'
  expect 1 c99 'static inline int f(int n) { int a[n]; a[0] = ({ n; }); return a[0]; }'
  expect 1 cxx 'static inline int f(int new) { return new; }'
  expect 1 opencl 'static inline int f(int (*g)(int)) { return g(1); }'
  mv "$planted/shared" "$planted/empty"
  if (check c99 "$planted") >/dev/null 2>&1; then echo "self-test: a tree without headers passed"; failed=1; fi
  rm -rf "$planted"
  return $failed
}

case ${1:-} in
  --self-test) self_test "$2" ;;
  *) check "$1" "$2" ;;
esac
