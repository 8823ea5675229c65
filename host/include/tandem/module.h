/* module.h - lets a program run kernels of its own within a step or between steps; docs/your-own-kernel.md is the
 * introduction.
 *
 * A module is a list of kernels and a list of buffers, written like those of the pipeline. Each kernel is one C99
 * function; it runs on every backend with the same bits, and is placed, profiled, debugged in gdb and compared like the
 * pipeline's. The CMake function tandem_add_module() makes a library of the module; its generated header names the
 * module, its kernels and its buffers. An Extension in Settings::extensions adds the module to a world and says what it
 * launches at which points of the step. Any thread may add modules, also while worlds of others run.
 */
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <tandem/export.h>

namespace tandem {

enum class Kernel : uint16_t;
enum class Buffer : uint16_t;
class Module;
class World;
struct Settings;

/* Finds a kernel or a buffer by its name in its list, the pipeline's lists included; buffers are for World::read and
 * for slots. Throws InputError if there is none. */
TANDEM_API Kernel kernel_named(const std::string &name);
TANDEM_API Buffer buffer_named(const std::string &name);

/* Where in a step an extension may launch, in the order of the step. A step that overflows runs again from `begin`, so
 * inside a step kernels may write only SCRATCH buffers (the pipeline's solver_ and manifold_ buffers are SCRATCH) or
 * KEPT ones, which change no bit of a result. Lasting state is written at `commit`, over COMMIT_ items: an attempt that
 * will run again has none.
 */
enum class StepPoint : uint8_t {
  begin,       /* bodies are prepared: solver_velocity and, where some body's moments differ, solver_inertia hold the
                  result of the last step */
  pairs,       /* pair_a and pair_b list the pairs that may touch, sorted */
  contacts,    /* manifolds are final: a kernel may drop or change them before they become constraints */
  constraints, /* constraints stand in the order of their colours */
  forces,      /* in each substep, before gravity: what is added to solver_velocity takes part in the solve */
  solved,      /* solver_velocity and solver_delta_pose are the step's result, not checked yet */
  commit       /* STATE and CACHE buffers of the module are written here, all items, from their previous_ sides; a
                  buffer that no kernel writes in a step keeps its contents */
};

/* The interface through which an extension launches kernels at a point of the step. */
class Launches {
public:
  virtual ~Launches() = default;
  /* Launches a kernel of the extension's modules over the items of its row; does nothing if the kernel is for a feature
   * that the scene lacks. `values` and `slots` fill the VALUE and SLOT_ arguments of the row, in its order. Throws
   * InputError if the kernel belongs to no extension, the number of arguments is wrong, a slot has another type or
   * capacity for fewer items, a buffer of capacity NOTHING has not been written yet, or a buffer may not be written at
   * this point. */
  virtual void run(Kernel kernel, std::span<const uint32_t> values = {}, std::span<const Buffer> slots = {}) = 0;
  virtual const Settings &settings() const = 0;
};

struct Extension {
  const Module *module = nullptr; /* from the module's generated header; each at most once in a world */
  /* Runs once, when the world is made, to fill the module's buffers (World::write). Without it they start as zeros. */
  std::function<void(World &)> prepare;
  /* These functions may only launch: a step may be launched several times, and is recorded once without running. */
  std::vector<std::pair<StepPoint, std::function<void(Launches &)>>> launches;
};

} // namespace tandem
