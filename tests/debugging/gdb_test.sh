#!/bin/sh
# gdb_test.sh - gdb stops in one work-item of one kernel, reads the physics there, and sees what the library computes.
set -eu
probe=$1
command -v gdb > /dev/null || { echo "skipped: no gdb"; exit 77; }

expected=$("$probe" | sed -n 's/^impulse .* bits //p')
[ -n "$expected" ] && [ "$expected" != 0x0 ] || { echo "the probe names no impulse but '$expected'"; exit 1; }

# Names of arguments, which kernels.def and argument_groups.h fix too; names of locals change with the solver.
seen=$(gdb -batch -nx -ex 'set confirm off' \
  -ex 'break tandem::scalar::solve_contacts_item if i == 17 && tandem::step_of_launch == 3' -ex run \
  -ex 'printf "item %u of step %u\n", i, tandem::step_of_launch' \
  -ex 'set $n = contacts.normal[i]' -ex 'printf "normal length %.6f\n", $n.x * $n.x + $n.y * $n.y + $n.z * $n.z' \
  -ex 'set $impulses = contact_impulses.normal' -ex finish \
  -ex 'printf "bits 0x%x\n", *(unsigned int *)&$impulses[17].x' -ex kill "$probe" 2>&1) || true
case $seen in
  *"ptrace: Operation not permitted"* | *"Could not trace the inferior"*)
    echo "skipped: this machine lets gdb trace nothing"
    exit 77
    ;;
esac

check() {
  printf '%s\n' "$seen" | grep -qx "$1" || { printf '%s\ngdb did not print: %s\n' "$seen" "$1"; exit 1; }
}
check "item 17 of step 3"
check "normal length 1.000000"
check "bits $expected"

# A worker knows the step as well as the thread that launches: it would say 0 if only that one did.
seen=$(gdb -batch -nx -ex 'set confirm off' \
  -ex 'break tandem::scalar::compute_bounds_item if $_thread != 1 && tandem::step_of_launch >= 2' -ex run \
  -ex 'printf "a worker after %d steps\n", tandem::step_of_launch >= 2 ? 2 : 0' -ex kill --args "$probe" threads \
      2>&1) || true
check "a worker after 2 steps"
echo "gdb and the library agree: $expected"
