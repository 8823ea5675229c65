/* narrowphase.cpp - see narrowphase.h.
 *
 *    (a)(b)   .   (a)(b)   .      The pairs are far from each other, at random poses near contact: a third is separate,
 *      .   (a)(b)   .   (a)(b)    but near enough for a speculative contact; the others overlap by up to 2 cm. Every
 *                                 pair makes a manifold.
 *
 * b approaches from afar along a line through both centres until it touches (conservative advancement), and is then
 * moved along the normal to the required gap. A first step makes the list of pairs and moves nothing, because it
 * removes no penetration; then the kernel runs repeatedly.
 */
#include "tools/bench/narrowphase.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "host/catalog/builders.h"
#include "host/pipeline/setting_rows.h"
#include "host/pipeline/step_launches.h"
#include "host/runtime/interface/pair_tests.h"
#include "shared/narrowphase/collide_convex.h"
#include "tools/command/parallel.h"
#include "tools/command/progress.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

using scene_builders::add_body;

constexpr int narrowphase_repetitions = 9;
constexpr uint32_t variants = 16;                            /* sizes and hulls of each shape */
constexpr double cell = 4, deepest = 0.02, farthest = 0.015; /* m; contacts are made 0.02 ahead */

/* --- shapes --------------------------------------------------------------------------------------------- */

using Maker = std::function<Shape(Random &)>;

float size_of(Random &random) { return float(random.uniform(0.25, 0.5)); }
Shape ball(Random &random) { return sphere_shape(size_of(random)); }
Vec3 sizes_of(Random &random)
{
  return {size_of(random), size_of(random), size_of(random)};
} /* evaluated in this order, which is unspecified for arguments */
Shape box(Random &random) { return {ShapeType::box, sizes_of(random)}; }
Shape capsule(Random &random)
{
  const float radius = 0.6f * size_of(random);
  return capsule_shape(radius, size_of(random));
}
Shape cylinder(Random &random)
{
  const float radius = size_of(random);
  return cylinder_shape(radius, size_of(random));
}
Shape hull32(Random &random)
{
  const Vec3 size = sizes_of(random);
  std::vector<Vec3> points;
  while (points.size() < 32) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1),
                 length = std::sqrt(x * x + y * y + z * z);
    if (length > 0.1 && length < 1)
      points.push_back({float(x / length) * size[0], float(y / length) * size[1], float(z / length) * size[2]});
  }
  return hull_shape(points, "hull32");
}
Shape any_convex(Random &random)
{
  const Maker makers[] = {cylinder, hull32};
  return makers[random.below(2)](random);
}

struct PairKind {
  const char *name;
  Maker a, b;     /* if b is empty, a lies on a half-space */
  uint32_t pairs; /* PAIR_KIND_ */
  std::vector<std::string> methods;
};

/* Methods differ if cores overlap; only `sat` tests the axes of polytopes. The support function of hulls follows after
 * a comma. */
std::vector<PairKind> kinds()
{
  const std::vector<std::string> own{""}, round{"gjk-epa", "gjk-sampled"}, all = choice_names<Narrowphase>();
  std::vector<std::string> hulls = all;
  hulls.insert(hulls.end(), {"sat, hill-climbing", "sat, cube-map"});
  return {{"sphere-sphere", ball, ball, PAIR_KIND_SPHERE_SPHERE, own},
          {"sphere-box", ball, box, PAIR_KIND_SPHERE_BOX, own},
          {"box-box", box, box, PAIR_KIND_BOX_BOX, own},
          {"sphere-capsule", ball, capsule, PAIR_KIND_SPHERE_CAPSULE, own},
          {"capsule-capsule", capsule, capsule, PAIR_KIND_CAPSULE_CAPSULE, own},
          {"capsule-half-space", capsule, {}, PAIR_KIND_CAPSULE_HALF_SPACE, own},
          {"box-capsule", box, capsule, PAIR_KIND_BOX_CAPSULE, own},
          {"cylinder-box", cylinder, box, PAIR_KIND_CONVEX_CONVEX, round},
          {"hull32-box", hull32, box, PAIR_KIND_CONVEX_CONVEX, all},
          {"hull32-hull32", hull32, hull32, PAIR_KIND_CONVEX_CONVEX, hulls},
          {"convex-half-space", any_convex, {}, PAIR_KIND_CONVEX_HALF_SPACE, own}};
}

/* --- poses ---------------------------------------------------------------------------------------------- */

double wanted_gap(uint32_t pair, Random &random)
{
  return pair % 3 == 0 ? random.uniform(0, farthest) : random.uniform(-deepest, 0);
}

/* The shapes of a scene as kernels read them. */
class Convexes {
public:
  explicit Convexes(const Scene &scene) : world_(scene, everything(), Placement{"serial", {}, false})
  {
    for (uint32_t index = 0; index < scene.bodies.size(); ++index) {
      index_.resize(scene.bodies.size());
      index_[world_.scene_body(index)] = index;
    }
  }
  /* The shape of a body, relative to the body's centre plus `offset`. */
  convex of(uint32_t body, vec3 offset) const
  {
    const hull_tables tables = {headers_.data(), vertices_.data(), planes_.data(),     face_starts_.data(),
                                corners_.data(), edges_.data(),    chunks_.data(),     links_.data(),
                                nullptr,         nullptr,          SUPPORT_BRUTE_FORCE};
    return load_convex(shapes_.data(), convexes_.data(), poses_.data(), orientations_.data(), tables, offset,
                       {index_[body], index_[body], INDEX_NONE});
  }

private:
  static Settings everything()
  {
    Settings settings;
    settings.specialise = false;
    return settings;
  }
  template <class T> std::vector<T> all(Buffer buffer)
  {
    return world_.memory().read<T>(buffer, world_.memory().bytes(buffer) / sizeof(T));
  }

  World world_;
  std::vector<uint32_t> index_;
  std::vector<float4> shapes_ = all<float4>(Buffer::body_shape), poses_ = all<float4>(Buffer::body_shape_pose),
                      orientations_ = all<float4>(Buffer::body_orientation);
  std::vector<float4> vertices_ = all<float4>(Buffer::hull_vertex), planes_ = all<float4>(Buffer::hull_plane),
                      chunks_ = all<float4>(Buffer::hull_chunk);
  std::vector<uint32_t> convexes_ = all<uint32_t>(Buffer::body_convex), headers_ = all<uint32_t>(Buffer::hull_header);
  std::vector<uint32_t> face_starts_ = all<uint32_t>(Buffer::hull_face_start),
                        corners_ = all<uint32_t>(Buffer::hull_corner);
  std::vector<uint32_t> edges_ = all<uint32_t>(Buffer::hull_edge), links_ = all<uint32_t>(Buffer::hull_link);
};

vec3 any_direction(Random &random)
{
  const Quat q = random.orientation();
  return axis_x(rotation_of(make_quat(q[0], q[1], q[2], q[3])));
}

/* The required pose of a pair: b approaches along `from` to the gap. */
struct Approach {
  double gap;
  vec3 from;
};

/* The position of b's centre relative to a's at that gap. */
vec3 near_contact(const Convexes &convexes, uint32_t a, uint32_t b, const Approach &approach)
{
  const convex first = convexes.of(a, make_vec3(0, 0, 0));
  vec3 offset = scale(approach.from, 3), toward = scale(offset, -1.0f / 3);
  for (int k = 0; k < 40; ++k) {
    const convex second = convexes.of(b, offset);
    const convex_pair pair = pair_of(&first, &second);
    const gjk_result near = closest_points(&pair.a, &pair.b, 1e30f);
    const float apart = near.overlapping ? 0 : near.contact.gap - core_radius(&first) - core_radius(&second);
    if (apart > 1e-4f) {
      offset = add_scaled(offset, toward, apart);
      continue;
    }
    const vec3 normal = rotate(pair.axes, near.contact.normal);
    return add_scaled(offset, pair.swapped ? negate(normal) : normal, float(approach.gap));
  }
  return offset;
}

Scene scene_of(const PairKind &kind, uint32_t pairs)
{
  Random random(1);
  Scene scene;
  scene.gravity = {0, 0, 0};
  const bool on_plane = !kind.b;
  for (uint32_t k = 0; k < variants; ++k) scene.shapes.push_back(kind.a(random));
  for (uint32_t k = 0; k < variants && !on_plane; ++k) scene.shapes.push_back(kind.b(random));
  const auto side = static_cast<uint32_t>(std::ceil(on_plane ? std::sqrt(double(pairs)) : std::cbrt(double(pairs))));
  for (uint32_t pair = 0; pair < pairs; ++pair) {
    const Point middle{cell * (pair % side), on_plane ? 0 : cell * (pair / side % side),
                       cell * (on_plane ? pair / side : pair / side / side)};
    for (uint32_t k = 0; k < (on_plane ? 1u : 2u); ++k) {
      Body &body = add_body(scene, random.below(variants) + k * variants, middle);
      body.orientation = random.orientation();
      body.inertia = {1, 1, 1};
    }
  }
  if (on_plane) scene_builders::add_ground(scene);
  return scene;
}

/* All approaches come from one sequence of random numbers, so they are the same with any number of threads. */
std::vector<Approach> approaches_of(uint32_t pairs, bool on_plane)
{
  Random random(2);
  std::vector<Approach> approaches(pairs);
  for (uint32_t pair = 0; pair < pairs; ++pair) {
    approaches[pair].gap = wanted_gap(pair, random);
    if (!on_plane) approaches[pair].from = any_direction(random);
  }
  return approaches;
}

void bring_pair_near(Scene &scene, const Convexes &convexes, bool on_plane, uint32_t pair, const Approach &approach)
{
  if (on_plane) {
    const convex shape = convexes.of(pair, make_vec3(0, 0, 0));
    scene.bodies[pair].position[1] =
        approach.gap + double(core_radius(&shape)) - double(support_of(&shape, make_vec3(0, -1, 0)).y);
    return;
  }
  const vec3 offset = near_contact(convexes, 2 * pair, 2 * pair + 1, approach);
  const Point at = scene.bodies[2 * pair].position;
  scene.bodies[2 * pair + 1].position = {at[0] + double(offset.x), at[1] + double(offset.y), at[2] + double(offset.z)};
}

void bring_near(Scene &scene, bool on_plane)
{
  const Convexes convexes(scene);
  const auto bodies = static_cast<uint32_t>(scene.bodies.size()), pairs = on_plane ? bodies - 1 : bodies / 2;
  const std::vector<Approach> approaches = approaches_of(pairs, on_plane);
  constexpr uint32_t block = 256;
  in_parallel((pairs + block - 1) / block, processor_count(), [&](size_t k) {
    const auto first = static_cast<uint32_t>(k * block);
    for (uint32_t pair = first; pair < std::min(pairs, first + block); ++pair)
      bring_pair_near(scene, convexes, on_plane, pair, approaches[pair]);
  });
}

/* --- times ---------------------------------------------------------------------------------------------- */

class NarrowphaseBench {
public:
  NarrowphaseBench(const Scene &scene, const std::string &method, const std::string &backend, bool allow_inexact)
      : settings_(still(method)), world_(scene, settings_, Placement{backend, {}, allow_inexact})
  {
    world_.set_observer([](const Launch &) {}); /* what the kernels read is kept for them to run again */
    world_.step();
    world_.memory().download(Buffer::counts, plan_.known.data(), sizeof plan_.known);
    plan_.features = world_.features();
  }

  PairTime run(const PairKind &kind, const std::string &method)
  {
    const std::vector<Kernel> kernels = kernels_of(kind);
    Backend &backend = world_.backend_of(kernels[0]);
    DirectLauncher launcher(world_.memory(), backend);
    StepLaunches step(launcher, plan_, settings_);
    const std::vector<uint32_t> values =
        method.empty() ? std::vector<uint32_t>{} : std::vector<uint32_t>{narrowphase_method(settings_)};
    world_.set_profiling(true);
    std::vector<double> times;
    for (int k = 0; k <= narrowphase_repetitions; ++k) { /* the first repetition warms up buffers and caches */
      for (Kernel kernel : kernels) step.run_pairs(kernel, kind.pairs, values);
      backend.finish();
      double nanoseconds = 0;
      const auto spent = backend.take_kernel_times();
      for (Kernel kernel : kernels) nanoseconds += spent[index_of(kernel)].nanoseconds;
      if (k > 0) times.push_back(nanoseconds * 1e-6);
    }
    world_.set_profiling(false);
    PairTime result{kind.name,       row_of(pair_tests[kind.pairs].kernel).name, method, plan_.known[COUNT_PAIRS], 0, 0,
                    spread_of(times)};
    for (uint32_t points : world_.memory().read<uint32_t>(Buffer::manifold_count, result.pairs)) {
      result.manifolds += points > 0;
      result.points += points;
    }
    return result;
  }

private:
  static Settings still(const std::string &method)
  {
    Settings settings;
    settings.push_speed = 0;
    if (!method.empty()) settings.narrowphase = parse_setting<Narrowphase>(method.substr(0, method.find(',')));
    settings.support = method.ends_with(", hill-climbing") ? Support::hill_climbing
                       : method.ends_with(", cube-map")    ? Support::cube_map
                                                           : Support::brute_force;
    return settings;
  }
  std::vector<Kernel> kernels_of(const PairKind &kind) const
  {
    if (settings_.narrowphase != Narrowphase::sat_split) return {pair_tests[kind.pairs].kernel};
    return {Kernel::find_separating_axis, Kernel::find_clipping_faces, Kernel::clip_faces, Kernel::reduce_contacts};
  }

  Settings settings_;
  World world_;
  StepPlan plan_;
};

double a_second(const PairTime &time) { return time.manifolds / std::max(time.milliseconds.median, 1e-9) * 1e3; }

} // namespace

std::vector<std::string> bench_pair_names()
{
  std::vector<std::string> names;
  for (const PairKind &kind : kinds()) names.push_back(kind.name);
  return names;
}

std::vector<PairTime> bench_narrowphase(const std::string &backend, uint32_t pairs,
                                        const std::vector<std::string> &only, bool allow_inexact)
{
  std::vector<PairTime> times;
  std::vector<PairKind> list = kinds();
  if (!only.empty())
    std::erase_if(list,
                  [&](const PairKind &kind) { return std::find(only.begin(), only.end(), kind.name) == only.end(); });
  Progress progress("colliding", list.size());
  for (const PairKind &kind : list) {
    Scene scene = scene_of(kind, pairs);
    bring_near(scene, !kind.b);
    for (const std::string &method : kind.methods)
      times.push_back(NarrowphaseBench(scene, method, backend, allow_inexact).run(kind, method));
    progress.update(uint64_t(&kind - list.data()) + 1);
  }
  progress.clear();
  return times;
}

std::string narrowphase_text(const std::vector<PairTime> &times)
{
  Table table({"pair", "method", "pairs", "manifolds", "points", "ms", "least", "most", "million a second"});
  for (const PairTime &t : times)
    table.add({t.pair, t.method.empty() ? "own" : t.method, fmt::format("{}", t.pairs), fmt::format("{}", t.manifolds),
               fmt::format("{}", t.points), fmt::format("{:.3f}", t.milliseconds.median),
               fmt::format("{:.3f}", t.milliseconds.minimum), fmt::format("{:.3f}", t.milliseconds.maximum),
               fmt::format("{:.4g}", a_second(t) * 1e-6)});
  return table.text("  ");
}

Json narrowphase_json(const std::vector<PairTime> &times)
{
  Json json = Json::array();
  for (const PairTime &t : times)
    json.push_back(
        {{"pair", t.pair},
         {"kernel", t.kernel},
         {"method", t.method.empty() ? Json(nullptr) : Json(t.method)},
         {"n", t.pairs},
         {"manifolds", t.manifolds},
         {"points", t.points},
         {"ms", {{"median", t.milliseconds.median}, {"min", t.milliseconds.minimum}, {"max", t.milliseconds.maximum}}},
         {"manifolds_per_second", a_second(t)}});
  return json;
}

int execute_narrowphase(const BenchOptions &options)
{
  const uint64_t pairs = options.count.empty() ? 4096 : whole_number("--n", options.count, 1, most_bodies / 2);
  options.json.check();
  const std::vector<PairTime> times =
      bench_narrowphase(options.on, static_cast<uint32_t>(pairs), options.pairs, options.inexact);
  if (!options.json.takes_standard_output())
    fmt::print("{} on {}: {} pairs of each kind\n{}", options.what, options.on, pairs, narrowphase_text(times));
  options.json.write(
      {{"what", options.what}, {"backend", options.on}, {"n", pairs}, {"pairs", narrowphase_json(times)}});
  return 0;
}

} // namespace tandem
