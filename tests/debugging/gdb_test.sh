#!/bin/sh
# gdb_test.sh pipeline|module PROBE - gdb stops in one work-item of one kernel, of the pipeline or of a module, reads
# the physics there, and sees what the library computes.
set -eu
what=$1 probe=$2
command -v gdb > /dev/null || { echo "skipped: no gdb"; exit 77; }

# stop_at PLACE [GDB-OPTION...]: `seen` is what gdb prints there.
stop_at() {
  place=$1
  shift
  seen=$(gdb -batch -nx -ex 'set confirm off' -ex "break $place" -ex run "$@" 2>&1) || true
  case $seen in
    *"ptrace: Operation not permitted"* | *"Could not trace the inferior"*)
      echo "skipped: this machine lets gdb trace nothing"
      exit 77
      ;;
  esac
}

check() {
  printf '%s\n' "$seen" | grep -qx "$1" || { printf '%s\ngdb did not print: %s\n' "$seen" "$1"; exit 1; }
}

# expect NAME: `expected` are the bits that the probe itself, without gdb, prints behind that word.
expect() {
  expected=$("$probe" | sed -n "s/^$1 .* bits //p")
  [ -n "$expected" ] && [ "$expected" != 0x0 ] || { echo "the probe names no $1 but '$expected'"; exit 1; }
}

show_item='printf "item %u of step %u\n", i, tandem::step_of_launch'

stop_in_pipeline() {
  expect impulse
  # Names of arguments, which kernels.def and argument_groups.h fix too; names of locals change with the solver.
  stop_at 'tandem::scalar::solve_contacts_item if i == 17 && tandem::step_of_launch == 3' -ex "$show_item" \
    -ex 'set $n = contacts.normal[i]' -ex 'printf "normal length %.6f\n", $n.x * $n.x + $n.y * $n.y + $n.z * $n.z' \
    -ex 'set $impulses = contact_impulses.normal' -ex finish \
    -ex 'printf "bits 0x%x\n", *(unsigned int *)&$impulses[17].x' -ex kill "$probe"
  check "item 17 of step 3"
  check "normal length 1.000000"
  check "bits $expected"
  # A worker knows the step as well as the thread that launches: it would say 0 if only that one did.
  stop_at 'tandem::scalar::compute_bounds_item if $_thread != 1 && tandem::step_of_launch >= 2' \
    -ex 'printf "a worker after %d steps\n", tandem::step_of_launch >= 2 ? 2 : 0' -ex kill --args "$probe" threads
  check "a worker after 2 steps"
}

# The item's buffers, one of the pipeline and one of the module, and its value, before and after.
stop_in_module() {
  expect velocity
  stop_at 'tandem::probe_scalar::probe_push_item if i == 17 && tandem::step_of_launch == 3' -ex "$show_item" \
    -ex 'printf "force %.9g %.9g times %u\n", probe_force[0].x, probe_force[0].z, times' \
    -ex 'set $v = solver_velocity' -ex 'printf "before %.9g %.9g\n", $v[34].x, $v[34].z' -ex finish \
    -ex 'printf "after %.9g %.9g\n", $v[34].x, $v[34].z' -ex 'printf "bits 0x%x\n", *(unsigned int *)&$v[34].x' \
    -ex kill "$probe"
  check "item 17 of step 3"
  check "force 0.5 -0.25 times 3"
  check "before 18 -9"
  check "after 19.5 -9.75"
  check "bits $expected"
}

"stop_in_$what"
echo "gdb and the library agree: $expected"
