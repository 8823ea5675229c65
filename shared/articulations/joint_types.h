/* joint_types.h - the joints of an articulation, for kernels and the host. */
#ifndef TANDEM_SHARED_ARTICULATIONS_JOINT_TYPES_H
#define TANDEM_SHARED_ARTICULATIONS_JOINT_TYPES_H

/*                        coordinate                    velocity (degrees of freedom)
 * TREE_JOINT_FIXED       none                          none
 * TREE_JOINT_HINGE       angle about x, rad            1: its rate
 * TREE_JOINT_SLIDER      way along x, m                1: its rate
 * TREE_JOINT_BALL        quaternion of frame b in a    3: angular velocity of b relative to a, in axes of frame a
 * TREE_JOINT_FREE        orientation and position      6: angular and linear velocity of the root, in axes of the world
 *
 * A free joint is that of a root alone, with both frames at the centre of the root, in its axes. */
enum { TREE_JOINT_FIXED, TREE_JOINT_HINGE, TREE_JOINT_SLIDER, TREE_JOINT_BALL, TREE_JOINT_FREE };

/* A word a link: its parent, and its joint above the shift. */
#define LINK_JOINT_SHIFT 24u
#define LINK_NO_PARENT 0xffffffu

/* So many trees of one shape lie beside each other, which are the work-items of a warp; others lie alone. A table has
 * room for all of them even if the last ones are missing: host/scene/tree_places.h. */
#define TREES_BESIDE 32u
/* The most contacts that a tree may have for itself (tree_contacts.h). */
#define TREE_COLORS 64u

/* The records of a link, in rows of four floats. */
enum {
  LINK_FRAME_A,             /* position of frame a from the parent's centre, in the parent's axes; armature */
  LINK_FRAME_A_ORIENTATION, /* in the parent's axes; of a root that is not free, in those of the world */
  LINK_FRAME_B,             /* position of frame b from the link's centre, in the link's axes; mass */
  LINK_FRAME_B_ORIENTATION, /* in the link's axes */
  LINK_MOMENTS,             /* principal moments; 1 where the drive of the joint is implicit (drives.h), else 0 */
  LINK_AXIS,                /* the drive and the limits of the axis of a joint as in shared/joints/axes.h */
  LINK_ROWS = LINK_AXIS + 2
};
/* The range and the targets of the axis are a row of their own, which a program may write in every step. */

enum {
  STATE_JOINT_POSITION, /* angle or way in x, or a quaternion */
  STATE_JOINT_VELOCITY, /* of a free root, the angular velocity */
  STATE_JOINT_FORCE,    /* N or N m, as the velocity is laid out */
  STATE_ROW_IMPULSE,    /* of the drive, the limits, friction; the coordinate at the start of the substep (rows.h) */
  STATE_MOMENT,         /* what pushes the link from outside: a moment, and a force at its centre; world axes */
  STATE_FORCE,
  STATE_ROWS
};

/* Words of a link: the freedoms of the joints between it and the root, its own among them (path.h). */
enum {
  PATH_BITS,            /* a bit each, in two words */
  PATH_FIRST_ENTRY = 2, /* how many there are before those of its own joint */
  PATH_FIRST_FREEDOM,   /* the number, within the tree, of the first of its own joint */
  PATH_WORDS
};
#define TREE_FREEDOMS 64u  /* of a tree that has a table of paths, at most */
#define PATH_ENTRY_ROWS 2u /* of that table, for each freedom of a path */

/* Of a tree: rows of its root. */
enum {
  ROOT_LINEAR_VELOCITY, /* of a free root */
  ROOT_LINEAR_FORCE,    /* and whether contacts have pushed in the substep: bodies.h */
  ROOT_START,           /* a linear velocity that is gone back to */
  ROOT_POSITION,        /* two rows, a double_float3: the centre of a free root, or frame a of another */
  ROOT_ROWS = ROOT_POSITION + 2
};

/* What a substep works with; nothing of it outlasts the substep. */
enum {
  WORK_ORIENTATION, /* of the link */
  WORK_OFFSET,      /* of its centre from ROOT_POSITION */
  WORK_FROM_PARENT, /* from the parent's centre to frame b */
  WORK_TO_CENTER,   /* from frame b to the link's centre; the implicit part of the joint's inertia (drives.h) */
  WORK_FRAME,       /* the axis x of frame a; of a ball, the quaternion of frame a in the world */
  WORK_START,       /* a joint velocity that is gone back to (free_motion.h) */
  WORK_VELOCITY,    /* two rows, of the centre: angular, linear */
  WORK_INERTIA = WORK_VELOCITY + 2, /* six rows: the articulated inertia, later its inverse (link_inertia.h) */
  WORK_FACTOR = WORK_INERTIA + 6,   /* four rows (factor.h) */
  WORK_PENDING = WORK_FACTOR + 4,   /* two rows (respond.h) */
  WORK_ACCELERATION = WORK_PENDING, /* until what is pending is found (loads.h) */
  WORK_CHANGE = WORK_PENDING + 2,   /* two rows: an acceleration, or a change of velocity */
  WORK_FORCE = WORK_CHANGE + 2,     /* two rows: a force, or an impulse */
  WORK_ROWS = WORK_FORCE + 2
};

#endif
