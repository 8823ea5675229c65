#!/bin/sh
# run-tests.sh - every check of the project on a bare machine; CTest's own summary is the last thing printed.
#
# The sanitizer trees take the objects of tools and of most tests from the release tree, and instrument the library; the
# trees of other compilers take what computes nothing. The tests of all trees are entries of the one CTest run in the
# release tree at the end. With CI=true a missing OpenCL device fails, and so does a missing tree that was not left out;
# otherwise they are skipped.
set -eu

usage() {
  cat <<'END'
Usage: tools/run-tests.sh [--quick] [--no-install] [--without-sanitizers] [--without-compilers] [-- CTEST-OPTION...]
Installs the missing packages, builds the presets `release` (warnings are errors), `asan`, `tsan` and `golden-*`, and
runs CTest.
  --quick                for daily work: the release tree alone, and of its tests the unit tests and the checks that do
                         not wait for an OpenCL compiler; a few minutes, most of them for what has to be compiled
  --no-install           install nothing; if a package is missing, say which and exit with status 2
  --without-sanitizers   leave out the sanitizer builds and their tests
  --without-compilers    leave out the trees that compare hashes between compilers, their options and processors
  -- CTEST-OPTION...     handed to CTest, e.g. -- -R parity
END
}

install_option=
quick=
sanitizers="asan tsan"
export TANDEM_WITHOUT_COMPILERS=
all_compilers="golden-o0 golden-o3 golden-clang golden-aarch64"
compilers=$all_compilers
while [ $# -gt 0 ]; do
  case $1 in
    --quick) quick=yes sanitizers= compilers= TANDEM_WITHOUT_COMPILERS=true ;;
    --no-install) install_option=--no-install ;;
    --without-sanitizers) sanitizers= ;;
    --without-compilers) compilers= TANDEM_WITHOUT_COMPILERS=true ;;
    --help | -h) usage; exit 0 ;;
    --) shift; break ;;
    *) echo "run-tests.sh: unknown option '$1'; see --help" >&2; exit 2 ;;
  esac
  shift
done
cd "$(dirname "$0")/.."
jobs=$(nproc)

# shellcheck disable=SC2086 # an empty option must vanish
tools/install-packages.sh $install_option build tests ${compilers:+aarch64}

# These trees need a compiler, and for another processor its libraries; both are optional packages.
is_possible() {
  case $1 in
    golden-clang) command -v clang++ >/dev/null ;;
    golden-aarch64)
      for package in $(tools/install-packages.sh --list aarch64); do
        case $(dpkg-query -W -f='${db:Status-Abbrev}' "$package" 2>/dev/null) in ii*) ;; *) return 1 ;; esac
      done
      ;;
  esac
}

for preset in $all_compilers; do
  [ "$quick" ] || rm -rf "build/$preset/bin" # a tree that is not built now is skipped, not passed
done
printf '\n== release\n'
# Joined sources take a third of the time; the presets for daily work compile each source alone.
cmake --preset release -DTANDEM_BUILD_TESTS=ON -DTANDEM_WARNINGS_AS_ERRORS=ON -DTANDEM_JOIN_SOURCES=ON \
    -DTANDEM_PRECOMPILE_HEADERS=ON "-DTANDEM_SANITIZER_TREES=$(echo "$sanitizers" | tr ' ' ';')"
cmake --build --preset release -j "$jobs"

for preset in $compilers; do
  printf '\n== %s\n' "$preset"
  if ! is_possible "$preset"; then
    echo "not possible here; its test will be skipped, or fail where CI=true"
    continue
  fi
  borrowed=$PWD/build/release
  [ "$preset" = golden-aarch64 ] && borrowed= # another processor
  cmake --preset "$preset" "-DTANDEM_OBJECTS_FROM=$borrowed" "-DTANDEM_EMBEDDER_FROM=$PWD/build/release"
  cmake --build --preset "$preset" -j "$jobs" --target golden_hashes
done

for preset in $sanitizers; do
  printf '\n== %s\n' "$preset"
  cmake --preset "$preset" -DTANDEM_BUILD_TESTS=ON "-DTANDEM_OBJECTS_FROM=$PWD/build/release" \
      "-DTANDEM_EMBEDDER_FROM=$PWD/build/release"
  cmake --build --preset "$preset" -j "$jobs" --target tandem_tests # and the programs that it runs
done

if [ "$quick" ]; then # caches of kernels stay, because compiling them again takes long
  exec ctest --preset release -j "$jobs" --no-tests=error -L '^(unit|check)$' -LE '^slow$' "$@"
fi

# Kernel binaries cached by an earlier run must not decide this one.
for preset in release $sanitizers; do rm -rf "build/$preset/test-cache"; done
ctest --preset release -j "$jobs" --no-tests=error "$@"
