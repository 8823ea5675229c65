#!/bin/sh
# joined_on_oclgrind.sh TANDEM DIRECTORY together|automatic SCENE [OPTION...] - a run on serial and on Oclgrind, where
# launches are joined: the same hash, far fewer launches, and no complaint of Oclgrind, which watches every access of
# every work-item. It says that it is a GPU, so `automatic` joins there what it would on any.
set -eu
. "$(dirname "$0")/absent.sh"
command -v oclgrind > /dev/null || absent oclgrind
tandem=$1
log=$(mktemp "$2/oclgrind.XXXXXX")
mode=$3
[ "$mode" = automatic ] && mode=
shift 3

value() { # KEY, of the JSON of a run
  sed -n "s/^  \"$1\": \"\{0,1\}\([^\",]*\).*/\1/p"
}

serial=$("$tandem" run "$@" --on serial --json -)
joined=$(TANDEM_PHASES=$mode oclgrind --local-mem-size 65536 --log "$log" --data-races --check-api \
  "$tandem" run "$@" --on cl:oclgrind --json -)
if [ -s "$log" ]; then echo "Oclgrind saw:"; head -40 "$log"; exit 1; fi
rm -f "$log"
expected=$(echo "$serial" | value hash) found=$(echo "$joined" | value hash)
[ -n "$expected" ] || { echo "no hash"; exit 1; }
[ "$expected" = "$found" ] || { echo "serial: $expected, joined on Oclgrind: $found"; exit 1; }
many=$(echo "$serial" | value launches) few=$(echo "$joined" | value launches)
echo "launches a step: $many, joined $few; hash $found"
[ "${few%.*}" -lt $((${many%.*} / 10)) ] || { echo "launches were not joined"; exit 1; }
