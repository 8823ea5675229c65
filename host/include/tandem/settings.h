/* settings.h - how a scene is simulated: time step, algorithms, tolerances. */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tandem/export.h>
#include <tandem/module.h>

namespace tandem {

/* Kernels number rows of pairs with 32 bits, in up to 16 planes. */
constexpr uint32_t most_pairs = 1u << 28;

/* Every choice that changes the result. Names are those of the command's options. */
struct Settings {
  float step = 1.0f / 60.0f; /* s, > 0 */
  uint32_t substeps = 4;     /* 1 .. 1000 */
  uint32_t iterations = 1;   /* solver passes a substep, 1 .. 1000 */
  std::string solver = "soft-step";
  std::string broadphase =
      "grid"; /* which of host/pipeline/broadphases/, or auto: as the scene suggests; changes no bit */
  std::string bounds = "affine";       /* tight: from the support map; other pairs, so other bits */
  std::string midphase = "walk";       /* how the trees of meshes and compounds are walked; the same list either way */
  std::string narrowphase = "sat";     /* of shapes without a test of their own */
  std::string support = "brute-force"; /* how hulls find their farthest vertex; cube-map alone is not exact */
  uint32_t support_cells = 16;         /* along a side of the cube maps, 1 .. 256 */
  std::string batching = "coloring";   /* coloring, sequential, single-group, iterative, two-stage */
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

/* The accepted names, default first; --help and error messages list them. */
TANDEM_API std::vector<std::string> solver_names();
TANDEM_API std::vector<std::string> broadphase_names(); /* without auto */
TANDEM_API std::vector<std::string> bounds_names();
TANDEM_API std::vector<std::string> midphase_names();
TANDEM_API std::vector<std::string> narrowphase_names();
TANDEM_API std::vector<std::string> support_names();
/* CONVEX_ in the low byte, SUPPORT_ in the next: what the kernels of convex shapes take. */
TANDEM_API uint32_t narrowphase_method(const Settings &settings);
TANDEM_API uint32_t cube_map_cells(const Settings &settings); /* support_cells; 0 where no cube map is used */
TANDEM_API std::vector<std::string> batching_names();

/* The defaults with the substeps and iterations that this solver wants. InputError lists the names. */
TANDEM_API Settings settings_for(const std::string &solver);

/* InputError if a number is out of range or a name unknown. */
TANDEM_API void validate(const Settings &settings);

/* Which backend runs what: one for all, and exceptions by stage ("narrowphase") or kernel name. */
struct Placement {
  std::string on = "tbb";
  std::vector<std::pair<std::string, std::string>> exceptions; /* STAGE-or-kernel, backend */
  bool allow_inexact = false;                                  /* accept a device whose results may differ in bits */
};

/* "STAGE=B,STAGE=B": a part without '=' continues the backend before it (tbb:threads=2,lanes=4 has '='
 * too, so its options are told apart by their names). InputError on unknown stages. */
TANDEM_API std::vector<std::pair<std::string, std::string>> parse_placement(const std::string &text);

} // namespace tandem
