#!/bin/sh
# run-demo.sh - from a bare machine to falling boxes: installs what is missing, builds, and shows one scene on every
# backend.
set -eu

usage() {
  cat <<'END'
Usage: tools/run-demo.sh [--no-install] [--without-opencl]
Installs the missing packages, builds the `release` preset, then simulates and compares small scenes on every backend.
No GPU and no OpenCL runtime is needed: without a device the CPU backends serve. The animation is build/demo/demo.glb.
  --no-install       install nothing; if a package is missing, say which and exit with status 2
  --without-opencl   neither install nor use an OpenCL device
END
}

install_option=
opencl=yes
for argument in "$@"; do
  case $argument in
    --no-install) install_option=--no-install ;;
    --without-opencl) opencl=no ;;
    --help | -h) usage; exit 0 ;;
    *) echo "run-demo.sh: unknown option '$argument'; see --help" >&2; exit 2 ;;
  esac
done
cd "$(dirname "$0")/.."

heading() { printf '\n== %s\n' "$*"; }

tandem() {
  echo "\$ tandem $*"
  build/release/bin/tandem "$@"
}

# A machine with an OpenCL driver of its own needs no PoCL.
have_driver() { [ -n "$(find "${OCL_ICD_VENDORS:-/etc/OpenCL/vendors}" -name '*.icd' 2>/dev/null | head -n 1)" ]; }

# Prints the OpenCL backend to compare, or on standard error why there is none.
opencl_backend() {
  if [ "$opencl" = no ]; then echo "OpenCL is left out, as asked." >&2; return; fi
  for candidate in cl:pocl cl; do
    if reason=$(build/release/bin/tandem run box-grid:nx=2,ny=2,nz=2 --on "$candidate" --steps 1 2>&1 >/dev/null); then
      echo "$candidate"
      return
    fi
  done
  echo "No OpenCL device takes part: $(echo "$reason" | tail -n 1)" >&2
}

heading "Packages"
groups=build
if [ "$opencl" = yes ] && ! have_driver; then groups="build opencl"; fi
# shellcheck disable=SC2086 # options and groups are lists
tools/install-packages.sh $install_option $groups
echo "All packages that the build needs are there."

heading "Build"
cmake --preset release
cmake --build --preset release --target tandem_command

heading "The backends of this machine, each with its exactness self-test"
tandem devices
device=$(opencl_backend)
backends=serial,tbb${device:+,$device}
if [ -z "$device" ]; then
  echo "MiniCL serves, which runs the same kernels on the CPU's threads and lanes."
fi

heading "A grid of 8 x 8 x 8 boxes"
tandem run box-grid:nx=8,ny=8,nz=8 --on tbb --steps 120

heading "Falling boxes, saved as an animation"
mkdir -p build/demo
tandem run falling-boxes:n=300 --on tbb --steps 180 --save build/demo/demo.glb

heading "The same bits on every backend: $backends"
tandem diff box-grid:nx=8,ny=8,nz=8 --between "$backends" --steps 30

heading "Done"
echo "Animation: $(pwd)/build/demo/demo.glb  (open it in any glTF viewer)"
echo "Compared bit for bit: $backends${device:+ (OpenCL)}."
