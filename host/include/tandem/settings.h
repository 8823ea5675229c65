/* settings.h - how a scene is simulated: time step, algorithms, tolerances. */
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <vector>

#include <tandem/export.h>
#include <tandem/module.h>

namespace tandem {

/* Kernels number rows of pairs with 32 bits, in up to 16 planes. */
constexpr uint32_t most_pairs = 1u << 28;

/* The choices of a setting, default first. Each has the name that the command gives it, with - for _. */
enum class TANDEM_API Solver : uint8_t { soft_step, pgs, nncg, xpbd, avbd, jacobi, direct };
enum class TANDEM_API Broadphase : uint8_t {
  grid,
  grid_bitonic,
  grid_14,
  brute_force,
  sap,
  sap_pca,
  sap_plain,
  sap3,
  hybrid,
  bvh,
  bvh_stack,
  bvh_history,
  trees,
  automatic /* "auto": as the scene suggests */
};
enum class TANDEM_API Bounds : uint8_t { affine, tight };
enum class TANDEM_API Midphase : uint8_t { walk, subtrees };
enum class TANDEM_API Narrowphase : uint8_t { sat, gjk_epa, gjk_sampled, sat_split, cube_map };
enum class TANDEM_API Support : uint8_t { brute_force, hill_climbing, cube_map };
enum class TANDEM_API Batching : uint8_t { coloring, sequential, single_group, iterative, two_stage };

template <class T>
concept Choice = std::same_as<T, Solver> || std::same_as<T, Broadphase> || std::same_as<T, Bounds> ||
    std::same_as<T, Midphase> || std::same_as<T, Narrowphase> || std::same_as<T, Support> || std::same_as<T, Batching>;

/* "soft-step". InputError if it is none of the enum's values. */
template <Choice T> TANDEM_API const char *name_of(T choice);
/* The choice of this name. InputError lists those that there are. */
template <Choice T> TANDEM_API T parse_setting(const std::string &name);
/* Default first; of broadphases without automatic. */
template <Choice T> TANDEM_API std::vector<T> choices();
template <Choice T> TANDEM_API std::vector<std::string> choice_names();

/* Every choice that changes the result. */
struct Settings {
  float step = 1.0f / 60.0f; /* s, > 0 */
  uint32_t substeps = 4;     /* 1 .. 1000 */
  uint32_t iterations = 1;   /* solver passes a substep, 1 .. 1000 */
  Solver solver = Solver::soft_step;
  Broadphase broadphase = Broadphase::grid; /* which of host/pipeline/broadphases/; changes no bit */
  Bounds bounds = Bounds::affine;           /* tight: from the support map; other pairs, so other bits */
  Midphase midphase = Midphase::walk; /* how the trees of meshes and compounds are walked; the same list either way */
  Narrowphase narrowphase = Narrowphase::sat; /* of shapes without a test of their own */
  Support support = Support::brute_force;     /* how hulls find their farthest vertex; cube_map alone is not exact */
  uint32_t support_cells = 16;                /* along a side of the cube maps, 1 .. 256 */
  Batching batching = Batching::coloring;
  bool check = false;  /* prove the batches of every step (shared/batching/check.h); changes no result */
  bool events = false; /* list which pairs begin, go on and cease to touch (World::contact_events); changes no motion */
  bool pair_events =
      false; /* list which pairs of bodies come near, stay so and leave (World::pair_events); changes no motion */
  uint32_t max_pairs =
      most_pairs;         /* 1 .. most_pairs: a step that needs room for more fails, and memory never grows past them */
  bool specialise = true; /* false: every feature built and run, same bits */

  std::vector<Extension> extensions; /* modules of kernels besides the pipeline's, and where in the step they run */

  float contact_hertz = 60.0f;         /* Hz, stiffness of soft contacts; at most a fifth of the substep rate */
  float contact_damping_ratio = 10.0f; /* overdamped, so that pushing apart adds no bounce */
  float push_speed = 3.0f;             /* m/s, penetration is never removed faster */
  float slop = 0.005f;                 /* m, penetration left in place so that contacts persist */
  float slop_share = 0.05f;            /* of the smallest half extent of a pair: the slop is never more than that */
  float restitution_speed = 1.0f;      /* m/s, slower impacts do not bounce */
};

/* The defaults with the substeps and iterations that this solver wants. */
TANDEM_API Settings settings_for(Solver solver);

/* InputError if a number is out of range or a choice none of its enum's values. */
TANDEM_API void validate(const Settings &settings);

} // namespace tandem
