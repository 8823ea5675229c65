/* follow_boxes.h - follows pairs of boxes that may pass each other within the step to their impact.
 *
 *   collide_box_box -> follow_boxes: the contacts of the impact, those of the start, or none
 *
 * It is a kernel of its own because it needs twice the registers of collide_box_box, which would slow all pairs down.
 * Few pairs are followed, so a group first gathers them (followed_pairs.h).
 */
#ifndef TANDEM_SHARED_NARROWPHASE_FOLLOW_BOXES_H
#define TANDEM_SHARED_NARROWPHASE_FOLLOW_BOXES_H

#include "shared/narrowphase/box_box.h"
#include "shared/narrowphase/followed_pairs.h"
#include "shared/narrowphase/middle_ball.h"

/* The impact of two boxes. A gap along any of the fifteen axes separates the boxes, so the best axis serves. Edges are
 * sharp here, because rounded ones would not meet. The axis turns with the box whose face it is normal to. */
SHARED advancement impact_of_boxes(mask reached, box_pair start, real slop, pair_motion moves, toi_input input)
{
  vec3 turning_a = moves.a.angular, turning_b = moves.b.angular;
  real seen_by_a = acceleration_beside(moves, start.offset, input.horizon, turning_a, turning_b, moves.radius_b);
  real seen_by_b = acceleration_beside(moves, start.offset, input.horizon, turning_b, turning_a, moves.radius_a);
  advancement at = start_advancement(reached);
  for (uint round = 0u; round < ADVANCEMENT_ROUNDS && any_of(at.active); ++round) {
    box_pair then = boxes_after(start, moves, at.time),
             now = along_best_axis(then, then.offset, slop, R(0.0), NEVER_ALONG);
    mask face_of_b = (now.code >= 3u) & (now.code < 6u);
    real acceleration = choose(face_of_b, seen_by_b, seen_by_a), span = span_of(at, now.gap, acceleration, input);
    vec3 normal_then = rotate(turn_within(choose3(face_of_b, moves.b.angular, moves.a.angular), span), now.normal);
    real gap_then = gap_of_boxes_along(boxes_after(start, moves, at.time + span), normal_then);
    real chord = free_by_chord(now.gap, gap_then, span, acceleration, input);
    at = advanced(at, round, now.gap, closing_speed(moves, now.normal), chord, input);
  }
  return at;
}

/* Adds the middle ball of a box that hits a face of the other box while its middle is in front of that face. then: the
 * boxes at the impact. */
SHARED manifold with_middle_of_box_if(mask wanted, manifold m, box_pair then, pair_motion moves)
{
  ball_owner owner = owner_of_ball(moves);
  wanted = wanted & (owner.in_a | owner.in_b);
  if (!any_of(wanted)) return m;
  vec3 middle = choose3(owner.in_a, make_vec3(R(0.0), R(0.0), R(0.0)), then.offset),
       outward = choose3(owner.in_a, negate(m.normal), m.normal);
  vec3 from_wall = choose3(owner.in_a, negate(then.offset), then.offset);
  oriented_box wall = choose_box(owner.in_a, then.b, then.a);
  vec3 extent = choose3(owner.in_a, then.a.extent, then.b.extent);
  box_frame face = frame_of(wall, most_parallel_axis(wall, outward));
  real side = sign_of(dot3(face.axis, outward)), height = side * dot3(face.axis, from_wall) - face.extent;
  mask past_u = magnitude(dot3(face.u, from_wall)) >= face.extent_u,
       past_v = magnitude(dot3(face.v, from_wall)) >= face.extent_v,
       beside = side * dot3(face.axis, outward) < WITH_FACE;
  return with_middle_ball_if(wanted & (!(past_u | past_v | beside)), m, middle, outward, height,
                             CORE_SHARE * least_of(extent));
}

/* Boxes without a contact at the start are followed only because they may meet from beside. */
SHARED speculation speculation_of_boxes(GLOBAL const Parameters *parameters, manifold start, const moving_boxes *pair)
{
  speculation s = speculation_of(parameters, start, pair->boxes.offset, pair->moves, pair->input, pair->least);
  mask from_beside = !has_points(start);
  s.asked = s.asked | from_beside;
  s.reached = s.reached | from_beside;
  return s;
}

/* Whether a pair keeps its contacts of the start. A pair that does not move far, and overlaps at the end of its motion,
 * has met within the step and keeps them (encounter_of); so do nearly all pairs that come to rest. */
SHARED mask keeps_start(GLOBAL const Parameters *parameters, mask wanted, const moving_boxes *pair, manifold start)
{
  mask asked = wanted & (!pair->input.far) & has_points(start);
  if (!any_of(asked)) return asked;
  box_pair end = boxes_after(pair->boxes, pair->moves, pair->input.horizon);
  real gap = along_best_axis(end, end.offset, parameters->slop, R(0.0), NEVER_ALONG).gap;
  return asked & (gap <= pair->input.touching);
}

/* The manifold at the impact. If only edges that count as rounded off meet, or a face just beside the other one, the
 * manifold is empty until slightly later, when the boxes overlap more; a second attempt is made then. met.time becomes
 * the time of the manifold, and `then` receives the boxes at that time. */
SHARED manifold contact_at_impact(GLOBAL const Parameters *parameters, const moving_boxes *pair, encounter *met,
                                  box_pair *then)
{
  manifold m;
  mask attempted = met->at_impact;
  for (uint attempt = 0u; attempt < 2u; ++attempt) {
    real most = attempt == 0u ? (real)FAR_APART : pair->input.touching;
    *then = boxes_after(pair->boxes, pair->moves, choose(met->at_impact, met->time, (real)R(0.0)));
    *then = along_best_axis(*then, then->offset, parameters->slop, pair->rounded, NEARLY_ALONG);
    manifold found = boxes_contact(parameters, attempted & (then->gap <= most), *then, pair->moves);
    if (attempt == 0u) m = found;
    else m = choose_manifold(attempted, found, m);
    attempted = met->at_impact & (!met->missed) & (!has_points(m));
    if (attempt == 1u || !any_of(attempted)) break;
    met->time = choose(attempted, met->time + R(2.0) * pair->rounded / pair->input.fastest, met->time);
  }
  return m;
}

SHARED void follow_pair_of_boxes(mask wanted, read_listed_pairs pairs, GLOBAL const float4 *shapes, read_bodies bodies,
                                 GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                 write_manifolds manifolds, uint_lanes i)
{
  point_planes planes = planes_of(counts);
  moving_boxes pair = load_boxes(shapes, bodies, parameters, load_uint(pairs.a, i), load_uint(pairs.b, i));
  manifold start = load_manifold(planes, manifolds, i);
  mask keeps = keeps_start(parameters, wanted, &pair, start);
  store_uint_if(keeps, manifolds.count, i, points_of(start));
  wanted = wanted & (!keeps);
  if (!any_of(wanted)) return;
  speculation s = speculation_of_boxes(parameters, start, &pair);
  advancement at = impact_of_boxes(wanted & s.reached, pair.boxes, parameters->slop, pair.moves, pair.input);
  encounter met = encounter_of(parameters, s, at, pair.input);
  box_pair then;
  manifold m = contact_at_impact(parameters, &pair, &met, &then);
  met.at_impact = met.at_impact & has_points(m);
  m = with_middle_of_box_if(met.at_impact & (!met.missed), m, then, pair.moves);
  m = as_seen_from_start(parameters, choose_manifold(met.at_impact, m, start), met, then.offset, pair.moves);
  store_manifold_if(wanted, m, planes, manifolds, i);
}

/* local_memory: the list of followed_pairs.h. */
SHARED void follow_boxes_group(read_listed_pairs pairs, GLOBAL const uint *flags, GLOBAL const float4 *shapes,
                               read_bodies bodies, GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                               write_manifolds manifolds, LOCAL uint *local_memory, uint group)
{
  gather_followed_pairs(pairs.of_kind, pairs.a, pairs.b, flags, parameters, counts, manifolds.count, PAIR_KIND_BOX_BOX,
                        local_memory, group);
  FOR_EACH_LISTED(k, local_memory[0])
  {
    follow_pair_of_boxes(is_listed(local_memory[0], k), pairs, shapes, bodies, parameters, counts, manifolds,
                         listed_item(local_memory + 1u, local_memory[0], k));
  }
}

#endif
