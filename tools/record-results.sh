#!/usr/bin/env bash
# record-results.sh - records the results and the times of this machine's backends: parity first, then times.
#
#   tools/record-results.sh TANDEM OUTPUT-FOLDER GPU [WHAT]
#
# WHAT: parity, shapes, broadphase, narrowphase, times, widths, solvers, batchers, report, stability or all.
#
# TANDEM is the built command, GPU the --on text of the device to record (cl:nvidia). The script writes one JSON file
# for each run, and commands.txt, which lists their commands. docs/results keeps a page and the small files of them;
# files beyond 100 KB are named in not-kept.txt and not committed. docs/results.md says which part makes which table.
set -u
tandem=$1 out=$2 gpu=$3 what=${4:-all}
parts="parity shapes broadphase narrowphase times widths solvers batchers report stability all"
case " $parts " in *" $what "*) ;; *) echo "record-results.sh: '$what': use one of $parts" >&2; exit 2 ;; esac
mkdir -p "$out"
: > "$out/commands.txt"

record() { # NAME ARGUMENTS...: runs tandem with --json, keeps the file and reports the exit status
  local name=$1; shift
  local start=$SECONDS
  echo "tandem $* --json $name.json" >> "$out/commands.txt"
  if timeout "${LIMIT:-300}" "$tandem" "$@" --json "$out/$name.json" > "$out/$name.log" 2>&1; then status=ok; else \
      status="exit $?"; fi
  echo "$name: $status ($((SECONDS - start)) s)" | tee -a "$out/summary.txt"
  [ "$status" = ok ] || tail -n 3 "$out/$name.log"
}

record devices devices
if [ "$what" = parity ] || [ "$what" = all ]; then
  for scene in box-grid:nx=20,ny=20,nz=20 falling-boxes mixed; do
    record "parity-${scene%%:*}" diff "$scene" --between "serial,tbb,cl:pocl,$gpu" --steps 300
  done
fi
if [ "$what" = shapes ] || [ "$what" = all ]; then
  between="serial,tbb,$gpu"
  for method in sat gjk-epa gjk-sampled sat-split cube-map; do
    for scene in shapes:n=100 convex-hulls:n=150; do
      record "parity-${scene%%:*}-$method" diff "$scene" --narrowphase "$method" --between "$between" --steps 60
    done
  done
  for support in hill-climbing cube-map; do
    record "parity-convex-hulls-support-$support" diff convex-hulls:n=150 --support "$support" --between "$between" \
        --steps 60
  done
  for scene in rolling mesh-slide hulls-on-mesh:n=150 compounds:n=100; do
    record "parity-${scene%%:*}" diff "$scene" --between "$between" --steps 120
  done
  record parity-bullet-stack diff bullet-stack --between "$between" --steps 60
  record parity-thin-wall diff thin-wall:n=40 --between "$between" --steps 40
  record parity-compounds-events diff compounds:n=60 --events --between "$between" --steps 60
  record parity-every-feature diff shapes:n=40 --no-specialise --between "$between" --steps 20
  record parity-convex-hulls-12000 diff convex-hulls:n=12000 --between "tbb,$gpu" --steps 30
  for backend in "$gpu" tbb; do
    for scene in convex-hulls:n=1000 hulls-on-mesh:n=1000 compounds:n=500; do
      record "${scene%%:*}-${backend%%:*}" run "$scene" --on "$backend" --steps 300
    done
    record "convex-hulls-20000-${backend%%:*}" run convex-hulls:n=20000 --on "$backend" --steps 120
  done
fi
# Inputs run one at a time, because a million bodies of each take minutes on a processor of few cores.
if [ "$what" = broadphase ] || [ "$what" = all ]; then
  for backend in "$gpu" tbb; do
    for scene in spheres pile one-large sizes static; do
      LIMIT=600 record "broadphase-$scene-${backend%%:*}" bench broadphase --on "$backend" --scene "$scene" --chart \
          "$out/broadphase-$scene-${backend%%:*}.svg"
    done
  done
fi
# Every method of each kind of pair is a separate build, which takes a driver minutes.
if [ "$what" = narrowphase ] || [ "$what" = all ]; then
  LIMIT=600 record narrowphase-gpu bench narrowphase --on "$gpu" --n 262144
  record narrowphase-million-boxes-gpu bench narrowphase --on "$gpu" --n 1048576 --pairs box-box
  record narrowphase-million-hulls-gpu bench narrowphase --on "$gpu" --n 1048576 --pairs hull32-hull32
  record narrowphase-tbb bench narrowphase --on tbb --n 65536
fi
if [ "$what" = times ] || [ "$what" = all ]; then
  for size in 10,10,10 20,20,20 32,32,32 40,40,40 50,40,50 100,100,100; do
    IFS=, read -r nx ny nz <<< "$size"
    record "box-grid-$((nx * ny * nz))-gpu" run "box-grid:nx=$nx,ny=$ny,nz=$nz" --on "$gpu" --steps 120
  done
  for size in 10,10,10 20,20,20 40,40,40; do
    IFS=, read -r nx ny nz <<< "$size"
    record "box-grid-$((nx * ny * nz))-tbb" run "box-grid:nx=$nx,ny=$ny,nz=$nz" --on tbb --steps 120
  done
  record box-grid-8000-tbb-2-threads run box-grid:nx=20,ny=20,nz=20 --on tbb:threads=2 --steps 120
  record sort-gpu bench sort --on "$gpu" --n 16777216
  record scan-gpu bench scan --on "$gpu" --n 16777216
fi
if [ "$what" = widths ] || [ "$what" = all ]; then
  backends="serial,serial:order=backward,serial:order=shuffled"
  backends="$backends,tbb:threads=1,lanes=1,tbb:threads=2,lanes=4,tbb:threads=7,lanes=8"
  for scene in box-grid:nx=20,ny=20,nz=20 falling-boxes box-stack pyramid spheres mixed; do
    record "widths-${scene%%:*}" diff "$scene" --between "$backends,tbb:lanes=16,cl:pocl,$gpu" --steps 120
  done
fi
# Every solver and every batcher gives the same bits on every backend; these runs record what each costs.
solvers="soft-step pgs nncg jacobi xpbd avbd direct"
if [ "$what" = solvers ] || [ "$what" = all ]; then
  for solver in $solvers; do
    record "solver-$solver-parity" diff mixed:n=400 --solver "$solver" --between "serial,tbb,$gpu" --steps 60
    for backend in "$gpu" tbb; do
      record "solver-$solver-${backend%%:*}" run box-grid:nx=20,ny=20,nz=20 --solver "$solver" --on "$backend" \
          --steps 60
    done
  done
fi
if [ "$what" = batchers ] || [ "$what" = all ]; then
  for batching in coloring sequential single-group iterative two-stage; do
    record "batching-$batching-parity" diff mixed:n=400 --batching "$batching" --check --between "serial,tbb,$gpu" \
        --steps 60
  done
  for backend in "$gpu" tbb; do record "bench-batching-${backend%%:*}" bench batching --on "$backend"; done
fi
# Error against time, and stiff cases, are recorded in parts of a few minutes, each with a page of its own.
LIMIT=${LIMIT:-600}
if [ "$what" = report ] || [ "$what" = all ]; then
  record report-small report --on "tbb,$gpu" --scenes free-flight,incline,bounce,pyramid,mass-ratio,mixed --out \
      "$out/report-small"
  record report-box-grid report --on "tbb,$gpu" --parts scenes --scenes box-grid --out "$out/report-box-grid"
  record report-box-grid-large report --on "tbb,$gpu" --parts scenes --scenes box-grid-large --out \
      "$out/report-box-grid-large"
fi
# The long pyramids run on the device, except for direct, which works on the CPU; the bits are the same.
if [ "$what" = stability ] || [ "$what" = all ]; then
  pyramids=pyramid-80,pyramid-100
  record stability-small stability --except $pyramids --out "$out/stability-small"
  record stability-pyramids stability --only $pyramids --solvers soft-step,pgs,xpbd,avbd,jacobi --on "$gpu" --out \
      "$out/stability-pyramids"
  record stability-pyramids-nncg stability --only $pyramids --solvers nncg --on "$gpu" --out \
      "$out/stability-pyramids-nncg"
  record stability-pyramids-direct stability --only $pyramids --solvers direct --out "$out/stability-pyramids-direct"
fi
# Large files are not committed, because the commands can make them again.
(cd "$out" && find . -type f -size +100k | sed 's|^./||' | sort) > "$out/not-kept.txt"
[ ! -s "$out/not-kept.txt" ] || { printf 'beyond 100 KB, not to be committed:\n'; cat "$out/not-kept.txt"; }
