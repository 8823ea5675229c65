/* pgs.h - projected Gauss-Seidel on velocities, row by row, a batch at a time.
 *
 * The order of rows follows the talks, where a constraint solver is two kernels over all batches, contact and
 * friction ("GPU Rigid Body Simulation", 2013; GS-4150, 2013; solving in batches and warm starting from cached
 * contacts: "OpenCL Game Physics", 2009). One sweep is
 *
 *     for each colour: for each manifold: point 0, point 1, point 2, point 3    pgs_normals
 *     for each colour: for each manifold: twist, then the cone of sliding       pgs_friction
 *
 * so friction always meets the normal impulses of its own sweep. Each point is a row of its own: it sees what the
 * points before it did to the bodies. Only the cone differs from the talks, which clamp two tangents each by itself.
 *
 *     normal:    impulse = max(impulse - mass (speed + bias), 0)
 *     ahead      bias = s / h             the gap s may close within the substep, and no more
 *     in overlap bias = share (s + slop) / h, at most the push speed (Baumgarte)
 *
 * Baumgarte's bias alone would leave bodies with the speed that drove them apart. So the bodies move with it, and
 * sweeps without it follow: what it added is taken out again, and the impulses kept for the next step are those of
 * the forces alone.
 */
#ifndef TANDEM_SHARED_SOLVE_PGS_H
#define TANDEM_SHARED_SOLVE_PGS_H

#include "shared/solve/contact.h"

/* How much of an overlap a substep removes. */
#define PGS_BIAS_SHARE R(0.2)

/* The new accumulated impulse of a normal row. Without bias a point still ahead that has carried nothing stays so, for
 * the motion it would limit comes later. */
SHARED real pgs_impulse(GLOBAL const Parameters *parameters, real slop_or_deep, real separation, real speed, real mass,
                        real old, uint biased)
{
  mask ahead = separation > R(0.0);
  real overlap = minimum(separation + slop_of(slop_or_deep), R(0.0));
  real push = maximum(PGS_BIAS_SHARE * parameters->inverse_substep * overlap, -push_limit(parameters, slop_or_deep));
  real bias = choose(ahead, separation * parameters->inverse_substep, biased != 0u ? push : (real)R(0.0));
  real impulse = maximum(old - mass * (speed + bias), R(0.0));
  return biased != 0u ? impulse : choose(ahead & (old == R(0.0)), old, impulse);
}

SHARED void pgs_normals_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                             GLOBAL const row *solver_inertia, GLOBAL const row *solver_delta,
                             GLOBAL const uint *counts, GLOBAL row *constraint_normal_impulse,
                             GLOBAL row *constraint_bounce, GLOBAL row *solver_velocity, uint pass, item_index i)
{
  uint biased = pass == PASS_BIASED ? 1u : 0u;
  uint stride = counts[CAPACITY_PAIRS];
  contact c = load_contact(contacts, solver_velocity, solver_inertia, i);
  vec4 old = load_row(constraint_normal_impulse, i);
  drift moved = load_drift(solver_delta, c);
  arm_shift shift = shift_of_contact(c, moved.translation);
  real closed = inner(c.normal, moved.translation);
  real slop = load_real(patches.slop, i);
  real impulse[4];
  for (uint k = 0; k < 4u; ++k) {
    vec4 point_a = load_row(patches.points, stride * k + i), point_b = load_row(patches.points, stride * (k + 4u) + i);
    vec3 turn_a = outer(add(xyz(point_a), shift.a), c.normal), turn_b = outer(add(xyz(point_b), shift.b), c.normal);
    real separation = point_a.w + closed + (inner(turn_b, moved.rotation_b) - inner(turn_a, moved.rotation_a));
    real before = component(old, (natural)k);
    impulse[k] =
        pgs_impulse(parameters, slop, separation, speed_along(c, c.normal, turn_a, turn_b), point_b.w, before, biased);
    c = apply_impulse(c, c.normal, turn_a, turn_b, impulse[k] - before);
  }
  vec4 pressed = make_vec4(impulse[0], impulse[1], impulse[2], impulse[3]);
  store_row(constraint_normal_impulse, i, pressed);
  if (HAS_FEATURE(parameters, RESTITUTION))
    store_row(constraint_bounce, stride + i, highest_impulses(load_row(constraint_bounce, stride + i), pressed));
  store_contact_motion(solver_velocity, c);
}

SHARED void pgs_friction_item(read_contacts contacts, GLOBAL const row *constraint_center,
                              GLOBAL const row *constraint_normal_impulse, GLOBAL const row *solver_inertia,
                              GLOBAL const row *solver_delta, GLOBAL const uint *counts,
                              GLOBAL row *constraint_friction_impulse, GLOBAL row *solver_velocity, item_index i)
{
  contact c = load_contact(contacts, solver_velocity, solver_inertia, i);
  mask rough = c.friction > R(0.0);
  if (!any_of(rough)) return;
  vec4 pushes = load_row(constraint_normal_impulse, i);
  real pressure = (pushes.x + pushes.y) + (pushes.z + pushes.w);
  mask stale = rough & (!rough); /* pgs_masses has just made them */
  solved sliding = solve_friction(c, stale, load_arm_shift(solver_delta, c), load_row(constraint_center, i),
                                  load_row(constraint_center, counts[CAPACITY_PAIRS] + i),
                                  load_row(constraint_friction_impulse, i), pressure);
  store_row_if(rough, constraint_friction_impulse, i, sliding.impulse);
  store_contact_motion(solver_velocity, with_motion_if(rough, c, sliding.c));
}

/* Effective masses where the bodies are now. Many sweeps over masses of another place do not converge: where a long
 * body has turned, a row whose mass is more than twice what it should be doubles its error every sweep. */
SHARED void pgs_masses_item(read_contacts contacts, read_solver_bodies solver_bodies, GLOBAL const uint *counts,
                            GLOBAL row *constraint_points, GLOBAL row *constraint_center, item_index i)
{
  uint stride = counts[CAPACITY_PAIRS];
  contact c = load_contact(contacts, solver_bodies.velocity, solver_bodies.inertia, i);
  body_pair bodies = bodies_of(c);
  arm_shift shift = load_arm_shift(solver_bodies.delta, c);
  for (uint k = 0; k < 4u; ++k) {
    vec4 point_b = load_row(constraint_points, stride * (k + 4u) + i);
    vec3 arm_a = add(xyz(load_row(constraint_points, stride * k + i)), shift.a), arm_b = add(xyz(point_b), shift.b);
    real mass = inverse_or_zero(response(bodies, arm_a, arm_b, c.normal, c.normal));
    store_row(constraint_points, stride * (k + 4u) + i,
              extend(xyz(point_b), choose(point_b.w > R(0.0), mass, (real)R(0.0))));
  }
  vec3 center_a = xyz(load_row(constraint_center, i)), center_b = xyz(load_row(constraint_center, stride + i));
  store_row(constraint_center, i,
            extend(center_a, friction_mass(bodies, add(center_a, shift.a), add(center_b, shift.b), c.normal)));
  store_row(constraint_center, stride + i, extend(center_b, twist_mass(bodies, c.normal)));
}

#endif
