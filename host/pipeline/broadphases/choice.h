/* choice.h - chooses the broadphase that suits a scene and the kind of backend that runs it: the meaning of
 * Broadphase::automatic. The choice changes no bit of a result. */
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include <tandem/backend.h>
#include <tandem/export.h>
#include <tandem/scene.h>
#include <tandem/settings.h>

namespace tandem {

struct BroadphaseChoice {
  Broadphase broadphase; /* not automatic */
  std::string why;       /* the statistics of the scene that decided it, in one line */
};

/* backend: as in --on. */
TANDEM_API BroadphaseChoice choose_broadphase(const Scene &scene, const std::string &backend);

/* What a world knows of its steps. */
struct BroadphaseHistory {
  std::optional<Broadphase> before; /* what ran so far; brute force comes back only when half as many bodies are left as
                                       made it go, so that a number that varies a little changes nothing */
  bool moving = false;              /* TreesTrial: most bodies keep leaving their boxes */
};

/* bodies: how many the broadphase looks at, which are fewer than the scene has where some sleep. */
TANDEM_API BroadphaseChoice choose_broadphase(const Scene &scene, size_t bodies, const std::string &backend,
                                              const BroadphaseHistory &history);

/* Whether brute force is still right, or still wrong, for so many bodies. It takes no look at the scene, and may be
 * asked in each step. */
TANDEM_API bool is_still_right(Broadphase broadphase, size_t bodies, const std::string &backend);

/* Whether trees pay on a CPU shows while they run: they save the search for bodies that stay in their boxes, and cost
 * twice a grid where all leave them and hardly any are near others, as in free fall. Where bodies crowd, a grid has
 * many in each cell, and costs more than trees that are built anew all the time. Trees are built anew when one body in
 * sixteen has moved by its own size, and when what they kept was dropped. Where that happens twice within `quiet` steps
 * of bodies that do not crowd, the grid takes over; trees are tried again later, each time after twice as many steps,
 * or when bodies crowd. All follows from counts, which are the same on every backend. */
class TANDEM_API TreesTrial {
public:
  static constexpr uint32_t quiet = 60, first_pause = 60, longest_pause = 3840; /* steps */
  /* Pairs a body: spheres that fall side by side have 2 to 5, people in a heap 8. */
  static constexpr double crowd = 6, dense_crowd = 7;

  bool pauses() const { return pause_ > 0; }
  void note_step(bool with_trees, bool rebuilt, double pairs_of_body);

private:
  uint32_t pause_ = 0, next_pause_ = first_pause;
  uint32_t since_rebuilt_ = quiet; /* so that the first building is none of two */
};

/* The structure that queries over so many bodies traverse, QUERY_ of body_codes.h: where brute force was chosen for the
 * few that are awake, queries find those asleep too. */
uint32_t query_structure_for(Broadphase chosen, size_t bodies, const std::string &backend);

/* The backend to choose for: the one that runs the stage. */
TANDEM_API const std::string &broadphase_backend(const Placement &placement);

} // namespace tandem
