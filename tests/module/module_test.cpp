/* A module beside the pipeline's (tests/module/probe_kernels.def): its kernels run at every point, in every form and on
 * every backend, its buffers live as long as they say, and what does not fit is refused by name. */
#include <tandem/compare.h>
#include <tandem/load_scene.h>
#include <tandem/world.h>

#include "host/runtime/interface/module.h"
#include "host/runtime/launcher.h"
#include "host/runtime/memory.h"
#include "host/verify/breakpoint.h"
#include "tests/catch.h"
#include "tests/module/pushing.h"

using namespace tandem;
using namespace module_tests;
using Catch::Matchers::Contains;

TEST_CASE("module: a kernel at the forces pushes in each substep, on every backend")
{
  for (const std::string &backend : all_backends()) {
    CAPTURE(backend);
    World world(balls(100), with(pushing(3)), {backend, {}});
    for (int i = 0; i < 2; ++i) world.step();
    for (const BodyState &body : world.bodies()) {
      CHECK(body.linear_velocity[0] == 0.5f * 3 * 4 * 2);
      CHECK(body.linear_velocity[2] == -0.25f * 3 * 4 * 2);
    }
  }
}

TEST_CASE("module: what a STATE buffer counts is counted once a step, also of a step that ran again")
{
  Scene dense_cluster = balls(100);
  for (size_t i = 0; i < dense_cluster.bodies.size(); ++i)
    dense_cluster.bodies[i].position = {1e-4 * static_cast<double>(i), 0, 0};
  World world(dense_cluster, with(pushing(0)), {"tbb", {}});
  const uint64_t before = world.state_hash();
  for (int i = 0; i < 3; ++i) world.step();
  REQUIRE(world.statistics().overflow > 0);
  CHECK(world.read<uint32_t>(probe::buffer::probe_age()) == std::vector<uint32_t>(dense_cluster.bodies.size(), 3));
  CHECK(world.state_hash() != before);

  World other(dense_cluster, with(pushing(0)), {"tbb", {}});
  for (int i = 0; i < 3; ++i) other.step();
  CHECK(other.state_hash() == world.state_hash());
  const std::vector<uint32_t> one{7};
  other.write<uint32_t>(probe::buffer::probe_age(), one, dense_cluster.bodies.size() - 1);
  CHECK(other.state_hash() != world.state_hash());
  other.step();
  CHECK(other.read<uint32_t>(probe::buffer::probe_age()).back() == 8);
}

TEST_CASE("module: what it keeps of a body is 0 for a new one, also at the place of another")
{
  for (const bool anew : {false, true}) { /* whether the buffers are laid out anew */
    World world(balls(5), with(pushing(0)), {"serial", {}});
    for (int i = 0; i < 3; ++i) world.step();
    world.destroy_body(world.id_of(2));
    world.step();
    if (anew) world.add_shape(sphere_shape(0.2f));
    Body body;
    body.shape = anew ? 1 : 0;
    body.position = {4, 9, 0};
    REQUIRE(world.create_body(body).index == 2);
    world.step();
    CHECK(world.read<uint32_t>(probe::buffer::probe_age()).at(2) == 1);
    CHECK(world.read<uint32_t>(probe::buffer::probe_age()).at(3) == 5);
  }
}

TEST_CASE("module: a kernel between steps changes what the next step starts from")
{
  for (const std::string &backend : all_backends()) {
    CAPTURE(backend);
    Scene scene = balls(3);
    scene.bodies[1].linear_velocity = {0, 6, 0};
    World world(scene, with(pushing(0)), {backend, {}});
    world.step();
    world.run(probe::kernel::probe_turn_back());
    CHECK(world.bodies()[1].linear_velocity[1] == -6);
    world.step();
    CHECK(world.bodies()[1].position[1] == Approx(0).margin(1e-6));
  }
}

TEST_CASE("module: a kernel of groups takes what it lists once each, also in lanes that the list does not fill")
{
  Scene scene = balls(3000);
  for (uint32_t i = 0; i < 3000; ++i) scene.bodies[i].linear_velocity = {0, i % 7 == 0 ? 6.0f : 0.5f, 0};
  for (const std::string &backend : all_backends()) {
    CAPTURE(backend);
    World world(scene, with(pushing(0)), {backend, {}});
    world.step();
    world.run(probe::kernel::probe_calm());
    const std::vector<BodyState> bodies = world.bodies();
    for (uint32_t i = 0; i < 3000; ++i) REQUIRE(bodies[i].linear_velocity[1] == (i % 7 == 0 ? 3.0f : 0.5f));
  }
}

TEST_CASE("module: contacts that a kernel drops hold nothing")
{
  Scene scene = balls(4);
  scene.gravity = {0, -10, 0};
  scene.shapes.push_back(half_space_shape());
  for (Body &body : scene.bodies) body.position[1] = 0.1;
  Body ground;
  ground.type = BodyType::fixed;
  ground.shape = 1;
  scene.bodies.push_back(ground);
  Extension extension{&probe::module(), {}, {}};
  extension.prepare = [](World &world) {
    std::vector<uint32_t> ghosts;
    for (uint32_t i = 0; i < 5; ++i) ghosts.push_back(world.scene_body(i) == 2 ? 1 : 0);
    world.write<uint32_t>(probe::buffer::probe_ghost(), ghosts);
  };
  extension.launches = {{StepPoint::contacts, [](Launches &launches) { launches.run(probe::kernel::probe_drop()); }}};
  for (const std::string &backend : all_backends()) {
    World world(scene, with(extension), {backend, {}});
    for (int i = 0; i < 60; ++i) world.step();
    const std::vector<BodyState> bodies = world.bodies();
    CAPTURE(backend);
    CHECK(bodies[2].position[1] == Approx(0.1 - 0.5 * 10).margin(1e-3));
    CHECK(bodies[1].position[1] == Approx(0.1).margin(0.005));
  }
}

TEST_CASE("module: a group kernel takes the buffer that a launch names")
{
  Extension extension = pushing(0);
  extension.launches.push_back({StepPoint::commit, [](Launches &launches) {
                                  const Buffer slots[] = {probe::buffer::probe_age()};
                                  launches.run(probe::kernel::probe_sum(), {}, slots);
                                }});
  for (const std::string &backend : all_backends()) {
    CAPTURE(backend);
    World world(balls(3000), with(extension), {backend, {}});
    for (int i = 0; i < 5; ++i) world.step();
    const std::vector<uint32_t> totals = world.read<uint32_t>(probe::buffer::probe_total());
    CHECK(std::accumulate(totals.begin(), totals.end(), 0u) == 5 * 3000);
  }
}

TEST_CASE("module: its kernels are placed, profiled and compared as the pipeline's are")
{
  const Settings settings = with(pushing(1)); /* which adds the module, so that its stage has a name */
  World world(balls(10), settings, {"tbb", parse_placement("probe=serial")});
  world.set_profiling(true);
  world.step();
  uint64_t launches = 0;
  for (const KernelTime &time : world.take_kernel_times())
    if (time.kernel == probe::kernel::probe_push()) {
      CHECK(time.backend == "serial");
      launches += time.launches;
    }
  CHECK(launches == 4);
  CHECK(std::string(name_of(probe::kernel::probe_push())) == "probe_push");

  ComparisonRequest request{.settings = with(pushing(1)), .backends = all_backends(), .steps = 3};
  const Scene scene = load_scene("mixed:n=30");
  const Comparison same = compare_backends(scene, request);
  CHECK(same.equal);
  InjectedFault fault;
  fault.kernel = probe::kernel::probe_push();
  fault.buffer = Buffer::solver_velocity;
  fault.step = 2;
  fault.scalar = 8 * 5;
  request.inject_fault = inject_fault(fault);
  const Comparison different = compare_backends(scene, request);
  REQUIRE(different.first_difference);
  CHECK(different.first_difference->kernel == probe::kernel::probe_push());
  CHECK_THAT(different.first_difference->breakpoint,
             Contains("probe_push_item if i == 5 && tandem::step_of_launch == 2"));
}

TEST_CASE("module: what no kernel writes in a step stays as it was")
{
  Extension extension = pushing(0);
  int step = 0;
  extension.launches.back().second = [&step](Launches &launches) {
    if (step != 2) launches.run(probe::kernel::probe_count());
  };
  World world(balls(3), with(extension), {"tbb", {}});
  std::vector<uint32_t> seen;
  for (step = 0; step < 5; ++step) {
    world.step();
    seen.push_back(world.read<uint32_t>(probe::buffer::probe_age())[1]);
  }
  CHECK(seen == std::vector<uint32_t>{1, 2, 2, 3, 4});
}

TEST_CASE("module: a snapshot holds what its buffers hold, and asks for the module")
{
  World world(balls(5), with(pushing(1)), {"tbb", {}});
  world.write<uint32_t>(probe::buffer::probe_ghost(), std::vector<uint32_t>{1, 0, 1, 0, 1, 0, 1});
  world.write<uint32_t>(probe::buffer::probe_label(), std::vector<uint32_t>{7, 8, 9}, 1000);
  for (int i = 0; i < 3; ++i) world.step();
  const std::vector<std::byte> snapshot = world.save();
  Extension other = pushing(1);
  other.prepare = [](World &) { FAIL("the buffers of a snapshot are prepared already"); };
  World restored(snapshot, {"serial", {}}, {other});
  CHECK(restored.state_hash() == world.state_hash());
  CHECK(restored.read<float>(probe::buffer::probe_force()) == gust);
  CHECK(restored.read<uint32_t>(probe::buffer::probe_ghost()) == world.read<uint32_t>(probe::buffer::probe_ghost()));
  CHECK(restored.read<uint32_t>(probe::buffer::probe_label())[1002] == 9);
  for (World *one : {&world, &restored})
    for (int i = 0; i < 3; ++i) one->step();
  CHECK(restored.state_hash() == world.state_hash());
  CHECK(restored.read<uint32_t>(probe::buffer::probe_age()) == std::vector<uint32_t>(5, 6));
  CHECK(message_of([&] {
          World without(snapshot, {"serial", {}});
        }) ==
        "snapshot: its world had the modules [probe], and [] are given; give extensions of the same modules in the "
        "same order");
  world.restore(snapshot);
  world.step();
  CHECK(world.read<uint32_t>(probe::buffer::probe_age()) == std::vector<uint32_t>(5, 4));
}

TEST_CASE("module: a buffer of any size keeps what it had where there is no room for more, and grows else")
{
  World world(balls(3), with(pushing(0)), {"serial", {}});
  const std::vector<uint32_t> three{1, 2, 3}, five{4, 5, 6, 7, 8};
  world.write<uint32_t>(probe::buffer::probe_ghost(), three);
  CHECK_THROWS_AS(world.write_bytes(probe::buffer::probe_ghost(), three.data(), size_t{1} << 60), InputError);
  CHECK(world.read<uint32_t>(probe::buffer::probe_ghost()) == three);
  world.step();
  world.write<uint32_t>(probe::buffer::probe_ghost(), five);
  CHECK(world.read<uint32_t>(probe::buffer::probe_ghost()) == five);
  world.step();
}

TEST_CASE("module: buffers of pairs grow with the pairs, and keep what their lifetimes say")
{
  constexpr uint32_t bodies = 100, some = 20, few = some * (some - 1) / 2, many = bodies * (bodies - 1) / 2;
  const auto step_with_in_one_place = [](World &world, uint32_t count) {
    for (uint32_t body = 0; body < count; ++body) {
      BodyState state = world.bodies()[body];
      state.position = {1e-4 * body, 0, 0};
      state.linear_velocity = state.angular_velocity = {0, 0, 0};
      world.set_body(body, state);
    }
    world.step();
  };
  for (const std::string &backend : all_backends()) {
    CAPTURE(backend);
    Extension extension{&probe::module(), {}, {}};
    extension.launches = {
        {StepPoint::commit, [](Launches &launches) { launches.run(probe::kernel::probe_count_places()); }}};
    World world(balls(bodies), with(extension), {backend, {}});
    const Buffer age = probe::buffer::probe_place_age(), label = probe::buffer::probe_label(),
                 note = probe::buffer::probe_note(), mark = probe::buffer::probe_mark();
    step_with_in_one_place(world, some);
    REQUIRE(world.statistics().pairs == few);
    const std::vector<uint32_t> three{7, 8, 9};
    for (const Buffer buffer : {label, note, mark}) world.write<uint32_t>(buffer, three);
    const size_t room = world.buffer_bytes(age) / sizeof(uint32_t);
    REQUIRE(room < many);
    step_with_in_one_place(world, some);
    std::vector<uint32_t> ages(room, 0);
    std::fill(ages.begin(), ages.begin() + few, 2);
    CHECK(world.read<uint32_t>(age) == ages);
    CHECK(world.read<uint32_t>(label)[2] == 9);

    step_with_in_one_place(world, bodies);
    REQUIRE(world.statistics().overflow > 0);
    REQUIRE(world.statistics().pairs == many);
    const size_t grown = world.buffer_bytes(age) / sizeof(uint32_t);
    REQUIRE(grown >= many);
    ages.assign(grown, 0);
    std::fill(ages.begin(), ages.begin() + many, 1);
    std::fill(ages.begin(), ages.begin() + few, 3);
    CHECK(world.read<uint32_t>(age) == ages); /* counted once, though the step ran again */
    std::vector<uint32_t> labels(grown, 0);
    std::copy(three.begin(), three.end(), labels.begin());
    CHECK(world.read<uint32_t>(label) == labels);
    CHECK(world.read<uint32_t>(note) == std::vector<uint32_t>(grown, 0));
    CHECK(world.read<uint32_t>(mark) == std::vector<uint32_t>(grown, 0));
  }
}

TEST_CASE("module: a world that is placed elsewhere between steps keeps its bits")
{
  Extension extension = pushing(1);
  extension.launches.push_back(
      {StepPoint::commit, [](Launches &launches) { launches.run(probe::kernel::probe_count_places()); }});
  const Scene scene = load_scene("mixed:n=30");
  World undisturbed(scene, with(extension), {"serial", {}}), world(scene, with(extension), {"tbb", {}});
  struct Place {
    const char *on, *exceptions, *of_push;
  };
  std::vector<Place> places{{"serial", "probe=tbb:threads=2,lanes=4", "tbb:threads=2,lanes=4"},
                            {"tbb:threads=2,lanes=4", "probe_push=serial", "serial"},
                            {"tbb", "probe=serial:order=backward,integrate=serial", "serial:order=backward"},
                            {"serial", "", "serial"}};
  if (parity::has_pocl()) {
    places.push_back({"tbb", "probe=cl:pocl", "cl:pocl"});
    places.push_back({"cl:pocl", "probe=serial", "serial"});
    places.push_back({"cl:pocl", "", "cl:pocl"});
    places.push_back({"tbb", "", "tbb"});
  } else {
    tests::leave_out_device("an OpenCL device among the places");
  }
  for (const Place &place : places) {
    CAPTURE(place.on, place.exceptions);
    const std::string exceptions = place.exceptions;
    world.place({place.on, exceptions.empty() ? Placement{}.exceptions : parse_placement(exceptions), false});
    CHECK(world.backend_of(probe::kernel::probe_push()).name() == place.of_push);
    for (int i = 0; i < 2; ++i) {
      undisturbed.step();
      world.step();
      REQUIRE(world.state_hash() == undisturbed.state_hash());
    }
  }
  CHECK(world.read<uint32_t>(probe::buffer::probe_age()) ==
        std::vector<uint32_t>(scene.bodies.size(), 2 * static_cast<uint32_t>(places.size())));
}

TEST_CASE("module: kernels over counts that have no bound before they are made are refused in one line")
{
  static const KernelRow rows[] = {{"boundless_groups", own_stage, Execution::group, COUNT_EVENTS, 0, {}},
                                   {"boundless_items", own_stage, Execution::item, COUNT_COLORS, 0, {}},
                                   {"boundless_given", own_stage, Execution::group, items_given, 0, {}},
                                   {"boundless_capacity", own_stage, Execution::group, CAPACITY_PAIRS, 0, {}}};
  static const std::vector<EmbeddedProgram> programs;
  const Module &boundless = add_module({"boundless", rows, {}, {}, &programs});
  World world(balls(3), with({&boundless, {}, {}}), {"serial", {}});
  for (size_t row = 0; row < std::size(rows); ++row) {
    const std::string name = rows[row].name;
    const std::string expected = "kernel '" + name + "' cannot be launched: its row may name ONE,";
    const std::string between = message_of([&] { world.run(boundless.kernel(row)); });
    CHECK_THAT(between, Contains(expected));
    CHECK(between.find('\n') == std::string::npos);
    const Extension in_step{
        &boundless, {}, {{StepPoint::solved, [&](Launches &launches) { launches.run(boundless.kernel(row)); }}}};
    CHECK_THAT(message_of([&] { World(balls(3), with(in_step), {"serial", {}}); }), Contains(expected));
  }
  world.step();
}

TEST_CASE("module: lists that are added while a world lives are none of its own")
{
  World world(balls(100), with(pushing(0)), {"serial", {}});
  static const std::vector<BufferRow> late(
      100, {"late_buffer", Element::uint, Capacity::BODIES, 1, 0, Lifetime::SCRATCH, "value"});
  static const KernelRow kernel{"late_kernel", own_stage, Execution::item, COUNT_BODIES, 0, {}};
  static const std::vector<EmbeddedProgram> programs;
  add_module({"late_module", {&kernel, 1}, late, {}, &programs});
  for (uint32_t body = 0; body < 100; ++body) {
    BodyState state = world.bodies()[body];
    state.position = {1e-4 * body, 0, 0};
    world.set_body(body, state);
  }
  world.step(); /* more pairs than there was room for */
  CHECK(world.statistics().overflow > 0);
  const Buffer late_buffer = buffer_named("late_buffer");
  CHECK(world.buffer_bytes(late_buffer) == 0);
  CHECK_THAT(message_of([&] {
               world.run(probe::kernel::probe_sum(), {}, {&late_buffer, 1});
             }),
             Contains("has room for 0 elements"));
}

TEST_CASE("module: a world without it neither holds nor runs anything of it")
{
  World world(balls(3), {}, {"serial", {}});
  world.step();
  CHECK(world.buffer_bytes(probe::buffer::probe_age()) == 0);
  for (const Kernel kernel : world.kernels()) CHECK(row_of(kernel).stage != probe::module().stage());
}

TEST_CASE("module: what does not fit is refused by name")
{
  World plain(balls(3), {}, {"serial", {}}), world(balls(3), with(pushing(1)), {"serial", {}});
  const std::vector<float> four(4), five(5);
  CHECK_THAT(message_of([&] { plain.run(probe::kernel::probe_push()); }),
             Contains("kernel 'probe_push' cannot be launched: it is of no module"));
  CHECK_THAT(message_of([&] { plain.write<float>(probe::buffer::probe_force(), four); }), Contains("of no module"));
  CHECK_THAT(message_of([&] { world.write<float>(Buffer::body_velocity, four); }), Contains("'body_velocity'"));
  CHECK_THAT(message_of([&] { world.write<float>(probe::buffer::probe_force(), five); }),
             Contains("'probe_force' has 16 bytes, not 20"));
  CHECK_THAT(message_of([&] { world.write<float>(probe::buffer::probe_force(), four, 1); }),
             Contains("from byte 4 on"));
  CHECK_THAT(message_of([&] { world.run(Kernel::fill); }), Contains("kernel 'fill'"));
  CHECK_THAT(message_of([&] { world.run(Kernel{30000}); }), Contains("kernel 30000 is of no module"));
  CHECK_THAT(message_of([&] { world.read<float>(Buffer{30000}); }), Contains("buffer 30000 is of no module"));
  CHECK_THAT(message_of([&] { world.write<float>(probe::buffer::probe_force(), four, size_t{1} << 62); }),
             Contains("has 16 bytes"));
  CHECK_THAT(message_of([&] { world.run(probe::kernel::probe_drop()); }), Contains("'probe_ghost' is empty"));
  CHECK_THAT(message_of([&] { world.run(probe::kernel::probe_push()); }), Contains("it takes 1 values and 0 slots"));
  const auto sum = [&](Buffer slot) {
    return message_of([&] { world.run(probe::kernel::probe_sum(), {}, {&slot, 1}); });
  };
  CHECK_THAT(sum(Buffer::body_velocity), Contains("elements of another type than the slot 'values'"));
  CHECK_THAT(sum(buffer_named("kept_start")), Contains("has room for 0 elements"));
  const std::vector<uint32_t> nine(9);
  CHECK_THAT(message_of([&] { world.run(probe::kernel::probe_push(), nine); }), Contains("more buffers or values"));
  Extension early = pushing(0);
  early.launches = {{StepPoint::begin, [](Launches &launches) { launches.run(probe::kernel::probe_count()); }}};
  CHECK_THAT(message_of([&] { World(balls(1), with(early), {"serial", {}}); }), Contains("lasts beyond the step"));
  early.launches = {{StepPoint::begin, {}}};
  CHECK_THAT(message_of([&] { World(balls(1), with(early), {"serial", {}}); }), Contains("has no function"));
  for (const int beyond : {static_cast<int>(StepPoint::commit) + 1, 255}) {
    early.launches = {{static_cast<StepPoint>(beyond), [](Launches &) {}}};
    CHECK_THAT(message_of([&] { World(balls(1), with(early), {"serial", {}}); }), Contains("no point of the step"));
  }
  Settings twice = with(pushing(1));
  twice.extensions.push_back(pushing(2));
  CHECK_THAT(message_of([&] { World(balls(1), twice, {"serial", {}}); }), Contains("module 'probe' is given twice"));
  CHECK_THAT(message_of([&] { World(balls(1), with({}), {"serial", {}}); }), Contains("names no module"));
}

TEST_CASE("module: a write into a part of a buffer that writes size leaves the rest as it is")
{
  World world(balls(3), with(pushing(1)), {"serial", {}});
  const Buffer ghost = probe::buffer::probe_ghost();
  const std::vector<uint32_t> five{1, 2, 3, 4, 5}, one{9};
  world.write<uint32_t>(ghost, five);
  world.write<uint32_t>(ghost, one, 2);
  CHECK(world.read<uint32_t>(ghost) == std::vector<uint32_t>{1, 2, 9, 4, 5});
  CHECK_THAT(message_of([&] { world.write<uint32_t>(ghost, one, 5); }), Contains("'probe_ghost' has 20 bytes"));
  const std::vector<char> three_bytes(3);
  CHECK_THAT(message_of([&] { world.write<char>(ghost, three_bytes); }), Contains("'probe_ghost' has 20 bytes"));
  CHECK(world.read<uint32_t>(ghost) == std::vector<uint32_t>{1, 2, 9, 4, 5});
}

TEST_CASE("module: lists are added once, and a name that is taken is refused")
{
  const KernelRow mine{"module_test_kernel", own_stage, Execution::item, COUNT_BODIES, 0, {}};
  const BufferRow taken{"body_velocity", Element::float4, Capacity::BODIES, 1, 0, Lifetime::SCENE, ""};
  CHECK(&probe::module() == &probe::module());
  const size_t modules = module_count();
  const auto added = [&](const char *name, std::span<const KernelRow> kernels, std::span<const BufferRow> buffers) {
    return message_of([&] { add_module({name, kernels, buffers, {}, nullptr}); });
  };
  CHECK(&add_module(probe::module().lists()) == &probe::module());
  CHECK_THAT(added("solve", {&mine, 1}, {}), Contains("module 'solve'"));
  CHECK_THAT(added("probe", {&mine, 1}, {}), Contains("module 'probe'"));
  CHECK_THAT(added("other", {&mine, 1}, {&taken, 1}), Contains("buffer 'body_velocity' is already there"));
  CHECK(module_count() == modules);
}
