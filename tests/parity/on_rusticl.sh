#!/bin/sh
# on_rusticl.sh TANDEM SCENE [OPTION...] - lockstep of serial and Mesa's rusticl, which lends the CPU as an OpenCL
# device.
set -eu
tandem=$1
shift
. "$(dirname "$0")/absent.sh"
status=0
"$tandem" diff "$@" --between serial,cl:rusticl || status=$?
# Asked for only now, because the list of devices tries out each of them.
[ "$status" -eq 0 ] || "$tandem" devices | grep -q rusticl || absent rusticl
exit "$status"
