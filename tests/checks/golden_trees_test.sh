#!/bin/sh
# golden_trees_test.sh IN_TREE DIRECTORY - a tree of another compiler that was not built: its golden test is skipped,
# fails where CI=true, and is skipped there too if it was left out on purpose. One that was built is run: a test in it
# that fails, fails.
set -eu
in_tree=$1 root=$2/golden-trees
unset CI TANDEM_WITHOUT_COMPILERS

. "$(dirname "$0")/expect.sh"

rm -rf "$root"
mkdir -p "$root/build/golden-built/bin"
cp /bin/true "$root/build/golden-built/bin/golden_hashes"
expect 77 "$in_tree" "$root" golden-missing
expect failed env CI=true "$in_tree" "$root" golden-missing
expect 77 env CI=true TANDEM_WITHOUT_COMPILERS=true "$in_tree" "$root" golden-missing
expect 77 env CI=false "$in_tree" "$root" golden-missing
for outcome in true false; do
  printf 'add_test(one %s)\nset_tests_properties(one PROPERTIES LABELS golden)\n' /bin/$outcome > \
      "$root/build/golden-built/CTestTestfile.cmake"
  status=0
  [ $outcome = true ] || status=failed
  expect $status "$in_tree" "$root" golden-built
  expect $status env CI=true TANDEM_WITHOUT_COMPILERS=true "$in_tree" "$root" golden-built
done
