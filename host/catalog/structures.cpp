/* structures.cpp - the scenes of structures.h, with the geometry of each at its builder. */
#include "host/catalog/structures.h"

#include <algorithm>
#include <cmath>

#include <tandem/round_to_float.h>

#include "host/catalog/builders.h"

namespace tandem {

using namespace scene_builders;

namespace {

/* A scene whose shape 0 and body 0 are the ground. */
Scene on_ground(double friction)
{
  Scene scene;
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = round_to_float(friction);
  add_ground(scene);
  return scene;
}

Body &add(Scene &scene, uint32_t shape, double x, double y, double z, double mass = 1)
{
  return add_body(scene, shape, {round_to_float(x), round_to_float(y), round_to_float(z)}, round_to_float(mass));
}

/* Sine and cosine of the angle with the given tangent, and of half the angle. */
struct Slope {
  double sine, cosine, half_sine, half_cosine;
  explicit Slope(double tangent)
  {
    cosine = 1 / std::sqrt(1 + tangent * tangent);
    sine = tangent * cosine;
    half_cosine = std::sqrt(0.5 * (1 + cosine));
    half_sine = 0.5 * sine / half_cosine;
  }
};

/* --- card-house: pairs of leaning cards, flat cards between their tips, the next storey on those -------------------
 *
 *             /\                 s = sin lean, c = cos lean; L, t: half length and half thickness of a card.
 *          ________              The pair's upright edges touch at its middle; its tips are 2 t c to either side,
 *         /\      /\             its feet 2 L s. A flat card reaches from the middle of one pair to the next.
 */

uint64_t card_house_bodies(const SceneValues &v)
{
  const uint64_t n = uint64_t(whole(v, "storeys"));
  return 1 + n * (n + 1) + n * (n - 1) / 2;
}

Scene card_house(const SceneValues &v)
{
  const int64_t storeys = whole(v, "storeys");
  const double L = 0.5, t = number(v, "thickness") / 2, depth = 0.35, gap = 0.01;
  const Slope lean(number(v, "lean"));
  const double reach = L * lean.sine + t * lean.cosine, rise = L * lean.cosine + t * lean.sine, pitch = 4 * reach + gap;
  Scene scene = on_ground(number(v, "friction"));
  const uint32_t card = add_shape(scene, box_shape(round_to_float(t), round_to_float(L), round_to_float(depth)));
  const uint32_t flat =
      add_shape(scene, box_shape(round_to_float(pitch / 2 - gap / 4), round_to_float(t), round_to_float(depth)));
  for (int64_t storey = 0; storey < storeys; ++storey) {
    const double floor = double(storey) * 2 * (rise + t);
    const int64_t pairs = storeys - storey;
    for (int64_t i = 0; i < pairs; ++i) {
      const double x = (double(i) - 0.5 * double(pairs - 1)) * pitch;
      add(scene, card, x - reach, floor + rise, 0).orientation = {0, 0, round_to_float(-lean.half_sine),
                                                                  round_to_float(lean.half_cosine)};
      add(scene, card, x + reach, floor + rise, 0).orientation = {0, 0, round_to_float(lean.half_sine),
                                                                  round_to_float(lean.half_cosine)};
      if (i > 0) add(scene, flat, x - 0.5 * pitch, floor + 2 * rise + t, 0);
    }
  }
  return scene;
}

/* --- arch: corbelled, because boxes have no slanted faces: every course projects further inwards, a lintel closes it
 * It stands while the centre of mass of everything on a course, half the lintel included, lies over that course. */

uint64_t arch_bodies(const SceneValues &v) { return 2 + 2 * uint64_t(whole(v, "courses")); }

Scene arch(const SceneValues &v)
{
  const int64_t courses = whole(v, "courses");
  const double length = 0.5, height = 0.2, overhang = number(v, "overhang");
  Scene scene = on_ground(0.6);
  const uint32_t block = add_shape(scene, box_shape(round_to_float(length), round_to_float(height), 0.4f));
  const double top = length + 0.3, bottom = top + overhang * double(courses - 1); /* of centres, from the middle */
  for (int64_t k = 0; k < courses; ++k)
    for (double side : {-1.0, 1.0})
      add(scene, block, side * (bottom - overhang * double(k)), height * double(1 + 2 * k), 0);
  add(scene, block, 0, height * double(1 + 2 * courses), 0);
  return scene;
}

/* --- tower: three planks a level, every level across the one below ---------------------------------------------- */

uint64_t tower_bodies(const SceneValues &v) { return 1 + 3 * uint64_t(whole(v, "levels")); }

Scene tower(const SceneValues &v)
{
  const double half_width = 0.25, half_height = 0.15, gap = 0.004;
  Scene scene = on_ground(0.6);
  const uint32_t along_x = add_shape(
      scene, box_shape(round_to_float(3 * half_width), round_to_float(half_height), round_to_float(half_width - gap)));
  const uint32_t along_z = add_shape(
      scene, box_shape(round_to_float(half_width - gap), round_to_float(half_height), round_to_float(3 * half_width)));
  for (int64_t level = 0; level < whole(v, "levels"); ++level)
    for (int side = -1; side <= 1; ++side) {
      const double across = 2 * half_width * side, y = half_height * double(1 + 2 * level);
      if (level % 2 == 0) add(scene, along_x, 0, y, across);
      else add(scene, along_z, across, y, 0);
    }
  return scene;
}

/* --- dominoes: a row, the first pushed over ----------------------------------------------------------------------- */

Scene dominoes(const SceneValues &v)
{
  const double half_height = 0.5, half_thickness = 0.06, pitch = number(v, "pitch"), push = number(v, "push");
  Scene scene = on_ground(0.6);
  const uint32_t domino =
      add_shape(scene, box_shape(round_to_float(half_thickness), round_to_float(half_height), 0.25f));
  for (int64_t i = 0; i < whole(v, "n"); ++i) add(scene, domino, pitch * double(i), half_height, 0);
  /* The domino rotates about its far lower edge. */
  scene.bodies[1].angular_velocity = {0, 0, round_to_float(-push)};
  scene.bodies[1].linear_velocity = {round_to_float(push * half_height), round_to_float(push * half_thickness), 0};
  return scene;
}

/* --- wall: bricks in running bond, a ball on its way --- */

uint64_t wall_bodies(const SceneValues &v)
{
  const uint64_t rows = uint64_t(whole(v, "rows")), length = uint64_t(whole(v, "length"));
  return 2 + rows * length - rows / 2;
}

Scene wall(const SceneValues &v)
{
  const int64_t rows = whole(v, "rows"), length = whole(v, "length");
  const double half_length = 0.4, half_height = 0.2, half_depth = 0.2, gap = 0.005, radius = 0.4;
  Scene scene = on_ground(0.6);
  const uint32_t brick =
      add_shape(scene, box_shape(round_to_float(half_length), round_to_float(half_height), round_to_float(half_depth)));
  const uint32_t ball = add_shape(scene, sphere_shape(round_to_float(radius)));
  for (int64_t row = 0; row < rows; ++row) {
    const int64_t bricks = length - row % 2;
    for (int64_t i = 0; i < bricks; ++i)
      add(scene, brick, (double(i) - 0.5 * double(bricks - 1)) * (2 * half_length + gap),
          half_height * double(1 + 2 * row), 0);
  }
  const double middle = std::max(radius, half_height * double(rows));
  add(scene, ball, 0, middle, -number(v, "distance"), number(v, "ball_mass")).linear_velocity = {
      0, 0, round_to_float(number(v, "ball_speed"))};
  scene.bodies.back().name = "ball";
  return scene;
}

/* --- tops: cubes spinning on a corner ------------------------------------------------------------------------------
 * A cube's moments are equal, so its diagonal is an axis of symmetry like any other, and its corner is the tip. */

Scene tops(const SceneValues &v)
{
  const int64_t n = whole(v, "n");
  const double half = number(v, "half_extent"), distance = half * std::sqrt(3.0), spin = number(v, "spin");
  const Slope lean(number(v, "lean"));
  Scene scene = on_ground(1);
  const uint32_t cube = add_shape(scene, box_shape(round_to_float(half), round_to_float(half), round_to_float(half)));
  /* A rotation about (-1, 0, 1) turns the diagonal (1, 1, 1) onto y; a rotation about -z then leans it towards x. */
  const Slope upright(std::sqrt(2.0));
  const double s = upright.half_sine / std::sqrt(2.0), c = upright.half_cosine;
  const double ls = -lean.half_sine, lc = lean.half_cosine;
  /* (0, 0, ls, lc) times (-s, 0, s, c). */
  const Quat orientation{round_to_float(lc * -s), round_to_float(ls * -s), round_to_float(ls * c + lc * s),
                         round_to_float(lc * c - ls * s)};
  const double axis[3] = {lean.sine, lean.cosine, 0};
  for (int64_t i = 0; i < n; ++i) {
    Body &body =
        add(scene, cube, (double(i) - 0.5 * double(n - 1)) * 6 * half + distance * axis[0], distance * axis[1], 0);
    body.orientation = orientation;
    const double precession = steady_precession(half, spin, number(v, "lean"), 10);
    const double around = std::isfinite(precession) ? precession : 0, along = spin - around * lean.cosine;
    body.angular_velocity = {round_to_float(along * axis[0]), round_to_float(along * axis[1] + around), 0};
    body.linear_velocity = {0, 0, round_to_float(-around * distance * axis[0])}; /* (0, W, 0) x r */
  }
  return scene;
}

} // namespace

double steady_precession(double half_extent, double spin, double lean_tangent, double gravity)
{
  const double moment = 2.0 / 3.0 * half_extent * half_extent,
               squared = 3 * half_extent * half_extent; /* of 1 kg; d^2 */
  const double a = (moment + squared) / std::sqrt(1 + lean_tangent * lean_tangent), b = moment * spin,
               c = gravity * std::sqrt(squared);
  return 2 * c / (b + std::sqrt(b * b - 4 * a * c));
}

std::vector<BuiltInScene> structure_scenes()
{
  return {
      {"card-house",
       "cards leaning in pairs, flat cards between their tips, storey upon storey",
       {{"storeys", integer, 4, 1, 100, "storeys; the lowest has as many pairs"},
        {"lean", real, 0.4, 0.05, 1, "tangent of the angle between a leaning card and the vertical"},
        {"thickness", real, 0.03, 0.002, 0.2, "of a card one metre long, m"},
        {"friction", real, 0.7, 0, 10, "between all"}},
       card_house_bodies,
       card_house},
      {"arch",
       "a corbelled arch: every course reaches further in, a lintel closes it",
       {{"courses", integer, 6, 1, 20, "courses under the lintel"},
        {"overhang", real, 0.1, 0, 0.4, "how far a course of blocks one metre long reaches beyond that below, m"}},
       arch_bodies,
       arch},
      {"tower",
       "planks, three a level, each level across the one below",
       {{"levels", integer, 18, 1, 10000, "levels"}},
       tower_bodies,
       tower},
      {"dominoes",
       "a row of dominoes one metre high, the first pushed over",
       {{"n", integer, 20, 1, 100000, "dominoes"},
        {"pitch", real, 0.5, 0.13, 2, "from one to the next, m"},
        {"push", real, 2, 0, 100, "how fast the first turns over, rad/s"}},
       ground_and_n,
       dominoes},
      {"wall",
       "a wall of bricks in running bond, and a ball that flies at it",
       {{"rows", integer, 10, 1, 1000, "rows of bricks"},
        {"length", integer, 10, 2, 1000, "bricks in a row; one fewer in every other row"},
        {"ball_mass", real, 20, 1e-6, 1e9, "a brick has 1, kg"},
        {"ball_speed", real, 20, 0, 10000, "m/s"},
        {"distance", real, 3, 0.7, 10000, "of the ball's centre from the wall's, m"}},
       wall_bodies,
       wall},
      {"tops",
       "cubes of 1 kg that spin on a corner and precess steadily",
       {{"n", integer, 1, 1, 10000, "tops"},
        {"half_extent", real, 0.1, 0.001, 1000, "half the edge of a cube, m"},
        {"spin", real, 100, 0, 10000, "along the diagonal, rad/s"},
        {"lean", real, 0.3, 0, 0.7, "tangent of the angle between the diagonal and the vertical"}},
       ground_and_n,
       tops},
  };
}

} // namespace tandem
