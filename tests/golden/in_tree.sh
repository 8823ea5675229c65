#!/bin/sh
# in_tree.sh - the golden hashes in a tree of another compiler or processor, which tools/run-tests.sh has built beforehand.
#
# Usage: in_tree.sh ROOT TREE       skipped (status 77) where there is no such tree
set -eu

if [ ! -x "$1/build/$2/bin/golden_hashes" ]; then
  echo "skipped: build/$2 has not been built; tools/run-tests.sh builds it where its compiler and libraries are installed"
  exit 77
fi
exec ctest --test-dir "$1/build/$2" -L golden --no-tests=error --output-on-failure
