#!/bin/sh
# on_rusticl.sh TANDEM SCENE [OPTION...] - lockstep of serial and Mesa's rusticl, which lends the CPU as an OpenCL
# device.
set -eu
tandem=$1
shift
. "$(dirname "$0")/absent.sh"
"$tandem" devices | grep -q rusticl || absent rusticl
exec "$tandem" diff "$@" --between serial,cl:rusticl
