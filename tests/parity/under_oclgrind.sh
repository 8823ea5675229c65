#!/bin/sh
# under_oclgrind.sh TANDEM DIRECTORY SCENE [OPTION...] - lockstep of serial and Oclgrind, which watches every access of
# every work-item: accesses out of bounds, data races, divergent barriers. It ends with status 0 whatever it saw, so its
# log decides. under_oclgrind.sh --self-test DIRECTORY - shows that a log with a line in it, and a failed command, fail.
set -eu

verdict() { # LOG STATUS
  if [ -s "$1" ]; then
    echo "Oclgrind saw:"
    head -40 "$1"
    return 1
  fi
  return "$2"
}

if [ "$1" = --self-test ]; then
  log=$(mktemp "$2/oclgrind.XXXXXX")
  verdict "$log" 0 || { echo "an empty log failed"; exit 1; }
  if verdict "$log" 1; then echo "a failed command passed"; exit 1; fi
  echo "Invalid write of size 4 at global memory address 0x1000000000010" > "$log"
  if verdict "$log" 0 > /dev/null; then echo "a log of errors passed"; exit 1; fi
  rm -f "$log"
  exit 0
fi

. "$(dirname "$0")/absent.sh"
command -v oclgrind > /dev/null || absent oclgrind
tandem=$1
log=$(mktemp "$2/oclgrind.XXXXXX")
shift 2
status=0
# A sort of 64-bit keys takes 57 KiB of local memory; Oclgrind's device has 32 unless told.
oclgrind --local-mem-size 65536 --log "$log" --data-races --check-api "$tandem" diff "$@" --between \
    serial,cl:oclgrind || status=$?
outcome=0
verdict "$log" "$status" || outcome=$?
rm -f "$log"
exit "$outcome"
