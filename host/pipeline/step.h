/* step.h - the whole step as a list of launches; World calls it for each attempt of a step. */
#pragma once

#include <array>
#include <cstdint>

#include <tandem/settings.h>

#include "host/pipeline/substep_choice.h"
#include "host/runtime/launcher.h"

namespace tandem {

/* Whether all contacts keep the colours of the step before, so that a step needs no rounds of colouring and no colour
 * to spare. A world that takes this for granted runs the step again in which it ends; it therefore waits for so many
 * steps in a row that they outweigh one, and twice as long each time that it was wrong. */
struct SettledColors {
  uint32_t steps = 0; /* in a row that coloured nothing and had as many colours as the one before */
  uint32_t wait = 60;
  uint32_t colors = 0; /* of the last step */

  bool are_kept() const { return steps >= wait; }
  void note_step(uint32_t rounds, uint32_t now);
  void note_repetition();
};

/* What the host knows when it launches a step. It sizes launches but never changes results. If too few colours or
 * rounds are launched, the status says so, and the step runs again with more. */
struct StepPlan {
  Features features = 0;
  uint32_t bodies = 0;
  uint32_t capacity_pairs = 0;
  uint32_t capacity_cells = 0;
  uint32_t capacity_candidates = 0; /* of the broadphase trees */
  bool forces = false;              /* a program or a module applies forces to bodies */
  bool sleeping = false;            /* Settings::sleeping */
  bool drowsy = false;              /* some body had rested for long enough at the last step */
  bool sleepers = false;            /* some bodies sleep */
  bool other_sleepers = false;      /* than in their table, which the step makes anew */
  uint32_t island_rounds = 4;
  uint32_t colors = 16;           /* up to COLOR_LIMIT + 1: the overflow constraints */
  uint32_t joint_colors = 0;      /* COLOR_LIMIT + 1: there are overflow joints */
  uint32_t link_joint_colors = 0; /* the same of joints that hold links */
  uint32_t joint_axes = 0;        /* the most that a joint limits, drives or brakes */
  uint32_t coupling_colors = 0;   /* the same of couplings */
  uint32_t rounds = 16;
  SettledColors settled;
  bool links_alone = false;                  /* no body moves but links, so each contact has a link */
  bool trees_apart = false;                  /* nor has a world two articulations */
  bool apart = false;                        /* no pair was found for so long that a step looks for pairs alone */
  SubstepChoice substeps;                    /* if the world chooses them itself */
  bool islands_apart = false;                /* those that want more than the fewest substeps take more, others not */
  uint32_t classes = 0;                      /* of bodies that the solver moves then: shared/substep_classes.h */
  uint32_t wishes_left = sides_of_wishes;    /* of which steps of islands apart may have left some */
  bool forgets_wishes = true;                /* of an attempt that knew not all contacts, or other bodies */
  uint32_t hits = 0;                         /* that a cast has left on the device for kernels of modules */
  std::array<uint32_t, COUNT_TOTAL> known{}; /* counts after the last step */
};

void launch_step(Launcher &launcher, const StepPlan &plan, const Settings &settings);

} // namespace tandem
