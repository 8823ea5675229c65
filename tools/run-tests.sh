#!/bin/sh
# run-tests.sh - every check of the project on a bare machine; CTest's own summary is the last thing printed.
#
# The sanitizer trees take the objects of tools and of most tests from the release tree, and instrument the library; their tests are
# entries of the one CTest run in the release tree at the end. With CI=true a missing OpenCL device fails, where else it is skipped.
set -eu

usage() {
  cat <<'END'
Usage: tools/run-tests.sh [--no-install] [--without-sanitizers] [-- CTEST-OPTION...]
Installs the missing packages, builds the presets `release` (warnings are errors), `asan` and `tsan`, and runs CTest.
  --no-install           install nothing; if a package is missing, say which and exit with status 2
  --without-sanitizers   leave out the sanitizer builds and their tests
  -- CTEST-OPTION...     handed to CTest, e.g. -- -R parity
END
}

install_option=
sanitizers="asan tsan"
while [ $# -gt 0 ]; do
  case $1 in
    --no-install) install_option=--no-install ;;
    --without-sanitizers) sanitizers= ;;
    --help | -h) usage; exit 0 ;;
    --) shift; break ;;
    *) echo "run-tests.sh: unknown option '$1'; see --help" >&2; exit 2 ;;
  esac
  shift
done
cd "$(dirname "$0")/.."
jobs=$(nproc)

# shellcheck disable=SC2086 # an empty option must vanish
tools/install-packages.sh $install_option build tests

printf '\n== release\n'
cmake --preset release -DTANDEM_BUILD_TESTS=ON -DTANDEM_WARNINGS_AS_ERRORS=ON "-DTANDEM_SANITIZER_TREES=$(echo "$sanitizers" | tr ' ' ';')"
cmake --build --preset release -j "$jobs"

for preset in $sanitizers; do
  printf '\n== %s\n' "$preset"
  cmake --preset "$preset" -DTANDEM_BUILD_TESTS=ON "-DTANDEM_OBJECTS_FROM=$PWD/build/release"
  cmake --build --preset "$preset" -j "$jobs" --target tandem_tests # and the programs that it runs
done

# Kernel binaries cached by an earlier run must not decide this one.
for preset in release $sanitizers; do rm -rf "build/$preset/test-cache"; done
ctest --preset release -j "$jobs" --no-tests=error "$@"
