#!/bin/sh
# header_syntax.sh - every header of shared/ must stand on its own as strict C99, C++ and OpenCL C.
#
# The shared source is compiled by whichever OpenCL compiler a user's driver brings; what all three front ends accept
# without a warning is the portable part of the language. In C99 each header is included alone, so it must include what
# it uses. In the others, whose own headers take most of the time, all are included in one source, once from the first
# to the last and once the other way round.
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

# The CPU also builds the shared source in double precision, as the reference: compile_both LANGUAGE ROOT INCLUDES.
compile_both() {
  echo "$3" | compile "$1" "$2" || return 1
  [ "$1" = opencl ] || echo "$3" | compile "$1" "$2" -DTANDEM_REFERENCE
}

# check_each LANGUAGE ROOT HEADERS: prints how many do not stand alone.
check_each() {
  wrong=0
  for header in $3; do
    compile_both "$1" "$2" "#include \"$header\"" >&2 && continue
    wrong=$((wrong + 1))
    echo "$header: not $1 on its own" >&2
  done
  echo "$wrong"
}

# check_together LANGUAGE ROOT HEADERS: prints how many orders of all of them are wrong.
check_together() {
  wrong=0 includes=$(echo "$3" | sed 's/.*/#include "&"/')
  compile_both "$1" "$2" "$includes" >&2 || wrong=$((wrong + 1))
  compile_both "$1" "$2" "$(echo "$includes" | sort -r)" >&2 || wrong=$((wrong + 1))
  echo "$wrong"
}

# The names of cl/phases.cl stand beside all of shared/, and some of them only where a device has resident groups, which
# no device of the tests has: check_phases ROOT prints whether that is wrong.
check_phases() {
  wrong=0
  [ ! -f "$1/cl/phases.cl" ] || compile opencl "$1" -DRESIDENT_GROUPS <"$1/cl/phases.cl" >&2 || wrong=1
  echo "$wrong"
}

check() {
  case $1 in
    c99) compiler=gcc ;;
    cxx) compiler=g++ ;;
    opencl) compiler=clang ;;
    *) echo "header_syntax.sh: unknown language '$1': c99, cxx or opencl" >&2; exit 2 ;;
  esac
  command -v "$compiler" >/dev/null || { echo "$compiler is not installed: skipped"; exit 77; }
  headers=$(cd "$2" && find shared -name '*.h' | sort)
  [ "$headers" ] || { echo "$1: no headers in $2/shared" >&2; return 1; }
  case $1 in
    c99) wrong=$(check_each "$@" "$headers") ;;
    *) wrong=$(check_together "$@" "$headers") ;;
  esac
  [ "$1" != opencl ] || wrong=$((wrong + $(check_phases "$2")))
  echo "$1: $(echo "$headers" | wc -l) headers, $wrong wrong"
  [ "$wrong" -eq 0 ]
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
  mkdir -p "$planted/cl"
  printf '%s\n' '#include "shared/solve/planted.h"' '#ifdef RESIDENT_GROUPS' 'static int twice(int x) { return x; }' \
    '#endif' >"$planted/cl/phases.cl"
  expect 1 opencl 'static inline float twice(float x) { return x + x; }'
  expect 0 opencl 'static inline float thrice(float x) { return x + x + x; }'
  rm "$planted/cl/phases.cl"
  mv "$planted/shared" "$planted/empty"
  if (check c99 "$planted") >/dev/null 2>&1; then echo "self-test: a tree without headers passed"; failed=1; fi
  rm -rf "$planted"
  return $failed
}

case ${1:-} in
  --self-test) self_test "$2" ;;
  *) check "$1" "$2" ;;
esac
