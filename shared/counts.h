/* counts.h - the counts that only the device knows, in one array of uint.
 *
 * Counts stay on the device: the range of a kernel is [counts[first], counts[last]), so no stage waits for the host.
 * The host reads the array once, at the end of a step, because a blocking read after each stage would cost more than
 * most stages. */
#ifndef TANDEM_SHARED_COUNTS_H
#define TANDEM_SHARED_COUNTS_H

#include "shared/body_codes.h"

/* The number of colours of the constraint graph. Contacts past the last colour become overflow constraints
 * (solve/mass_split.h). Two words hold a bit for each colour. */
#define COLOR_LIMIT 63u
#define COLOR_OVERFLOW COLOR_LIMIT /* sort key of a constraint without a colour of its own */
/* Contacts of links (articulations/contact.h) are parted from others within each colour. Those of the last colour are
 * solved one after another, with those past it. */
#define LINK_COLORS (COLOR_LIMIT - 1u)
#define COLOR_NONE 254u     /* a touching pair without a colour yet */
#define COLOR_INACTIVE 255u /* a pair that does not touch, or one with a trigger */

#define COLOR_ENTRIES ((int)COLOR_LIMIT + 2) /* the start of each colour, start and end of the overflow constraints */
#if COLOR_LIMIT > 63u
#error "two words hold the colours of a body"
#endif

#define INDEX_NONE 0xffffffffu

enum {
  COUNT_ZERO,   /* the constant 0 */
  COUNT_ONE,    /* the constant 1 */
  COUNT_BODIES, /* bodies of the scene; set by the host */
  COUNT_BODIES_PLUS_ONE,
  COUNT_UNBOUNDED,  /* the first bodies: half-spaces; set by the host */
  COUNT_BOUNDED,    /* the bodies after them */
  COUNT_LARGE,      /* the first bodies, half-spaces among them, too large for a grid or a sweep; set by the host */
  COUNT_SMALL,      /* the bodies after them */
  COUNT_HIERARCHY,  /* leaves of the hierarchy of boxes: the bodies of finite bounds, or the large ones among them */
  COUNT_LEAVES,     /* leaves of the pyramid under it: a power of two, at least as many */
  COUNT_LEAF_TILES, /* nodes of that with TILE leaves each, at least 1 */
  COUNT_INSERTED,   /* leaves whose order is rebuilt in this step: none, or all (of the hybrid the large ones) */
  COUNT_INSERTED_LEAVES, /* leaves of the pyramid in a step that does so */
  COUNT_RAISED,          /* leaves above which boxes are rebuilt: all, or none */
  COUNT_ESCAPED,         /* leaves that no longer overlap the boxes they were inserted with */
  COUNT_KEPT, /* 1 while the data that a broadphase keeps from step to step are valid; cleared by the host when buffers
                 grow or bodies change */
  COUNT_HIERARCHY_KEPT,   /* 1 while the order of the hierarchy is valid */
  COUNT_PAIRS,            /* pairs kept: min(needed, capacity) */
  COUNT_PAIRS_NEEDED,     /* pairs found */
  COUNT_BODY_PAIRS,       /* in scenes with trees: pairs of bodies; the pairs are then those of their leaves */
  COUNT_PAIR_GROUP_ITEMS, /* TILE times the groups of pairs of bodies: midphase/subtree_pairs.h */
  CAPACITY_PAIRS,         /* capacity for pairs; also the stride of manifold and constraint rows */
  CAPACITY_CANDIDATES,    /* of the broadphase trees: capacity for pairs of fat boxes; the host writes both at once */
  COUNT_CACHED_PAIRS,     /* pairs of the last committed step */
  COUNT_CONSTRAINTS,      /* touching pairs, in colour order */
  COUNT_UNCOLORED,        /* touching pairs without a colour so far */
  COUNT_ROUNDS,           /* rounds that coloured something */
  COUNT_COLORS,           /* colours in use; COLOR_LIMIT + 1 if there are overflow constraints */
  COUNT_STATUS,           /* STATUS_ bits; 0: the step may be committed */
  COUNT_NONFINITE,        /* stage << 28 | body of the first non-finite body, INDEX_NONE if none */
  COUNT_COMMIT_BODIES,    /* range of the commit kernels: empty unless the status is 0 */
  COUNT_COMMIT_BODIES_PLUS_ONE,
  COUNT_COMMIT_PAIRS,
  COUNT_COMMIT_CONSTRAINTS,
  COUNT_JOINTS,           /* set by the host */
  COUNT_COMMIT_JOINTS,    /* these, as the other ranges of the commit */
  COUNT_BROKEN_JOINTS,    /* by the loads of the step: joints/loads.h */
  COUNT_COUPLINGS,        /* set by the host */
  COUNT_ARTICULATIONS,    /* set by the host */
  COUNT_COMMIT_COUPLINGS, /* these, as the other ranges of the commit */
  COUNT_GRID_X,           /* cells of the uniform grid along each axis */
  COUNT_GRID_Y,
  COUNT_GRID_Z,
  COUNT_CELLS,
  COUNT_CELLS_PLUS_ONE,
  CAPACITY_CELLS,
  CAPACITY_POINTS,      /* 4, or 1 where only balls touch: planes of the contact points of pairs (point_rows.h) */
  COUNT_SHARES,         /* four times the bodies: work-items of the windowed sweep; set by the host */
  COUNT_SWEEP_BLOCKS,   /* groups of it, of SWEEP_BLOCK bodies each */
  COUNT_SWEEP_ITEMS,    /* TILE times as many: a group a block */
  COUNT_HALVES,         /* twice the bodies: the two halves of the hybrid broadphase, the ends of boxes along an axis */
  COUNT_LEFT,           /* of the broadphase trees: 1 if a body left its fat box, 3 if a large one did */
  COUNT_LARGE_LEFT,     /* COUNT_LARGE if one of these did */
  COUNT_CHANGED,        /* all bodies if any did */
  COUNT_CANDIDATE_KEYS, /* new pairs of fat boxes, up to the capacity */
  COUNT_CANDIDATES_NEEDED, /* the most that any list of them needed */
  COUNT_CANDIDATE_SIDE,    /* 0 or 1: the current side of the kept list */
  COUNT_CHANGES,           /* pairs that came or went since the last launch of an incremental broadphase: min(found,
                              CAPACITY_PAIRS) */
  COUNT_CHANGES_FOUND,
  COUNT_SWEEP_AXIS,       /* axis of the sweep and prune: 0, 1 or 2 */
  COUNT_DIRECT_ISLANDS,   /* islands that the solver `direct` solved in the last pass of the step */
  COUNT_DIRECT_LEFT,      /* constraints it left to the iterative rows: their islands are too large, or not finite */
  COUNT_DIRECT_STALLED,   /* islands, over the passes of the step, whose solve did not reach its tolerance */
  COUNT_LENGTH,           /* length of a free-standing primitive (tests, benchmarks), of a batch of queries, or of
                             commands */
  COUNT_BODY_CONSTRAINTS, /* twice the constraints: each has two bodies */
  COUNT_OVERFLOW_BODY_CONSTRAINTS, /* twice the overflow constraints */
  COUNT_COLOR_STARTS,              /* always COLOR_LIMIT + 1: the colours and the overflow constraints */
  COUNT_BATCH_CELLS,               /* cells of a class for two-stage batching, a power of two; set by the host */
  COUNT_BATCH_ITEMS,               /* TILE times as many: a group a cell */
  COUNT_CONFLICTS,      /* constraints whose colour touches one of their moving bodies twice; filled by --check alone */
  COUNT_FIRST_CONFLICT, /* the first of them, INDEX_NONE if none */
  COUNT_MISBATCHED,     /* pairs that touch and stand in no batch or in several, or do not touch and stand in one */
  COUNT_FIRST_MISBATCHED,
  COUNT_ALL_BODIES,           /* COUNT_BODIES, which are awake, and those that sleep behind them; set by the host */
  COUNT_SLEEPERS,             /* those alone; set by the host */
  COUNT_SORTED_SLEEPERS,      /* entries of the table of sleepers that are sorted: sleeping/sleeper_table.h */
  COUNT_LISTED_SLEEPERS,      /* all of its entries; by the kernel that sorts, and by the host that appends */
  COUNT_SLEEPER_REACH,        /* bits of a float: the largest half extent of their boxes, m */
  COUNT_SLEEPER_PAIRS,        /* pairs of a body that is awake and one that sleeps, up to the capacity */
  COUNT_SLEEPER_PAIRS_NEEDED, /* those found */
  COUNT_TOUCHED_SLEEPERS,     /* those of them that have contacts */
  COUNT_DROWSY,               /* bodies that have rested for long enough to fall asleep */
  COUNT_ISLAND_ROUNDS,        /* rounds that changed a label of an island */
  COUNT_ISLANDS_OPEN,         /* 1 if more rounds might change one */
  COUNT_FALLING_ASLEEP,       /* bodies that fall asleep at the end of the step */
  COUNT_LOAD_RATE,       /* bits of a float, 1/s^2: square of the rate of substeps that loads need (setup/standing.h) */
  COUNT_SUBSTEP_CLASSES, /* FEW_SUBSTEPS | MANY_SUBSTEPS: those that bodies which may move have (substep_classes.h) */
  COUNT_MANY_BODIES,     /* dynamic bodies that take many substeps */
  COUNT_LATE_WISHES,     /* 1 if a body wants many that took few */
  COUNT_BRACED_LAYERS, /* of the highest stack that needs substeps because its bodies rest on several, in the first step
                          of a world; else 0 */
  COUNT_EVENTS,        /* of the step; 0 unless it was committed */
  COUNT_PAIR_EVENTS,   /* the same of pairs that come near, stay or leave */
  COUNT_MOVED,         /* bodies that the step has moved, with Settings::moved_bodies */
  KIND_START,          /* the start of each kind in pair_of_kind, and the end of the last one */
  /* The ranges of the bodies sorted by colour, stored as those of COLOR_START. */
  BODY_COLOR_START = KIND_START + PAIR_KIND_NONE + 1,
  COLOR_START = BODY_COLOR_START + COLOR_ENTRIES,
  /* In a batch of worlds: of each colour, the first constraint of a world that has overflow constraints
   * (batching/world_order.h). */
  WORLD_COLOR_START = COLOR_START + COLOR_ENTRIES,
  /* The ranges of the joints sorted by colour, stored as those of COLOR_START; set by the host. */
  JOINT_COLOR_START = WORLD_COLOR_START + (int)COLOR_LIMIT,
  /* The same of the joints that hold links (articulations/joint.h), which begin where the overflow joints end. */
  LINK_JOINT_COLOR_START = JOINT_COLOR_START + COLOR_ENTRIES - 1,
  /* The same of the couplings. */
  COUPLING_COLOR_START = LINK_JOINT_COLOR_START + COLOR_ENTRIES,
  /* Of each colour, the first contact of a link: articulations/colors.h. */
  LINK_COLOR_START = COUPLING_COLOR_START + COLOR_ENTRIES,
  /* Of each colour and of the overflow constraints, the first contact of bodies that take many substeps:
     batching/class_order.h. */
  MANY_COLOR_START = LINK_COLOR_START + (int)COLOR_LIMIT,
  COUNT_TOTAL = MANY_COLOR_START + (int)COLOR_LIMIT + 1
};

enum {
  STATUS_PAIRS = 1,       /* more pairs than capacity: grow and run the step again */
  STATUS_ROUNDS = 2,      /* colouring needs more rounds */
  STATUS_COLORS = 4,      /* more colours than were launched, or passes of overflow constraints where there are none */
  STATUS_NONFINITE = 8,   /* a body is not finite: quarantine it and run the step again */
  STATUS_ISLANDS = 16,    /* islands need more rounds */
  STATUS_WAKE = 32,       /* sleeping bodies were touched: wake their islands and run the step again */
  STATUS_SUBSTEPS = 64,   /* loads and stacks need more substeps, or other bodies need them than took them */
  STATUS_DEADLOCK = 128,  /* work-groups of a launch waited for each other in vain (cl/phases.cl) */
  STATUS_CANDIDATES = 256 /* more pairs of fat boxes than capacity, so that pairs may be missing */
};

/* The stage that first saw a body non-finite, in pipeline order. */
enum { NONFINITE_AT_START = 0, NONFINITE_IN_SOLVE = 1, NONFINITE_IN_INTEGRATE = 2 };

/* A flag beside the number of a manifold's points. It stays until a kernel of its own has followed the pair to its
 * impact (narrowphase/time_of_impact.h). */
#define TO_FOLLOW 8u

#endif
