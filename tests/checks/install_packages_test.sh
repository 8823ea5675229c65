#!/bin/sh
# install_packages_test.sh - tools/install-packages.sh against a pretended machine: nothing is installed here.
#
# Usage: install_packages_test.sh ROOT DIR        DIR is scratch
set -eu

script=$1/tools/install-packages.sh
fake=$2/install-packages-test
failed=0
rm -rf "$fake"
mkdir -p "$fake"

# A machine that has every package but those named in the file `absent`; apt-get writes down what it is asked for.
cat >"$fake/dpkg-query" <<'END'
#!/bin/sh
for name in "$@"; do :; done
grep -qx "$name" "$(dirname "$0")/absent" || printf 'ii '
END
cat >"$fake/apt-get" <<'END'
#!/bin/sh
echo "$*" >>"$(dirname "$0")/calls"
[ "$DEBIAN_FRONTEND" = noninteractive ] || exit 1
case $* in *unobtainable*|*oclgrind*) exit 100 ;; esac
case $* in *update*) [ ! -e "$(dirname "$0")/elsewhere" ] || exit 100 ;; esac
END
# It knows one architecture, and arm64 once that was added; where `elsewhere` is, the lists of arm64 cannot be had.
cat >"$fake/dpkg" <<'END'
#!/bin/sh
here=$(dirname "$0")
case $1 in
  --print-foreign-architectures) cat "$here/architectures" ;;
  --add-architecture) echo "$2" >>"$here/architectures" ;;
  --remove-architecture) : >"$here/architectures" ;;
esac
END
: >"$fake/architectures"
printf '#!/bin/sh\necho 1000\n' >"$fake/id"
printf '#!/bin/sh\nexec "$@"\n' >"$fake/sudo"
chmod +x "$fake"/*

# expect STATUS TEXT ARGUMENT...: the script must end so and print TEXT.
expect() {
  status=0 wanted=$1 text=$2
  shift 2
  : >"$fake/calls"
  PATH="$fake:$PATH" "$script" "$@" >"$fake/log" 2>&1 || status=$?
  if [ "$status" != "$wanted" ] || { [ -n "$text" ] && ! grep -qF -- "$text" "$fake/log"; }; then
    echo "install-packages.sh $*: status $status instead of $wanted, or no '$text' in:"
    cat "$fake/log"
    failed=1
  fi
}

expect_call() {
  grep -q -- "$1" "$fake/calls" && return
  echo "apt-get was not asked for '$1' but:"
  cat "$fake/calls"
  failed=1
}
expect_no_call() { [ ! -s "$fake/calls" ] || { echo "apt-get ran:"; cat "$fake/calls"; failed=1; }; }

: >"$fake/absent"
expect 0 '' build opencl tests
expect_no_call

printf 'cmake\nlibfmt-dev\noclgrind\n' >"$fake/absent"
expect 2 'sudo apt-get install --no-install-recommends cmake libfmt-dev' --no-install build
expect_no_call
expect 2 'text formatting' build --no-install
expect 0 'configures the build' build
expect_call '--no-install-recommends cmake libfmt-dev$'
expect 0 'no package oclgrind here; going on' tests

printf 'pocl-opencl-icd\n' >"$fake/absent"
expect 0 'Going on without these' --no-install opencl
expect_no_call

printf 'libtbb-dev:arm64\nqemu-user-static\n' >"$fake/absent"
expect 0 'runs what was compiled' aarch64
expect_call 'update$'
expect_call '--no-install-recommends libtbb-dev:arm64$'
grep -qx arm64 "$fake/architectures" || { echo "arm64 was not added"; failed=1; }
: >"$fake/architectures"
: >"$fake/elsewhere"
expect 0 'no packages of arm64 here; going on' aarch64
expect_call '--no-install-recommends qemu-user-static$'
! grep -q 'install.*arm64' "$fake/calls" || { echo "packages of arm64 were asked for without lists"; failed=1; }
[ ! -s "$fake/architectures" ] || { echo "arm64 was not forgotten"; failed=1; }
rm "$fake/elsewhere"

expect 2 "unknown argument '--fast'" --fast
expect 2 'at least one group'
expect 0 'Usage:' --help
rm -rf "$fake"
exit $failed
