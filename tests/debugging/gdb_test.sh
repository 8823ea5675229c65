#!/bin/sh
# gdb_test.sh - gdb stops in one work-item of one kernel, reads the physics there, and sees what the library computes.
set -eu
probe=$1
command -v gdb > /dev/null || { echo "skipped: no gdb"; exit 77; }

expected=$("$probe" | sed -n 's/^impulse .* bits //p')
[ -n "$expected" ] && [ "$expected" != 0x0 ] || { echo "the probe names no impulse but '$expected'"; exit 1; }

# First the item, then the end of the same item: where it stores the motion of its bodies.
seen=$(gdb -batch -nx -ex 'set confirm off' \
  -ex 'break tandem::scalar::solve_contacts_item if i == 17 && tandem::current_step == 3' -ex run \
  -ex 'printf "item %u of step %u\n", i, tandem::current_step' \
  -ex 'tbreak tandem::scalar::store_contact_motion' -ex continue -ex up \
  -ex 'printf "normal length %.6f\n", c.normal.x * c.normal.x + c.normal.y * c.normal.y + c.normal.z * c.normal.z' \
  -ex 'printf "bits 0x%x\n", *(unsigned int *)&next[0]' -ex kill "$probe" 2>&1) || true
case $seen in
  *"ptrace: Operation not permitted"* | *"Could not trace the inferior"*) echo "skipped: this machine lets gdb trace nothing"; exit 77 ;;
esac

check() {
  printf '%s\n' "$seen" | grep -qx "$1" || { printf '%s\ngdb did not print: %s\n' "$seen" "$1"; exit 1; }
}
check "item 17 of step 3"
check "normal length 1.000000"
check "bits $expected"
echo "gdb and the library agree: $expected"
