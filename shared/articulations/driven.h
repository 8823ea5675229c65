/* driven.h - links that a spring or motor of their joint moves do not rest, however slowly they move: as
 * shared/joints/driven.h has it for other joints. One such link keeps its whole articulation awake. */
#ifndef TANDEM_SHARED_ARTICULATIONS_DRIVEN_H
#define TANDEM_SHARED_ARTICULATIONS_DRIVEN_H

#include "shared/articulations/bodies.h"
#include "shared/joints/driven.h"

/* The drive of a ball pulls frame b towards frame a. */
SHARED uint ball_drive_moves(GLOBAL const Parameters *parameters, const articulation *t, tree_link l,
                             const joint_axis *axis)
{
  vec3 speed = xyz(load_state(t, l.k, (uint)STATE_JOINT_VELOCITY)),
       open = rotation_vector(quat_from(load_state(t, l.k, (uint)STATE_JOINT_POSITION)));
  return axis->stiffness > R(0.0) && dot3(speed, open) < R(0.0) &&
                 length_of(speed) > SLOWEST_DRIVE * parameters->sleep_speed
             ? 1u
             : 0u;
}

SHARED uint drive_of_link_moves(GLOBAL const Parameters *parameters, const articulation *t, tree_link l)
{
  joint_axis axis = load_tree_axis(t, l);
  if (l.is_ball) return ball_drive_moves(parameters, t, l, &axis);
  if (!has_one_freedom(l)) return 0u;
  axis_row r;
  r.at.value = load_state(t, l.k, (uint)STATE_JOINT_POSITION).x;
  r.speed = load_state(t, l.k, (uint)STATE_JOINT_VELOCITY).x;
  return drive_moves(parameters, &r, &axis);
}

/* An item is a tree. */
SHARED void disturb_driven_links_item(GLOBAL const Parameters *parameters, read_links links, write_link_states states,
                                      GLOBAL uint *rest_count, uint i)
{
  articulation t = articulation_at(links, states, i);
  for (uint k = 0u; k < t.links; ++k)
    if (drive_of_link_moves(parameters, &t, tree_link_of(&t, k))) rest_count[body_of_link(links, &t, k)] = 0u;
}

#endif
