/* sleeping.h - the launches by which islands fall asleep and are woken: those of the step, and those between two steps
 * that move rows of bodies and cached pairs (shared/sleeping/). */
#pragma once

#include <span>

#include "host/pipeline/step_launches.h"

namespace tandem {

/* Sorts the boxes of the bodies that sleep, for find_near_sleepers: makes their table anew. */
void list_sleepers(StepLaunches &step);
/* Appends to the table the bodies from counts[COUNT_BODIES] to counts[COUNT_LENGTH], so many. */
void append_sleepers(StepLaunches &step, uint32_t fallen);
/* Gives the bodies of move_from, counts[COUNT_LENGTH] of them, their new places in the table, at most `most`; those
 * below `awake` have none there. */
void renumber_sleepers(Launcher &launcher, uint32_t awake, uint32_t most);
/* Lists the pairs of a body that is awake and a sleeper near it, as the step's pairs. */
void find_near_sleepers(StepLaunches &step);
/* Finds which bodies take many substeps: all of an island of which one wishes for them (shared/sleeping/wishes.h). */
void part_islands(StepLaunches &step);
/* Counts for how long bodies have rested, and chooses those that fall asleep. */
void find_drowsy_islands(StepLaunches &step);

/* A buffer with a row for each body or joint, and where its rows are to be written. */
struct BodyRows {
  Buffer from;
  std::vector<Buffer> to;
};
/* Moves the rows listed in move_from to the places in move_to; counts[length] of them, at most `most`. */
void move_body_rows(Launcher &launcher, const BodyRows &rows, uint32_t length, uint32_t most);

/* The same of a buffer of planes, each of so many elements. */
struct Planes {
  uint32_t count, stride;
};
void move_planes(Launcher &launcher, const BodyRows &rows, const Planes &planes, uint32_t length, uint32_t most);

/* Computes the new places of the bodies, of which some fall asleep, and of the cached pairs. */
void place_awake_first(StepLaunches &step, uint32_t cached_pairs);
/* Copies rows of cached pairs to their new places in another buffer. cached_pairs: at COUNT_LENGTH. */
void move_pair_rows(Launcher &launcher, Buffer from, Buffer to, uint32_t cached_pairs);

} // namespace tandem
