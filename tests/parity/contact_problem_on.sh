#!/bin/sh
# contact_problem_on.sh TANDEM PROBLEM rusticl|oclgrind DIRECTORY - a contact problem on serial and on that OpenCL
# device: the same residuals and impulses to the last digit, and no complaint of Oclgrind, which watches every access.
set -eu
tandem=$1 problem=$2 device=$3 directory=$4
. "$(dirname "$0")/absent.sh"

solve() { # SOLVER BACKEND [COMMAND BEFORE TANDEM...]
  solver=$1 backend=$2
  shift 2
  "$@" "$tandem" contact-problem "$problem" --solver "$solver" --on "$backend" --iterations 6 --tolerance 1e-9 \
    --json - |
    grep -v -e '"ms"' -e '"backend"'
}

if [ "$device" = rusticl ]; then
  log= watch=env
else
  command -v oclgrind > /dev/null || absent oclgrind
  log=$(mktemp "$directory/oclgrind.XXXXXX") watch="oclgrind --log $log --data-races --check-api"
fi
for solver in pgs nncg jacobi; do
  expected=$(solve "$solver" serial env)
  # Asked for only now, because the list of devices tries out each of them.
  found=$(solve "$solver" "cl:$device" $watch) || [ "$device" = oclgrind ] || "$tandem" devices | grep -q rusticl ||
    absent rusticl
  [ -n "$expected" ] || { echo "$solver: no result"; exit 1; }
  [ "$expected" = "$found" ] && continue
  printf '%s differs\nserial: %s\n%s: %s\n' "$solver" "$expected" "$device" "$found"
  exit 1
done
if [ -n "$log" ]; then
  if [ -s "$log" ]; then echo "Oclgrind saw:"; head -40 "$log"; exit 1; fi
  rm -f "$log"
fi
