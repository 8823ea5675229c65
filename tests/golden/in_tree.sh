#!/bin/sh
# in_tree.sh - the golden hashes in a tree of another compiler or processor, which tools/run-tests.sh has built
# beforehand.
#
# Usage: in_tree.sh ROOT TREE
#
# It is skipped (status 77) where there is no such tree; with CI=true that is a failure, unless whoever started it asked
# for no such trees (TANDEM_WITHOUT_COMPILERS=true, which `run-tests.sh --without-compilers` sets).
set -eu

if [ ! -x "$1/build/$2/bin/golden_hashes" ]; then
  if [ "${CI:-}" = true ] && [ "${TANDEM_WITHOUT_COMPILERS:-}" != true ]; then
    echo "build/$2 has not been built, which CI=true requires;" \
      "tools/run-tests.sh builds it, or leaves it out with --without-compilers"
    exit 1
  fi
  echo "skipped: build/$2 has not been built;" \
    "tools/run-tests.sh builds it where its compiler and libraries are installed"
  exit 77
fi
exec ctest --test-dir "$1/build/$2" -L golden --no-tests=error --output-on-failure
