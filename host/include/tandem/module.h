/* module.h - kernels of your own, in the step or between steps; docs/your-own-kernel.md is the way in.
 *
 * A module is a list of kernels and a list of buffers, written like the pipeline's: one C99 function a kernel, which
 * then runs on every backend with the same bits, is placed, profiled, stepped in gdb and compared like ours. The CMake
 * function tandem_add_module() makes a library of it, whose header names the module, its kernels and its buffers. An
 * Extension in Settings::extensions brings it into a world and says at which points of the step it launches what.
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

/* By the name in its list, the pipeline's too: buffers for World::read and for slots. InputError if there is none. */
TANDEM_API Kernel kernel_named(const std::string &name);
TANDEM_API Buffer buffer_named(const std::string &name);

/* Where in a step an extension may launch, in the order of the step. A step that overflows runs again from its begin.
 * Inside a step, therefore, kernels write SCRATCH alone (the pipeline's solver_ and manifold_ buffers are), or KEPT,
 * which decides no bit. What lasts is written at the commit, over COMMIT_ items: an attempt that runs again has none.
 */
enum class StepPoint : uint8_t {
  begin,       /* bodies are prepared: solver_velocity and solver_inertia are as the last step left the bodies */
  pairs,       /* pair_a and pair_b list the pairs that may touch, sorted */
  contacts,    /* manifolds are final: a kernel may drop or change them before they become constraints */
  constraints, /* constraints stand in the order of their colours */
  forces,      /* in each substep, before gravity: what is added to solver_velocity is pushed along */
  solved,      /* solver_velocity and solver_delta_pose are the step's result, not checked yet */
  commit       /* STATE and CACHE buffers of the module are written, all items, from their previous_ sides; what no
                  kernel writes in a step stays as it was */
};

/* What an extension is given at a point of the step. */
class Launches {
public:
  virtual ~Launches() = default;
  /* A kernel of the extension's modules over the items of its row; nothing if it is for a feature that the scene lacks.
   * values, slots: for the VALUE and SLOT_ arguments of the row, in its order. InputError says what does not fit: a
   * kernel of no extension, other numbers of arguments, a slot of another type or with room for fewer items, a buffer
   * of capacity NOTHING before it is written, what may not be written here. */
  virtual void run(Kernel kernel, std::span<const uint32_t> values = {}, std::span<const Buffer> slots = {}) = 0;
  virtual const Settings &settings() const = 0;
};

struct Extension {
  const Module *module = nullptr; /* as its header gives it; each at most once in a world */
  /* Once, when the world is made: fills the module's buffers (World::write). Empty: they begin as zeros. */
  std::function<void(World &)> prepare;
  /* A step may be launched several times, and is once launched without running: these only launch. */
  std::vector<std::pair<StepPoint, std::function<void(Launches &)>>> launches;
};

} // namespace tandem
