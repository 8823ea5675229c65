/* body_parts.h - the convex parts of a body near a straight path: its one shape, or leaves of its tree.
 *
 *        from o- - - - - - ->  path       The traversal is that of midphase/tree.h. A box counts as near unless one of
 *                 +----+                  the separating axes of box and path shows a gap (Ericson, "Real-Time
 *                 |    |                  Collision Detection", 2005, section 5.3.3).
 */
#ifndef TANDEM_SHARED_QUERIES_BODY_PARTS_H
#define TANDEM_SHARED_QUERIES_BODY_PARTS_H

#include "shared/midphase/tree.h"
#include "shared/narrowphase/collide_convex.h"
#include "shared/queries/body_walk.h"
#include "shared/queries/nearest.h"

/* The buffers of the scene and of the queries. */
typedef struct {
  GLOBAL const Parameters *parameters;
  GLOBAL const uint *flags, *convexes, *body_trees;
  GLOBAL const float4 *shapes, *poses, *positions, *orientations;
  hull_tables tables;
  tree_tables trees;
  body_structure bodies;
  GLOBAL const uint *query_body, *query_filter;
  GLOBAL const float4 *query_start, *query_displacement;
} query_scene;

/* The bodies and their shapes, which is all that walks through parts need. */
SHARED void set_bodies_of_scene(query_scene *scene, GLOBAL const Parameters *parameters, read_shapes shapes,
                                read_surfaces surfaces, read_trees trees, read_bodies bodies)
{
  scene->parameters = parameters;
  scene->flags = shapes.flags;
  scene->convexes = shapes.convex;
  scene->body_trees = trees.of_body;
  scene->shapes = shapes.size;
  scene->poses = shapes.pose;
  scene->positions = bodies.position;
  scene->orientations = bodies.orientation;
  scene->tables = tables_of(surfaces, SUPPORT_BRUTE_FORCE);
  scene->trees = tables_of_trees(trees);
}

SHARED query_scene query_scene_of(GLOBAL const Parameters *parameters, read_search_structures search_structures,
                                  read_shapes shapes, read_surfaces surfaces, read_trees trees, read_bodies bodies,
                                  read_queries queries, uint structure)
{
  query_scene scene;
  set_bodies_of_scene(&scene, parameters, shapes, surfaces, trees, bodies);
  scene.bodies = structure_of(search_structures, structure);
  scene.query_body = queries.body;
  scene.query_filter = queries.filter;
  scene.query_start = queries.start;
  scene.query_displacement = queries.displacement;
  return scene;
}

/* A path through one body, in the axes of the body's tree. */
typedef struct {
  uint body, node, end, first_child; /* nodes `node` to `end` remain; without a tree one */
  mask has_tree;
  tree t;
  vec3 center; /* of the body, seen from the start of the query */
  vec3 middle, half_displacement;
  real radius;
} part_walk;

/* displacement: from the start of the query. radius: of the shape that moves along the path. */
SHARED part_walk walk_parts(const query_scene *scene, uint body, vec3 center, vec3 displacement, real radius)
{
  part_walk walk;
  walk.body = body;
  walk.center = center;
  walk.node = 0u;
  walk.end = 1u;
  walk.has_tree = HAS_FEATURE(scene->parameters, TREES) && scene->body_trees[body * 2u] != INDEX_NONE;
  if (!walk.has_tree) return walk;
  quat turned = quat_from(load_float4(scene->orientations, body)),
       own = quat_from(load_float4(scene->poses, body * 4u + 1u));
  mat3 rotation = rotation_of(quat_multiply(turned, own));
  vec3 origin = add(center, rotate(rotation_of(turned), xyz(load_float4(scene->poses, body * 4u))));
  walk.first_child = scene->body_trees[body * 2u + 1u];
  walk.t = load_tree(scene->trees, scene->body_trees[body * 2u]);
  walk.end = walk.t.nodes;
  walk.half_displacement = rotate_back(rotation, scale(displacement, R(0.5)));
  walk.middle = subtract(walk.half_displacement, rotate_back(rotation, origin));
  walk.radius = radius + R(1e-6) * (length_of(origin) + length_of(displacement) + load_float4(scene->shapes, body).w);
  return walk;
}

SHARED mask path_near_box(const part_walk *walk, box_bounds box)
{
  vec3 from_box = subtract(walk->middle, scale(add(box.lower, box.upper), R(0.5))),
       d = absolute(walk->half_displacement), c = absolute(from_box);
  vec3 extent = scale(subtract(box.upper, box.lower), R(0.5)),
       across = absolute(cross3(from_box, walk->half_displacement));
  vec3 h = make_vec3(extent.x + walk->radius, extent.y + walk->radius, extent.z + walk->radius);
  if (c.x > h.x + d.x || c.y > h.y + d.y || c.z > h.z + d.z) return 0;
  return across.x <= h.y * d.z + h.z * d.y && across.y <= h.z * d.x + h.x * d.z && across.z <= h.x * d.y + h.y * d.x;
}

/* Loads the next leaf; false if there is none. */
SHARED mask next_part(const query_scene *scene, part_walk *walk, convex *part)
{
  if (!walk->has_tree) {
    if (walk->node++ > 0u) return 0;
    *part = shape_of_body(scene->flags, scene->shapes, scene->convexes, scene->poses, scene->orientations,
                          scene->tables, walk->center, walk->body);
    return 1;
  }
  while (walk->node < walk->end) {
    uint word = word_of_node(scene->trees, &walk->t, walk->node);
    mask near = path_near_box(walk, bounds_of_node(scene->trees, &walk->t, walk->node));
    walk->node = walk->node + (near ? 1u : subtree_size(word));
    if (!near || !is_leaf(word)) continue;
    GLOBAL const uint *entry = scene->trees.leaves + (walk->t.first_leaf + word) * 2u;
    body_part leaf = {walk->body, entry[0] == INDEX_NONE ? walk->body : walk->first_child + entry[0], entry[1]};
    *part = load_convex(scene->shapes, scene->convexes, scene->poses, scene->orientations, scene->tables, walk->center,
                        leaf);
    return 1;
  }
  return 0;
}

#endif
