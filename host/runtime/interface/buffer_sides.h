/* buffer_sides.h - expands a list of buffers into their sides: STATE and CACHE buffers exist twice
 * (shared/buffers.def).
 *
 * An includer defines SIDE(name, element, capacity, per_item, feature, lifetime, fields), defines BUFFER as
 * BUFFER_SIDES, includes the list and undefines both.
 */
#pragma once

#define BUFFER_SIDES(name, element, capacity, per_item, feature, lifetime, fields) \
  SIDES_##lifetime(name, element, capacity, per_item, feature, lifetime, fields)
#define SIDES_SCENE(...) SIDE(__VA_ARGS__)
#define SIDES_KEPT(...) SIDE(__VA_ARGS__)
#define SIDES_SCRATCH(...) SIDE(__VA_ARGS__)
#define SIDES_STATE(name, ...) SIDE(name, __VA_ARGS__) SIDE(previous_##name, __VA_ARGS__)
#define SIDES_CACHE(name, ...) SIDE(name, __VA_ARGS__) SIDE(previous_##name, __VA_ARGS__)
