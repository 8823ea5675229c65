#!/bin/sh
# install-packages.sh - the one list of Debian and Ubuntu packages that Tandem needs, and their installation.
#
# tools/run-demo.sh and tools/run-tests.sh call it, so that a bare Debian 12 or Ubuntu 24.04 is enough to start from.
# A package of level `need` must be installed; one of level `want` enables more, and its absence is reported.
set -eu

usage() {
  cat <<'END'
Usage: tools/install-packages.sh [--no-install] [--list] GROUP...
Installs the missing packages of each GROUP with apt-get (through sudo unless root), after saying which and why.
  build          what compiling Tandem needs
  opencl         an OpenCL device for machines without a GPU
  tests          what the tests need besides
  aarch64        what builds and runs the golden hashes for AArch64
  bullet         what tandem_bullet_bench needs besides
  --no-install   install nothing; if a needed package is missing, print the apt-get line and exit with status 2
  --list         print the packages of the groups and stop
END
}

packages() {
  cat <<'END'
build  need g++                   compiles everything (C++20 and C99)
build  need cmake                 configures the build
build  need ninja-build           runs the build
build  need libtbb-dev            oneTBB: the threads of the CPU backend
build  need ocl-icd-opencl-dev    the OpenCL loader, which finds whatever devices there are
build  need opencl-headers        OpenCL's C interface
build  need opencl-clhpp-headers  OpenCL's C++ interface (opencl.hpp)
build  need libeigen3-dev         the direct solver, and linear algebra of the tests
build  need catch2                the test framework
build  need libcli11-dev          the command line of `tandem`
build  need nlohmann-json3-dev    scene files and --json
build  need libtinygltf-dev       glTF scenes and animations
build  need libtinyobjloader-dev  Wavefront OBJ files of shapes
build  need libtinyxml2-dev       URDF and MJCF files
build  need libpng-dev            pictures of scenes
build  need libfmt-dev            text formatting
opencl want pocl-opencl-icd       PoCL: an OpenCL device on the CPU
tests  need gdb                   a test stops in one work-item of one kernel
tests  need clang                 checks that the shared headers are OpenCL C
tests  want pocl-opencl-icd       PoCL: the OpenCL device of the parity tests
tests  want mesa-opencl-icd       rusticl: a second OpenCL device for parity
tests  want oclgrind              an OpenCL simulator that reports races and bad accesses
tests  want libccd-dev           an outside oracle of overlaps
tests  want ccache                rebuilds only what changed
aarch64 want g++-aarch64-linux-gnu     compiles for AArch64
aarch64 want qemu-user-static          runs what was compiled for AArch64
aarch64 want libtbb-dev:arm64          and its libraries, as for the library itself
aarch64 want ocl-icd-opencl-dev:arm64  the same
aarch64 want libtinygltf-dev:arm64     the same
aarch64 want libtinyobjloader-dev:arm64  the same
aarch64 want libtinyxml2-dev:arm64     the same
aarch64 want libfmt-dev:arm64          the same
bullet need libbullet-dev         Bullet, whose broadphase is timed beside ours
END
}

fail() {
  echo "install-packages.sh: $*" >&2
  exit 2
}

is_installed() {
  case $(dpkg-query -W -f='${db:Status-Abbrev}' "$1" 2>/dev/null) in
    ii*) return 0 ;;
    *) return 1 ;;
  esac
}

# Prints the rows of one group and level that are not installed.
missing() {
  packages | while read -r row_group row_level name why; do
    if [ "$row_group" = "$1" ] && [ "$row_level" = "$2" ] && ! is_installed "$name"; then
      printf '%s %s\n' "$name" "$why"
    fi
  done
}

names_of() { awk '{ print $1 }' | sort -u | tr '\n' ' ' | sed 's/ $//'; }

explain() { echo "$1" | awk 'NF { name = $1; $1 = ""; printf "  %-22s%s\n", name, $0 }'; }

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  else
    sudo "$@"
  fi
}

apt() { as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3 \
    "$@"; }

update_lists() {
  echo "Updating the package lists (apt-get update)."
  apt update || fail "apt-get update failed: is there a network, and are the sources in /etc/apt right?"
  updated=yes
}

have_lists() { [ -n "$(find /var/lib/apt/lists -maxdepth 1 -name '*_Packages*' 2>/dev/null | head -n 1)" ]; }

# shellcheck disable=SC2086 # a list of names
install_names() {
  [ "$updated" = yes ] || have_lists || update_lists
  apt install --no-install-recommends $1 && return 0
  [ "$updated" = no ] || return 1
  update_lists # stale lists name files that the mirrors no longer hold
  apt install --no-install-recommends $1
}

# Debian has all architectures in one archive. If the lists of another architecture are not available (Ubuntu keeps them
# elsewhere), the architecture is removed again.
add_architecture() {
  ! dpkg --print-foreign-architectures | grep -qx "$1" || return 0
  as_root dpkg --add-architecture "$1"
  apt update && updated=yes && return 0
  as_root dpkg --remove-architecture "$1"
  return 1
}

install=yes
list=no
groups=
for argument in "$@"; do
  case $argument in
    --no-install) install=no ;;
    --list) list=yes ;;
    --help | -h) usage; exit 0 ;;
    build | opencl | tests | aarch64 | bullet) groups="$groups $argument" ;;
    *) fail "unknown argument '$argument'; see --help" ;;
  esac
done
[ -n "$groups" ] || fail "name at least one group: build, opencl, tests, aarch64 or bullet"

if [ "$list" = yes ]; then
  packages | awk -v groups="$groups " 'index(groups, " " $1 " ") { print $3 }' | sort -u
  exit 0
fi

command -v dpkg-query >/dev/null && command -v apt-get >/dev/null ||
  fail "this machine has no apt; install what '$0 --list$groups' prints by its own means," \
    "then build with cmake --preset release"

needed=
wanted=
for group in $groups; do
  needed="$needed$(missing "$group" need)
"
  wanted="$wanted$(missing "$group" want)
"
done
needed_names=$(echo "$needed" | sed '/^$/d' | names_of)
wanted_names=$(echo "$wanted" | sed '/^$/d' | names_of)
[ -n "$needed_names$wanted_names" ] || exit 0

if [ "$install" = no ]; then
  if [ -n "$needed_names" ]; then
    echo "Missing packages, which --no-install keeps from being installed:" >&2
    explain "$needed" >&2
    echo "Please run:  sudo apt-get install --no-install-recommends $needed_names${wanted_names:+ $wanted_names}" >&2
    exit 2
  fi
  echo "Going on without these, which would make more possible:"
  explain "$wanted"
  exit 0
fi

[ "$(id -u)" -eq 0 ] || command -v sudo >/dev/null ||
  fail "not root and no sudo; as root run: apt-get install --no-install-recommends $needed_names $wanted_names"

echo "Installing what is missing:"
explain "$needed$wanted" | sort -u
updated=no
if [ -n "$needed_names" ]; then
  install_names "$needed_names" || fail "apt-get could not install: $needed_names"
fi
case $wanted_names in
  *:arm64*)
    if ! add_architecture arm64; then
      echo "install-packages.sh: no packages of arm64 here; going on without them"
      wanted_names=$(echo "$wanted_names" | tr ' ' '\n' | { grep -v ':arm64$' || true; })
    fi
    ;;
esac
for name in $wanted_names; do
  install_names "$name" || echo "install-packages.sh: no package $name here; going on without it"
done
