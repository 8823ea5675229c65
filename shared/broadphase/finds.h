/* finds.h - the first few that a search finds, kept from the kernel that counts them for the one that writes them: most
 * bodies have few neighbours, and need not look for them twice. */
#ifndef TANDEM_SHARED_BROADPHASE_FINDS_H
#define TANDEM_SHARED_BROADPHASE_FINDS_H

#include "shared/broadphase/overlap.h"

#define FINDS_KEPT 8u

/* find: how many item i found before. */
SHARED void keep_find(GLOBAL uint *finds, uint i, uint find, uint body)
{
  if (find < FINDS_KEPT) finds[FINDS_KEPT * i + find] = body;
}

#endif
