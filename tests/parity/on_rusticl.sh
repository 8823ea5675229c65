#!/bin/sh
# on_rusticl.sh TANDEM SCENE [OPTION...] - lockstep of serial and Mesa's rusticl, which lends the CPU as an OpenCL device.
set -eu
tandem=$1
shift
"$tandem" devices | grep -q rusticl || { echo "skipped: no rusticl"; exit 77; }
exec "$tandem" diff "$@" --between serial,cl:rusticl
