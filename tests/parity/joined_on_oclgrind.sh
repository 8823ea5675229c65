#!/bin/sh
# joined_on_oclgrind.sh TANDEM DIRECTORY MODE SCENE [OPTION...] - a run on serial and on Oclgrind, where launches are
# joined: the same hash, far fewer launches, and no complaint of Oclgrind, which watches every access of every item.
#
#   together    one work-group
#   automatic   what any device joins that calls itself a GPU, as Oclgrind does
#   resident    three work-groups, which wait for each other; Oclgrind would take their barrier for a race
#   alone       as `resident`, but one thread runs one group after the other, which the test at the start has to notice
set -eu
. "$(dirname "$0")/absent.sh"
command -v oclgrind > /dev/null || absent oclgrind
tandem=$1
log=$(mktemp "$2/oclgrind.XXXXXX")
mode=$3
watch=--data-races groups=1
case $mode in
  automatic) mode= ;;
  resident) watch="--compute-units 3 --num-threads 3" groups=3 ;;
  alone) mode=resident watch="--compute-units 3 --num-threads 1" ;;
esac
shift 3

value() { # KEY, of the JSON of a run
  sed -n "s/^  \"$1\": \"\{0,1\}\([^\",]*\).*/\1/p"
}

serial=$("$tandem" run "$@" --on serial --json -)
joined=$(TANDEM_PHASES=$mode oclgrind --local-mem-size 65536 --log "$log" $watch --check-api \
  "$tandem" run "$@" --on cl:oclgrind --json -)
if [ -s "$log" ]; then echo "Oclgrind saw:"; head -40 "$log"; exit 1; fi
rm -f "$log"
expected=$(echo "$serial" | value hash) found=$(echo "$joined" | value hash)
[ -n "$expected" ] || { echo "no hash"; exit 1; }
[ "$expected" = "$found" ] || { echo "serial: $expected, joined on Oclgrind: $found"; exit 1; }
together=$(echo "$joined" | sed -n 's/^  "resident_groups": \([0-9]*\).*/\1/p')
[ "$together" = $groups ] || { echo "$together work-groups waited for each other, not $groups"; exit 1; }
many=$(echo "$serial" | value launches) few=$(echo "$joined" | value launches)
echo "launches a step: $many, joined $few; hash $found"
[ "${few%.*}" -lt $((${many%.*} / 10)) ] || { echo "launches were not joined"; exit 1; }
