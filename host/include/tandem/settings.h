/* settings.h - how a scene is simulated: time step, algorithms, tolerances and the modules that take part. World reads
 * it once, when it is made; <tandem/backend.h> says where its kernels run. */
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <string>
#include <vector>

#include <tandem/export.h>
#include <tandem/module.h>

namespace tandem {

/* Kernels index pairs with 32 bits, in up to 16 planes. */
constexpr uint32_t most_pairs = 1u << 28;

/* The choices of a setting, the default first, but that of Broadphase last. The name of each is that of the command,
 * with - for _. */
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
  automatic /* "auto", the default: chosen from the statistics of the scene, and anew as bodies come and go */
};
enum class TANDEM_API Bounds : uint8_t { affine, tight };
enum class TANDEM_API Midphase : uint8_t { walk, subtrees };
enum class TANDEM_API Narrowphase : uint8_t { sat, gjk_epa, gjk_sampled, sat_split, cube_map };
enum class TANDEM_API Support : uint8_t { brute_force, hill_climbing, cube_map };
enum class TANDEM_API Batching : uint8_t { coloring, sequential, single_group, iterative, two_stage };

template <class T>
concept Choice = std::same_as<T, Solver> || std::same_as<T, Broadphase> || std::same_as<T, Bounds> ||
    std::same_as<T, Midphase> || std::same_as<T, Narrowphase> || std::same_as<T, Support> || std::same_as<T, Batching>;

/* The name of a choice, such as "soft-step". Throws InputError if it is none of the enum's values. */
template <Choice T> TANDEM_API const char *name_of(T choice);
/* The choice of this name. Throws InputError with a list of all names if there is none. */
template <Choice T> TANDEM_API T parse_setting(const std::string &name);
/* All choices, the default first; those of Broadphase without its default `automatic`. */
template <Choice T> TANDEM_API std::vector<T> choices();
template <Choice T> TANDEM_API std::vector<std::string> choice_names();

/* A value of Settings::substeps: each step takes as many as loads and stacks need (docs/stability.md). */
constexpr uint32_t automatic_substeps = UINT32_MAX;

/* All choices that can change the result, and those that change only the cost. */
struct Settings {
  float step = 1.0f / 60.0f; /* s, > 0. It also sets how far ahead contacts are made, which slop has the rule of */
  uint32_t substeps = 4;     /* 1 .. 1000, or automatic_substeps */
  uint32_t iterations = 1;   /* solver passes a substep, 1 .. 1000 */
  Solver solver = Solver::soft_step;
  Broadphase broadphase = Broadphase::automatic; /* one of host/pipeline/broadphases/; changes no bit */
  Bounds bounds = Bounds::affine;     /* tight: from the support map; finds other pairs, so the bits differ */
  Midphase midphase = Midphase::walk; /* traversal of the trees of meshes and compounds; both give the same list */
  Narrowphase narrowphase = Narrowphase::sat; /* for pairs of shapes without a test of their own */
  Support support = Support::brute_force;     /* how the farthest vertex of a hull is found; only cube_map is
                                                 approximate */
  uint32_t support_cells = 16;                /* along a side of the cube maps, 1 .. 256 */
  Batching batching = Batching::coloring;
  bool check = false;  /* checks the batches of every step (shared/batching/check.h); changes no result */
  bool events = false; /* lists the pairs that begin, continue and cease to touch (World::contact_events); changes no
                          motion */
  bool pair_events =
      false; /* lists pairs whose bounds begin, continue and cease to overlap (World::pair_events); changes no motion */
  bool sleeping = false;     /* islands of bodies at rest fall asleep and cost nothing (docs/worlds.md) */
  float sleep_speed = 0.05f; /* m/s, > 0: a body rests while no point of it is faster; bodies smaller than 0.5 m in
                                radius in proportion */
  float sleep_time = 0.5f;   /* s, > 0: bodies that have rested for so long fall asleep with their island */
  bool moved_bodies = false; /* lists the bodies that each step moves (World::moved_bodies); changes no motion */
  /* World::read_joints tells the forces of the joints of articulations, too; changes no motion. */
  bool tree_joint_forces = false;
  uint32_t max_pairs =
      most_pairs;         /* 1 .. most_pairs: a step with more pairs fails, so memory never grows beyond them */
  bool specialise = true; /* false: every feature is built and run, with the same bits */

  std::vector<Extension> extensions; /* modules of kernels besides the pipeline's, and where they run in the step */

  float contact_hertz = 60.0f;         /* Hz, frequency of soft contacts; at most a fifth of the substep rate is used */
  float contact_damping_ratio = 10.0f; /* overdamped, so that the removal of penetration adds no bounce */
  float joint_hertz = 60.0f;           /* Hz, frequency of soft joints; used up to joint_hertz_of(); without meaning
                                          for xpbd */
  float joint_damping_ratio = 2.0f;
  float push_speed = 3.0f; /* m/s, the largest speed at which penetration is removed */
  /* m, penetration left in place so that contacts persist. Contacts are made ahead of touching, up to a gap along their
   * normal of
   *
   *   slop * clamp(240 Hz * step, 1, 4)  +  step * (the speed at which the gap closes + each body's spin * its radius)
   *
   * which for bodies at rest is 20 mm at 1/60 s and longer, 10 mm at 1/120 s, and 5 mm at 1/240 s and shorter. Neither
   * the gravity of the step nor the spin of a ball adds to it, and a gap that the motion of the step plainly does not
   * close may have none. So shorter steps have fewer contacts that touch nothing. */
  float slop = 0.005f;
  float slop_share = 0.05f;       /* of the smallest half extent of a pair: an upper limit of its slop */
  float restitution_speed = 1.0f; /* m/s, slower impacts have no restitution */
  float hit_speed = 1.0f;         /* m/s, >= 0: contacts that begin slower are no hits (World::hit_events) */
};

/* The frequency that soft joints have, Hz: at most 0.28 of the substep rate, because some trees of links tremble from
 * 0.3 on. The substeps must be a number. */
inline double joint_hertz_of(const Settings &settings)
{
  return std::min<double>(settings.joint_hertz, 0.28 * settings.substeps / static_cast<double>(settings.step));
}

/* The defaults with the substeps and iterations that suit this solver. */
TANDEM_API Settings settings_for(Solver solver);

/* Whether it solves couplings; other solvers refuse a scene that has some. All solve joints. */
TANDEM_API bool solves_couplings(Solver solver);

/* Throws InputError if a number is out of range or a choice is none of its enum's values. */
TANDEM_API void validate(const Settings &settings);

} // namespace tandem
