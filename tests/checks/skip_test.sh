#!/bin/sh
# skip_test.sh TESTS TANDEM SCRIPTS DIRECTORY - where a device or data is missing, every test that needs it is skipped:
# not one passes. Where CI=true a missing device fails.
set -eu
tests=$1 tandem=$2 scripts=$3 directory=$4
export OCL_ICD_VENDORS=/nonexistent OPENCL_VENDOR_PATH=/nonexistent TANDEM_SHARED_DATA=/nonexistent

. "$(dirname "$0")/expect.sh"

programs=$directory/programs-without-oclgrind
mkdir -p "$programs"
for name in sh env dirname grep mktemp cat head rm; do ln -sf "$(command -v $name)" "$programs/$name"; done

boxes=box-grid:nx=2,ny=2,nz=2
problem=$(dirname "$0")/../scenes/column-and-strays.dat
for status in 77 failed; do
  [ "$status" = failed ] && export CI=true || unset CI
  expect $status "$tests" "*on OpenCL*" # test cases one and all, by name
  expect $status "$tests" "every row of kernels.def*"
  expect $status "$tests" "exclusive scan equals*" # on the CPU it runs
  expect $status "$scripts/on_rusticl.sh" "$tandem" $boxes --steps 1
  expect $status "$scripts/contact_problem_on.sh" "$tandem" "$problem" rusticl "$directory"
  expect $status env "PATH=$programs" "$scripts/under_oclgrind.sh" "$tandem" "$directory" $boxes --steps 1
  expect $status env "PATH=$programs" "$scripts/contact_problem_on.sh" "$tandem" "$problem" oclgrind "$directory"
done
expect 77 "$tests" "glTF's own*"
expect 0 "$tests" "this program's own arithmetic is that of IEEE 754"
echo "what is missing is said"
