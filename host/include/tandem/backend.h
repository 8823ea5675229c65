/* backend.h - what runs the kernels of a world: a backend is named by a text, as on the command line.
 *
 *   serial[:order=backward]             one item after the other, on one thread
 *   tbb[:threads=N,lanes=1|4|8|16]      threads and lanes of the CPU; all that it has unless N is said
 *   cl[:P.D], cl:part-of-a-name         an OpenCL device: the first one, by its numbers, or by its name
 *   reference[:threads=N]               the same kernels in double, for measuring errors
 *
 * All but the last have the same bits, so that any stage of any step may run on any of them.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <tandem/export.h>

namespace tandem {

/* What makes the first steps of a world. Where its cache is empty, a driver compiles kernels for up to a minute. */
enum class Start : uint8_t {
  on_device, /* whoever places the world waits for its kernels, and finish() for those that calls bring in */
  on_cpu,    /* nobody waits: `tbb` runs everything until the kernels of the device are built, queries, too; refused
                with allow_inexact, because the bits would depend on when that is */
};

/* Which backend runs which kernel: one for all, and exceptions by stage ("narrowphase") or kernel name. */
struct Placement {
  std::string on = "tbb";
  std::vector<std::pair<std::string, std::string>> exceptions; /* stage or kernel, and backend; the last that fits */
  bool allow_inexact = false;                                  /* accept a device whose results may differ in bits */
  /* If calls bring new features into a world, its kernels for OpenCL devices are built on a thread of their own, and
   * `tbb`, which has all of them, runs them until then, with the same bits. Else the call waits for the compiler. */
  bool build_in_background = true;
  /* The broadphase `auto` is chosen as if this backend ran it; empty: for the one that does. Worlds whose kernels are
   * compared one by one must run the same ones. */
  std::string broadphase_for = {};
  /* The world chooses where its steps run: on `tbb`, on the device that `on` names, or cut by stages between both. It
   * takes the fastest on its first steps, and again when the scene has become twice or half as large. Until the kernels
   * of the device are built `tbb` runs them. Exceptions hold whatever is chosen. */
  bool automatic = false;
  std::function<double()> clock = {}; /* in ms; what the choice reads instead of the machine's, for programs that must
                                         repeat one */
  /* Whatever is said here, the results are the same. An automatic placement starts on the CPU by
   * itself, and is refused with on_cpu. */
  Start start = Start::on_device;
  /* Called again and again while a world is placed, or waits until it is, of whose kernels for OpenCL devices so many
   * are built. */
  std::function<void(size_t built, size_t kernels)> while_building = {};
};

/* Throws InputError if an exception names no stage and no kernel, or if results might depend on an automatic choice. */
TANDEM_API void validate(const Placement &placement);

/* Parses "STAGE=B,STAGE=B". A part without '=' belongs to the backend before it; so does an option such as lanes=4 of
 * tbb:threads=2,lanes=4, which is recognised by its name. Throws InputError if a stage is unknown. */
TANDEM_API std::vector<std::pair<std::string, std::string>> parse_placement(const std::string &text);

} // namespace tandem
