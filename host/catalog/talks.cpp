/* talks.cpp - the scenes behind the batch tables of the 2009 talk; see talks.h.
 *
 * The talk prints the sizes of batches, but not the scenes. The following can be inferred:
 *
 * 2D: There are 31,602 constraints in 12 batches, the first of 4,931, and therefore at least 9,862 bodies. 31,602
 * contacts of 10,600 bodies are six neighbours each, the most that equal squares in rows can have. A pyramid whose
 * cubes touch within a row and rest on two cubes has this number, and it can be extended flank by flank:
 *
 *               6                flank 1: cube 1     flank 2: 2, 3     flank 3: 4, 5, 6 ..
 *             3   5
 *           1   2   4            145 flanks are 10,585 cubes with 31,465 contacts, and 46 cubes of the next,
 *                                of 2 + 45 * 3 contacts, make 31,602: n = 10,631
 *
 * 3D: The talk prints "# objects = 3008, # pairs = 8086", and batches that sum to 4,040 (on the CPU). Bullet's public
 * Gpu3dDemo drops 8 * 47 * 8 = 3,008 boxes of half extent 0.7 from a lattice of pitch 2 on a floor. The pairs are those
 * of the broadphase, the constraints those of the touching pairs. The table shows a moment while the columns topple.
 */
#include "host/catalog/talks.h"

#include <cmath>

#include <tandem/round_to_float.h>

#include "host/base/random.h"
#include "host/catalog/builders.h"

namespace tandem {

using namespace scene_builders;

namespace {

/* Adds a box of shape 0. */
void add_box(Scene &scene, double x, double y, double z)
{
  add_body(scene, 0, {round_to_float(x), round_to_float(y), round_to_float(z)});
}

uint64_t value_of(const SceneValues &values, const char *name) { return uint64_t(values.find(name)->second); }

/* The number of complete flanks among n cubes; the rest are in the next flank. */
uint64_t whole_flanks(uint64_t n)
{
  uint64_t flanks = 0;
  while ((flanks + 1) * (flanks + 2) / 2 <= n) ++flanks;
  return flanks;
}

Scene pyramid_2d(const SceneValues &values)
{
  const uint64_t n = value_of(values, "n");
  const double half = values.find("half_extent")->second, middle = double(whole_flanks(n)) / 2;
  Scene scene;
  scene.shapes = {box_shape(round_to_float(half), round_to_float(half), round_to_float(half))};
  add_ground(scene);
  for (uint64_t flank = 0, placed = 0; placed < n; ++flank)
    for (uint64_t row = 0; row <= flank && placed < n; ++row, ++placed)
      add_box(scene, (double(flank) - 0.5 * double(row) - middle) * 2 * half, double(1 + 2 * row) * half, 0);
  return scene;
}

uint64_t talk_3d_bodies(const SceneValues &values)
{
  return 1 + value_of(values, "nx") * value_of(values, "ny") * value_of(values, "nz");
}

Scene talk_3d(const SceneValues &values)
{
  const uint64_t nx = value_of(values, "nx"), ny = value_of(values, "ny"), nz = value_of(values, "nz");
  const double jitter = values.find("jitter")->second;
  Random random(value_of(values, "seed"));
  Scene scene;
  scene.shapes = {box_shape(0.7f, 0.7f, 0.7f)};
  add_ground(scene);
  for (uint64_t k = 0; k < ny; ++k)
    for (uint64_t i = 0; i < nx; ++i)
      for (uint64_t j = 0; j < nz; ++j) {
        const double dx = random.uniform(-jitter, jitter), dz = random.uniform(-jitter, jitter);
        add_box(scene, 2 * double(i) - double(nx) + dx, 5 + 2 * double(k), 2 * double(j) - double(nz) + dz);
      }
  return scene;
}

} // namespace

uint64_t pyramid_2d_contacts(uint64_t n)
{
  const uint64_t flanks = whole_flanks(n), rest = n - flanks * (flanks + 1) / 2;
  const uint64_t whole = flanks == 0 ? 0 : flanks * flanks + flanks * (flanks - 1) / 2;
  if (rest == 0) return whole;
  return whole + 1 + (flanks > 0 ? 1 : 0) + 3 * (rest - 1);
}

std::vector<BuiltInScene> talk_scenes()
{
  return {{"pyramid-2d",
           "a wall of touching cubes, each on two others: 31,602 contacts, as in a batch table of the 2009 talk",
           {{"n", integer, 10631, 1, 3'000'000, "cubes"},
            {"half_extent", real, 0.5, 0.001, 1000, "half the edge of a cube, m"}},
           ground_and_n,
           pyramid_2d},
          {"talk-3d",
           "the 3,008 boxes of the other batch table of the 2009 talk: a lattice that falls and topples",
           {{"nx", integer, 8, 1, 1000, "boxes along x"},
            {"ny", integer, 47, 1, 1000, "layers"},
            {"nz", integer, 8, 1, 1000, "boxes along z"},
            {"jitter", real, 0.15, 0, 0.29, "largest random shift along x and z, m"},
            seed_parameter()},
           talk_3d_bodies,
           talk_3d}};
}

} // namespace tandem
