/* compare_test.cpp - the comparison of backends must find planted errors of one ulp. */
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <tandem/compare.h>

#include "host/catalog/catalog.h"
#include "host/runtime/interface/backend.h"
#include "host/runtime/memory.h"
#include "host/verify/breakpoint.h"
#include "host/verify/buffer_location.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

ComparisonRequest request_of(std::vector<std::string> backends, uint64_t steps)
{
  ComparisonRequest request;
  request.backends = std::move(backends);
  request.steps = steps;
  return request;
}

Scene small_scene() { return load_scene("box-grid:nx=3,ny=3,nz=3"); }

/* The position of a number: row `item` of the buffer, or row `plane` of the item, and the component in it. */
size_t scalar_of_record(size_t item, size_t rows, size_t row, size_t component)
{
  return (item * rows + row) * 4 + component;
}

Difference find_injected(Kernel kernel, Buffer buffer, size_t scalar, uint64_t step, size_t world = 1,
                         const Scene &scene = small_scene())
{
  ComparisonRequest request = request_of({"serial", "tbb:threads=1,lanes=4"}, step + 3);
  request.settings.broadphase = Broadphase::grid; /* which has sort keys */
  request.inject_fault = inject_fault({world, kernel, step, buffer, scalar});
  const Comparison comparison = compare_backends(scene, request);
  REQUIRE_FALSE(comparison.equal);
  REQUIRE(comparison.first_difference);
  CHECK(comparison.steps == step + 1);
  const Difference &found = *comparison.first_difference;
  CHECK(found.step == step);
  REQUIRE(found.kernel);
  CHECK(std::string(row_of(*found.kernel).name) == row_of(kernel).name);
  REQUIRE(found.buffer);
  CHECK(std::string(row_of(*found.buffer).name) == row_of(buffer).name);
  CHECK(found.scalar == scalar);
  CHECK(found.differing == 1);
  CHECK(found.values[0].bits != found.values[1].bits);
  CHECK(found.breakpoint.find(row_of(kernel).name) == 0);
  CHECK(found.breakpoint.find("tandem::step_of_launch == " + std::to_string(step)) != std::string::npos);
  return found;
}

uint32_t pairs_within_capacity()
{
  World world(small_scene(), Settings{}, Placement{"serial", {}, false});
  return static_cast<uint32_t>(pair_capacity(world));
}

} // namespace

TEST_CASE("compare: backends of the CPU are equal in every kernel", "[compare]")
{
  ComparisonRequest request =
      request_of({"serial", "serial:order=backward", "tbb:threads=2,lanes=1", "tbb:threads=2,lanes=4"}, 8);
  const Comparison comparison = compare_backends(small_scene(), request);
  if (comparison.first_difference && comparison.first_difference->kernel)
    INFO(row_of(*comparison.first_difference->kernel).name);
  CHECK(comparison.equal);
  CHECK(comparison.steps == 8);
  CHECK(comparison.kernels_compared > 3 * 8 * 20);
  CHECK(comparison.bytes_compared > comparison.kernels_compared);
}

TEST_CASE("compare: one ulp in the bounds of a body", "[compare]")
{
  const Difference found = find_injected(Kernel::compute_bounds, Buffer::bounds, scalar_of_record(7, 2, 1, 2), 0);
  CHECK(found.location.item == 7);
  CHECK(found.location.element == 15);
  CHECK(found.location.field == "upper.z");
  CHECK(found.ulps == 1u);
  CHECK(found.bodies.size() == 1);
  CHECK(found.breakpoint.find("i == 7 &&") != std::string::npos);
}

TEST_CASE("compare: one ulp in the separation of a contact point", "[compare]")
{
  const size_t element = 2 * pairs_within_capacity() + 4; /* plane 2, pair 4 */
  const Difference found = find_injected(Kernel::collide_box_box, Buffer::manifold_points, element * 4 + 3, 2);
  CHECK(found.location.item == 4);
  CHECK(found.location.element == element);
  CHECK(found.location.field == "separation[2]");
  CHECK(found.ulps == 1u);
  CHECK(found.bodies.size() == 2);
}

/* Kernels of pairs run over lists where kinds mix: the line names the place in the list. */
TEST_CASE("compare: one ulp of a pair that stands in a list", "[compare]")
{
  const Scene scene = load_scene("mixed:n=100");
  World world(scene, Settings{}, Placement{"serial", {}, false});
  REQUIRE((world.features() & FEATURE_PAIR_KINDS) != 0);
  world.set_observer([](const Launch &) {}); /* so that no list lies in the memory of another buffer */
  uint32_t last = 0;
  uint64_t step = 0;
  for (uint32_t first = 0; last < first + 2 && step < 200; ++step) {
    world.step();
    const auto starts = world.memory().read<uint32_t>(Buffer::counts, PAIR_KIND_NONE + 1, KIND_START);
    first = starts[PAIR_KIND_SPHERE_BOX], last = starts[PAIR_KIND_SPHERE_BOX + 1];
  }
  REQUIRE(step < 200);
  --step;
  const uint32_t location = last - 1, pair = world.memory().read<uint32_t>(Buffer::pair_of_kind, 1, location).at(0);
  REQUIRE(location != pair);
  const Difference found = find_injected(Kernel::collide_sphere_box, Buffer::manifold_normal, 4 * pair, step, 1, scene);
  CHECK(found.location.item == pair);
  CHECK(found.breakpoint.find("i == " + std::to_string(location) + " &&") != std::string::npos);
  const std::vector<uint32_t> in_list = bodies_of_item(world, Buffer::pair_of_kind, location);
  CHECK(in_list.size() == 2);
  CHECK(in_list == bodies_of_item(world, Buffer::manifold_normal, pair));
}

TEST_CASE("compare: the last bit of a sort key", "[compare]")
{
  const Difference found = find_injected(Kernel::grid_keys, Buffer::sort_key, 3, 1);
  CHECK(found.location.item == 3);
  CHECK(found.location.field == "key");
  CHECK_FALSE(found.ulps);
}

TEST_CASE("compare: one ulp in a constraint", "[compare]")
{
  const Difference found = find_injected(Kernel::prepare_contacts, Buffer::constraint_normal, 5 * 4 + 3, 1);
  CHECK(found.location.item == 5);
  CHECK(found.location.field == "friction");
  CHECK(found.ulps == 1u);
  CHECK(found.bodies.size() == 2);
}

TEST_CASE("compare: one ulp in a velocity, and the constraint that wrote it", "[compare]")
{
  const uint64_t step = 2;
  World world(small_scene(), Settings{}, Placement{"serial", {}, false});
  for (uint64_t k = 0; k <= step; ++k) world.step();
  /* The body is that of the first constraint, which has the first colour, whose launch is the first. */
  const uint32_t body = world.memory().read<uint32_t>(Buffer::constraint_b, 1, 0).at(0);
  const Difference found =
      find_injected(Kernel::solve_contacts, Buffer::solver_velocity, scalar_of_record(body, 2, 1, 0), step);
  CHECK(found.location.field == "angular.x");
  CHECK(found.ulps == 1u);
  const size_t at = found.breakpoint.find("i == ");
  CAPTURE(found.breakpoint);
  REQUIRE(at != std::string::npos);
  const auto constraint = static_cast<size_t>(std::stoul(found.breakpoint.substr(at + 5)));
  const uint32_t a = world.memory().read<uint32_t>(Buffer::constraint_a, 1, constraint).at(0);
  const uint32_t b = world.memory().read<uint32_t>(Buffer::constraint_b, 1, constraint).at(0);
  CHECK((a == body || b == body));
}

TEST_CASE("compare: one ulp in a position, on the reference itself", "[compare]")
{
  const Difference found =
      find_injected(Kernel::integrate_positions, Buffer::solver_delta_pose, scalar_of_record(9, 2, 0, 1), 1, 0);
  CHECK(found.location.field == "translation.y");
  CHECK(found.ulps == 1u);
}

TEST_CASE("compare: a reference that does not repeat itself is named", "[compare]")
{
  int worlds_seen = 0;
  World *last = nullptr;
  ComparisonRequest request = request_of({"serial", "serial:order=backward"}, 2);
  request.inject_fault = [&](size_t index, uint64_t, World &world, const Launch &launch) {
    if (index != 0 || launch.kernel != Kernel::compute_bounds) return;
    if (last != &world) ++worlds_seen, last = &world;
    if (worlds_seen > 1) return; /* its second run is clean */
    float value = 1234.0f;
    world.memory().upload(Buffer::bounds, &value, sizeof value, 0);
  };
  const Comparison comparison = compare_backends(small_scene(), request);
  REQUIRE(comparison.first_difference);
  CHECK(comparison.first_difference->note.find("does not repeat itself") != std::string::npos);
}

TEST_CASE("compare: takes two backends", "[compare]")
{
  CHECK_THROWS_AS(compare_backends(small_scene(), request_of({"serial"}, 1)), InputError);
}

TEST_CASE("buffer place: records, planes, single numbers", "[compare]")
{
  const BufferLocation velocity = location_in(Buffer::body_velocity, scalar_of_record(3, 2, 1, 1), 100);
  CHECK(velocity.item == 3);
  CHECK(velocity.field == "angular.y");
  const BufferLocation rolling = location_in(Buffer::constraint_rolling, (100 + 17) * 4, 100);
  CHECK(rolling.item == 17);
  CHECK(rolling.part == 1);
  CHECK(rolling.field == "x_or_rolling[1]");
  const BufferLocation points = location_in(Buffer::constraint_points, 100 * 9 + 17, 100);
  CHECK(points.item == 17);
  CHECK(points.part == 9);
  CHECK(points.field == "mass[1]");
  const BufferLocation pair = location_in(Buffer::pair_a, 42, 100);
  CHECK(pair.item == 42);
  CHECK(pair.field == "body");
}

TEST_CASE("buffer place: values and their distance", "[compare]")
{
  const auto ulps = [](float a, float b) { return ulps_between(Buffer::body_position, &a, &b); };
  CHECK(ulps(1.0f, 1.0f) == 0u);
  CHECK(ulps(1.0f, std::nextafter(1.0f, 2.0f)) == 1u);
  CHECK(ulps(1.0f, 2.0f) == 1u << 23);
  CHECK(ulps(-1e-45f, 1e-45f) == 2u);
  CHECK(ulps(0.0f, -0.0f) == 1u);
  CHECK_FALSE(ulps(1.0f, std::nanf("")));
  const float eighth = 0.125f;
  CHECK(value_at(Buffer::body_position, &eighth).decimal == "0.125");
  CHECK(value_at(Buffer::body_position, &eighth).bits == "0x3e000000");
  float one = -1.0f;
  change_least(Buffer::body_position, &one);
  CHECK(one == std::nextafter(-1.0f, -2.0f));
}

/* The parameter that the gdb line compares must exist: read from the shared functions themselves. */
TEST_CASE("breakpoint: names the item as its kernel does", "[compare]")
{
  std::string sources;
  for (const auto &entry : std::filesystem::recursive_directory_iterator(TANDEM_SOURCE_DIR "/shared"))
    if (entry.path().extension() == ".h") {
      std::ifstream file(entry.path());
      std::stringstream text;
      text << file.rdbuf();
      sources += text.str();
    }
  for (size_t k = 0; k < kernel_count; ++k) {
    const std::string name = iteration_name(kernel_at(k));
    if (name.empty()) continue;
    const KernelRow &row = row_of(kernel_at(k));
    const std::string function =
        std::string("void ") + row.name + (row.execution == Execution::group ? "_group(" : "_item(");
    const size_t start = sources.find(function);
    INFO(row.name);
    REQUIRE(start != std::string::npos);
    const std::string parameters = sources.substr(start, sources.find(')', start) - start);
    CHECK(parameters.substr(parameters.find_last_of(" *") + 1) == name);
  }
}

TEST_CASE("settings: what cannot be simulated is refused", "[settings]")
{
  CHECK_NOTHROW(validate(Settings{}));
  const auto refused = [](auto change) {
    Settings settings;
    change(settings);
    CHECK_THROWS_AS(validate(settings), InputError);
  };
  for (const float step : {0.0f, -0.1f, std::nanf(""), INFINITY, 1e9f}) refused([&](Settings &s) { s.step = step; });
  for (const uint32_t count : {0u, 1001u}) {
    refused([&](Settings &s) { s.substeps = count; });
    refused([&](Settings &s) { s.iterations = count; });
  }
  refused([](Settings &s) { s.contact_hertz = 0; });
  refused([](Settings &s) { s.slop = -1; });
  refused([](Settings &s) { s.step = 1e-9f, s.substeps = 1000; });
}

/* Two numbers of one buffer, as floats would lie in it. */
TEST_CASE("compare: NaN equals NaN of any sign and payload, and nothing else", "[compare]")
{
  const uint32_t nan = 0x7fc00000, minus_nan = 0xffc00000, payload = 0x7fffffff, infinite = 0x7f800000, zero = 0,
                 minus_zero = 0x80000000;
  const Buffer reals = Buffer::solver_velocity, integers = Buffer::body_flags;
  for (const uint32_t other : {nan, minus_nan, payload}) {
    CHECK(same_number(reals, &nan, &other));
    CHECK(hash_numbers(reals, &nan, 4) == hash_numbers(reals, &other, 4));
  }
  for (const uint32_t other : {infinite, zero}) {
    CHECK_FALSE(same_number(reals, &nan, &other));
    CHECK(hash_numbers(reals, &nan, 4) != hash_numbers(reals, &other, 4));
  }
  CHECK_FALSE(same_number(reals, &zero, &minus_zero));
  CHECK(hash_numbers(reals, &zero, 4) != hash_numbers(reals, &minus_zero, 4));
  CHECK_FALSE(same_number(integers, &nan, &minus_nan));
  CHECK(hash_numbers(integers, &nan, 4) != hash_numbers(integers, &minus_nan, 4));
}

TEST_CASE("compare: NaN is found at any place of a buffer of any length", "[compare]")
{
  for (size_t count = 1; count <= 21; ++count)
    for (size_t place = 0; place < count; ++place)
      for (const uint32_t ordinary : {0x00000000u, 0x80000000u, 0x7f7fffffu, 0x7f800000u, 0xff800000u}) {
        std::vector<uint32_t> one(count, ordinary), other = one, infinite = one;
        one[place] = 0x7f800001u, other[place] = 0xffffffffu, infinite[place] = 0x7f800000u;
        CAPTURE(count, place, ordinary);
        const auto hash = [&](const std::vector<uint32_t> &numbers) {
          return hash_numbers(Buffer::solver_velocity, numbers.data(), 4 * count);
        };
        CHECK(hash(one) == hash(other));
        CHECK(hash(one) != hash(infinite));
      }
}

TEST_CASE("compare: a NaN of another sign is not taken for the first number that differs", "[compare]")
{
  ComparisonRequest request = request_of({"serial", "tbb:threads=1,lanes=4"}, 2);
  const size_t unused = 3, changed = 4 * 7 + 1;
  request.inject_fault = [&](size_t index, uint64_t, World &world, const Launch &launch) {
    if (launch.kernel != Kernel::compute_bounds) return;
    const uint32_t nan = index == 0 ? 0x7fc00000 : 0xffc00000, other = 0x3f800000;
    world.memory().upload(Buffer::bounds, &nan, sizeof nan, unused * sizeof nan);
    if (index == 1) world.memory().upload(Buffer::bounds, &other, sizeof other, changed * sizeof other);
  };
  const Comparison comparison = compare_backends(small_scene(), request);
  REQUIRE(comparison.first_difference);
  CHECK(comparison.first_difference->scalar == changed);
  CHECK(comparison.first_difference->differing == 1);
}

/* Speeds that the solver's squares cannot hold, between bodies that touch: infinity less infinity is made in lanes
 * and in scalars with other signs. */
TEST_CASE("compare: bodies that stop being finite in the solver do so alike in scalars and in lanes", "[compare]")
{
  Scene scene = load_scene("box-grid:nx=4,ny=4,nz=4");
  for (size_t body = 1; body < scene.bodies.size(); body += 3)
    scene.bodies[body].linear_velocity = {3e37f, -3e38f, 1e38f};
  for (const Solver solver : {Solver::soft_step, Solver::jacobi}) {
    ComparisonRequest request = request_of({"serial", "tbb:threads=2,lanes=4", "serial:order=backward"}, 2);
    request.settings = settings_for(solver);
    const Comparison comparison = compare_backends(scene, request);
    CAPTURE(solver);
    CHECK(comparison.equal);
    CHECK(comparison.quarantined.size() > 10);
  }
}
