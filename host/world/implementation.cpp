/* implementation.cpp - makes a world: a dry run finds what its steps need, and the scene is uploaded. */
#include "host/world/implementation.h"

#include <algorithm>
#include <bit>
#include <chrono>

#include <fmt/format.h>

#include <tandem/error.h>

#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/scene_counts.h"
#include "host/pipeline/setting_rows.h"
#include "host/pipeline/solvers/solvers.h"
#include "host/runtime/interface/floating_point.h"
#include "host/runtime/interface/module.h"
#include "host/runtime/recorder.h"
#include "host/scene/built.h"
#include "host/scene/joint_buffers.h"
#include "host/scene/parameters.h"
#include "host/world/forced_features.h"
#include "shared/batching/limits.h"

namespace tandem {
namespace {

Velocity initial_velocity_of(const Body &body) { return {body.linear_velocity, body.angular_velocity}; }

} // namespace

void check_solver(const Settings &settings, const Body &body, size_t index, const std::string &where)
{
  if (settings.solver == Solver::avbd && locks_of(body) != 0)
    throw InputError(fmt::format("{}: body {}: linear_locks, angular_locks: the solver avbd has no locks of axes; all "
                                 "other solvers have",
                                 where, index));
}

World::Implementation::Beginning World::Implementation::beginning_of(const Scene &given, const Settings &chosen)
{
  const auto bodies = static_cast<uint32_t>(given.bodies.size());
  const uint32_t pairs = first_capacity(given, chosen);
  return {given, chosen, specialise(given, chosen), BodySlots(bodies), bodies, pairs, false, 0};
}

World::Implementation::Implementation(const Scene &given, const Settings &chosen, const Placement &placement)
    : Implementation(beginning_of(given, chosen), placement)
{}

namespace {

/* Whether no world has two articulations, and all of them have tables of paths, so that none walks. The bodies of a
 * batch follow each other by world. */
bool are_apart(const JointedLinks &links, size_t bodies_of_world)
{
  if (std::find(links.freedoms.begin(), links.freedoms.end(), 0u) != links.freedoms.end()) return false;
  std::set<size_t> worlds;
  return std::all_of(links.trees.begin(), links.trees.end(), [&](const std::vector<uint32_t> &tree) {
    return tree.empty() || worlds.insert(tree.front() / bodies_of_world).second;
  });
}

} // namespace

World::Implementation::Implementation(Beginning beginning, const Placement &placement, const PlacedBackends *shared)
    : scene(std::move(beginning.scene)), settings(std::move(beginning.settings)),
      settings_in_use(with_substeps(settings, first_choice(settings))),
      chooses(settings.broadphase == Broadphase::automatic), special(std::move(beginning.special)),
      hulls(hull_sizes(scene, hull_maps(settings))), trees(tree_tables(scene)), forced_features(beginning.forced),
      scene_features(special.features),
      automatic(placement.automatic ? std::make_unique<AutomaticPlacement>(placement) : nullptr),
      backends(shared ? PlacedBackends(*shared, features_run())
                      : PlacedBackends(AutomaticPlacement::first_of(placement), features_run())),
      buffers(memory, backends), joint_graph(joint_graph_of(scene, std::max(special.worlds, 1u))),
      coupling_graph(coupling_graph_of(scene, std::max(special.worlds, 1u))), joint_order(scene, joint_graph),
      joint_slots(scene.joints.size()), links(links_of(scene)), slots(std::move(beginning.slots)),
      launcher(memory, [this](Kernel kernel) -> Backend & { return backends.of(kernel); }), parts(memory)
{
  check_built(scene_features, scene, settings, scene.name);
  check_couplings(settings, scene);
  check_articulations(settings, scene);
  launcher.set_on_commit([this] { turn(); });
  plan.forces = beginning.forces || module_applies_forces();
  plan.sleeping = settings.sleeping;
  plan.substeps = first_choice(settings);
  told_substeps = {plan.substeps.now, plan.substeps.of_cache, false};
  special.features = features_run();
  plan.features = special.features;
  plan.bodies = beginning.room;
  scene_entries = entries_of({special.awake, special.unbounded, special.large, bodies() - special.awake});
  plan.joint_colors = joint_order.colors();
  plan.link_joint_colors = joint_order.link_colors();
  plan.joint_axes = joint_graph.axes;
  plan.coupling_colors = coupling_graph.colors;
  plan.links_alone = true;
  plan.trees_apart = are_apart(links, scene.bodies.size() / std::max(special.worlds, 1u));
  for (uint32_t slot = 0; slot < scene.bodies.size(); ++slot) plan_for_body(slot);
  counted_bodies = special.awake;
  plan.capacity_cells = cells_for(plan.bodies);
  plan.capacity_pairs = plan.capacity_candidates = beginning.pairs;
  choose_broadphase_after(std::nullopt);
  record_kernels();
  validate(placement);
  place(backends.wanted());
  if (automatic) automatic->look_for_device(backends, buffers.needs().kernels);
  buffers.set_sharing(settings.extensions.empty());
  /* Both ask whose pairs they were: of islands that fall asleep, and of batches at fault. */
  if (settings.sleeping || settings.check) buffers.keep_after_steps(Buffer::pair_a);
  buffers.allocate(sizes());
  upload_scene();
  guess_counts();
  for (uint32_t slot = 0; slot < slots.count(); ++slot) {
    note_motion(slot, initial_velocity_of(scene.bodies[slot]));
    if (scene.bodies[slot].type == BodyType::dynamic) ++awake_dynamics;
  }
}

std::unique_ptr<World> world_with_features(const Scene &scene, const Settings &settings, const Placement &placement,
                                           Features forced)
{
  const minicl::ExactFloatingPoint environment;
  World::Implementation::Beginning beginning = World::Implementation::beginning_of(scene, settings);
  beginning.forced = forced;
  return std::unique_ptr<World>(
      new World(std::make_unique<World::Implementation>(std::move(beginning), placement, nullptr)));
}

World::Implementation::~Implementation() { backends.finish_at_last(); }

Sizes World::Implementation::sizes() const
{
  return {.bodies = plan.bodies,
          .materials = static_cast<uint32_t>(scene.materials.size()),
          .hulls = hulls,
          .trees = trees.sizes,
          .joints = static_cast<uint32_t>(scene.joints.size()),
          .joint_axes = joint_graph.axes,
          .couplings = static_cast<uint32_t>(scene.couplings.size()),
          .articulations = links.room.trees,
          .links = links.room.links,
          .path_entries = links.paths.entries,
          .tree_freedoms = links.most_freedoms(),
          .joined_pairs = joint_graph.joined_pairs,
          .pairs = plan.capacity_pairs,
          .cells = plan.capacity_cells,
          .candidates = settings.broadphase == Broadphase::trees ? plan.capacity_candidates : 0,
          .features = special.features};
}

namespace {

/* Queries between steps read the parts of shapes, even if no kernel of the step does; a scene of one capsule, for
 * example, collides nothing. */
void note_shapes(Recorder &recorder)
{
  for (const Argument &argument : row_of(Kernel::cast_rays).arguments)
    if (argument.kind == Argument::Kind::buffer && row_of(argument.buffer).lifetime == Lifetime::SCENE)
      recorder.touched[index_of(argument.buffer)] = true;
}

} // namespace

/* Records the kernels and buffers of the overflow constraints only once there are some; those of contacts always, even
 * where steps look for pairs alone, because the next step may find some. */
void World::Implementation::record_kernels()
{
  plan.apart = false;
  StepPlan all = plan;
  all.links_alone = all.trees_apart = false;
  all.colors = std::max(plan.colors, COLOR_LIMIT);
  all.joint_colors = joint_graph.colors; /* whoever sleeps */
  all.link_joint_colors = joint_graph.link_colors;
  all.substeps.starts = all.substeps.automatic;
  all.islands_apart = may_part_islands();
  all.classes = all.islands_apart ? FEW_SUBSTEPS | MANY_SUBSTEPS : 0;
  all.wishes_left = 0;
  all.rounds = BATCH_ROUNDS * COLOR_LIMIT; /* the most rounds after which a batcher launches another kernel */
  all.known[COUNT_PAIRS] = all.known[COUNT_CONSTRAINTS] = most_pairs; /* many pairs, which touch */
  all.known[COUNT_ARTICULATIONS] = static_cast<uint32_t>(scene.articulations.size());
  Recorder recorder;
  all.drowsy = all.sleepers = all.other_sleepers = settings.sleeping;
  launch_step(recorder, all, settings_in_use);
  if (all.islands_apart) /* what other steps launch in the place of that */
    for (const Kernel kernel : {Kernel::color_keys, Kernel::color_starts}) recorder.note(kernel);
  recorder.end_step();
  if (all.islands_apart) recorder.note(Kernel::keep_wishes); /* other steps leave what that writes as it is */
  note_shapes(recorder);
  if (settings.sleeping) note_sleep(recorder);
  if (is_batch()) note_batch(recorder);
  for (const Extension &extension : settings.extensions) note_rows(recorder, *extension.module);
  buffers.take_needs(std::move(recorder));
}

/* Who looks at single launches may look at any buffer, and modules may read what they like. */
void World::Implementation::set_observer(World::Observer observer)
{
  buffers.set_sharing(!observer && settings.extensions.empty());
  launcher.set_observer(std::move(observer));
}

void World::Implementation::place(const Placement &placement)
{
  backends.place(placement, buffers.needs().kernels);
  buffers.changed();
  structure_state = 0; /* queries on another backend may traverse another structure */
}

void World::Implementation::place_as_asked(const Placement &placement)
{
  validate(placement);
  auto chooses_next = placement.automatic ? std::make_unique<AutomaticPlacement>(placement) : nullptr;
  if (chooses_next) chooses_next->look_for_device(backends, buffers.needs().kernels);
  place(AutomaticPlacement::first_of(placement));
  automatic = std::move(chooses_next);
}

/* Before a step changes anything. The step does not wait for kernels that have to be built for another placement, and
 * where a device fails to take them the CPU goes on. */
void World::Implementation::place_as_chosen()
{
  const std::vector<Kernel> &kernels = buffers.needs().kernels;
  try {
    automatic->look_for_device(backends, kernels);
    const std::optional<Placement> wanted = automatic->wanted();
    if (wanted && !backends.is_built(*wanted, kernels)) return;
    if (wanted) place(*wanted);
    automatic->was_placed();
  } catch (const std::runtime_error &error) {
    if (!automatic->has_device()) throw;
    automatic->device_fails(error.what());
    place_as_chosen();
  }
}

/* The step has succeeded, so that what fails here must not undo it. */
void World::Implementation::end_timed_step() noexcept
{
  try {
    automatic->end_step(backends, {plan, settings_in_use, memory, bodies(), special.awake});
  } catch (const std::exception &) {
    automatic->abandon_step(backends);
  }
}

void World::Implementation::place_again()
{
  backends.place_again(buffers.needs().kernels);
  buffers.changed();
  structure_state = 0;
}

/* Whether nothing is being built that the placement waits for. */
bool World::Implementation::is_built()
{
  const std::vector<Kernel> &kernels = buffers.needs().kernels;
  if (automatic && !automatic->has_looked_for_device(backends, kernels)) return false;
  return !backends.is_waiting() || backends.is_built(backends.wanted(), kernels);
}

bool World::Implementation::wait_until_placed(double seconds)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const auto waited = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  while (!is_built() && waited() < seconds) backends.tell_progress(backends.wanted());
  if (backends.is_waiting()) place_again();
  return !backends.is_waiting();
}

PlacementReport World::Implementation::placement_report() const
{
  PlacementReport report{backends.wanted().on, "as asked", true, {}, {}, {}};
  if (automatic) report = automatic->report();
  else if (backends.is_waiting())
    report = {"tbb", fmt::format("until the kernels of {} are built", report.on), false, {}, {}, {}};
  report.building = backends.building();
  return report;
}

void World::Implementation::upload_scene()
{
  StagedUploads uploads;
  stage_bodies(uploads, scene, special.order);
  stage_tables(uploads);
  stage_counts(uploads);
  uploads.write(memory);
  number_bodies();
}

/* Modules launch in each substep, and trees are solved as wholes; so worlds with either have one number of substeps. */
bool World::Implementation::may_part_islands() const noexcept
{
  return plan.substeps.automatic && scene.articulations.empty() && settings.extensions.empty();
}

/* Of the last step. */
uint32_t World::Implementation::bodies_with_more_substeps() const
{
  if (!plan.substeps.automatic || !whole || idle) return 0;
  if (plan.islands_apart) return plan.known[COUNT_MANY_BODIES];
  return plan.substeps.of_cache > fewest_substeps(settings) ? awake_dynamics : 0;
}

SubstepChoice World::Implementation::choice_of_others() const
{
  return plan.islands_apart ? choice_of_few(plan.substeps, settings) : plan.substeps;
}

Parameters World::Implementation::parameters_now() const { return parameters_with(choice_of_others(), EVERY_CLASS); }

Parameters World::Implementation::parameters_with(const SubstepChoice &choice, uint32_t substep_class) const
{
  Parameters parameters = parameters_of(scene, with_substeps(settings, choice), special.features, special.median);
  const float before = plan.substeps.of_cache, now = choice.now;
  parameters.substep_class = substep_class;
  parameters.joints = static_cast<uint32_t>(scene.joints.size());
  parameters.joint_axes = joint_graph.axes;
  parameters.joined_pairs_first = first_joined_pair(sizes());
  parameters.joined_pairs_mask = std::max(joined_pair_entries(scene, joint_graph, joint_order.awake()), 1u) - 1;
  parameters.few_share = 1;
  if (!plan.substeps.automatic) return parameters;
  const SubstepChoice few = choice_of_few(plan.substeps, settings);
  parameters.few_rate = std::bit_cast<float>(highest_load_rate(few, settings));
  const float fewest = few.now, most = plan.substeps.now;
  if (plan.islands_apart) parameters.few_share = fewest / most;
  parameters.warm_start_scale = before / now;
  parameters.spin_fall = 0.5f * parameters.gravity_length;
  return parameters;
}

void World::Implementation::stage_parameters(StagedUploads &uploads) const
{
  const Parameters told = parameters_now();
  uploads.add(Buffer::parameters, std::vector<Parameters>{told});
  if (!may_part_islands()) return;
  uploads.add(Buffer::told_parameters, std::vector<Parameters>{told});
  uploads.add(Buffer::few_parameters, std::vector<Parameters>{parameters_with(choice_of_others(), FEW_SUBSTEPS)});
  uploads.add(Buffer::many_parameters, std::vector<Parameters>{parameters_with(plan.substeps, MANY_SUBSTEPS)});
}

void World::Implementation::upload_parameters()
{
  StagedUploads uploads;
  stage_parameters(uploads);
  uploads.write(memory);
}

/* The tables of shapes, materials and parameters, which only calls of the user change. */
void World::Implementation::stage_tables(StagedUploads &uploads)
{
  stage_shapes(uploads, scene, special.order, plan.bodies, slots.status());
  stage_hulls(uploads, scene, hull_maps(settings));
  stage_trees(uploads, scene, trees, special.order, plan.bodies, slots.status());
  trees = {trees.sizes, {}, {}, {}, {}, {}, {}, {}, {}}; /* the buffers hold the rest */
  stage_materials(uploads, scene);
  stage_joint_tables(uploads, special.order);
  stage_parameters(uploads);
  uploaded_shapes = scene.shapes.size();
  uploaded_materials = scene.materials.size();
}

/* The counts that kernels never change. */
void World::Implementation::stage_counts(StagedUploads &uploads) const
{
  for (const auto &[entry, value] : scene_entries) uploads.add_count(static_cast<uint32_t>(entry), value);
  for (const auto &[entry, value] : joint_entries_of(joint_order.starts()))
    uploads.add_count(static_cast<uint32_t>(entry), value);
  for (const auto &[entry, value] : coupling_entries_of(coupling_graph.starts))
    uploads.add_count(static_cast<uint32_t>(entry), value);
  uploads.add_count(COUNT_ARTICULATIONS, static_cast<uint32_t>(scene.articulations.size()));
  uploads.add_count(CAPACITY_PAIRS, plan.capacity_pairs);
  uploads.add_count(CAPACITY_CELLS, plan.capacity_cells);
  uploads.add_count(CAPACITY_POINTS, points_of_pair(special.features));
  uploads.add_count(CAPACITY_CANDIDATES, plan.capacity_candidates);
}

/* A plan for links alone ends with the first other body that moves; none begins later. */
void World::Implementation::plan_for_body(uint32_t slot) noexcept
{
  if (scene.bodies[slot].type == BodyType::dynamic && !links.has_body(slot))
    plan.links_alone = plan.trees_apart = false;
}

void World::Implementation::number_bodies()
{
  index_of_body.resize(scene.bodies.size());
  for (uint32_t i = 0; i < special.order.size(); ++i) index_of_body[special.order[i]] = i;
}

/* Before the first step, and where buffers have grown, the host knows no counts. Launches are then sized as if the
 * buffers were full and each kind of pairs and each colour of contacts had an eighth of them; a range that seems empty
 * gets one work-group. */
void World::Implementation::guess_counts() noexcept
{
  auto &known = plan.known;
  known.fill(plan.capacity_pairs);
  known[COUNT_KEPT] = 0;
  for (const auto &[entry, value] : scene_entries) known[entry] = value;
  plan_joints();
  known[COUNT_ARTICULATIONS] = static_cast<uint32_t>(scene.articulations.size());
  known[COUNT_COMMIT_BODIES] = special.awake;
  known[COUNT_COMMIT_BODIES_PLUS_ONE] = special.awake + 1;
  known[COUNT_CELLS_PLUS_ONE] = plan.capacity_cells + 1;
  const auto halves_of = [&](uint32_t parts, uint32_t n) {
    return static_cast<uint32_t>(uint64_t{plan.capacity_pairs} * n / (2 * parts));
  };
  for (uint32_t kind = 0; kind <= PAIR_KIND_NONE; ++kind) known[KIND_START + kind] = halves_of(8, 2 * kind);
  for (uint32_t color = 0; color <= COLOR_LIMIT; ++color) known[COLOR_START + color] = halves_of(16, 2 * color);
  for (uint32_t color = 0; color < COLOR_LIMIT; ++color)
    known[LINK_COLOR_START + color] = known[WORLD_COLOR_START + color] = halves_of(16, 2 * color + 1);
  for (uint32_t color = 0; color <= COLOR_LIMIT; ++color) /* of bodies, which as many colours hold as avbd launches */
    known[BODY_COLOR_START + color] =
        static_cast<uint32_t>(uint64_t{special.awake} * std::min(color, first_body_colors - 1) / 8);
}

/* A module that reads or writes solver_force in any of its kernels takes part in the forces of a substep. */
bool World::Implementation::module_applies_forces() const
{
  const auto names_force = [](const Argument &argument) {
    return argument.kind == Argument::Kind::buffer && argument.buffer == Buffer::solver_force;
  };
  for (const Extension &extension : settings.extensions)
    for (size_t i = 0; i < extension.module->kernels(); ++i) {
      const auto &arguments = extension.module->kernel_row(i).arguments;
      if (std::any_of(arguments.begin(), arguments.end(), names_force)) return true;
    }
  return false;
}

/* The structure is made, and the filters are compared, once for all queries between two changes of the state. Queries
 * find sleeping bodies too, so kernels see all bodies until the next step begins. */
QueryTarget World::Implementation::query_target()
{
  const uint32_t structure = query_structure();
  plan.hits = 0; /* the queries that follow write over those of a cast on the device */
  settle();
  if (counted_bodies != bodies()) count_bodies(bodies());
  const bool may_be_told = memory.bytes(Buffer::query_body) == queried_bodies.size() * sizeof(uint32_t);
  if (structure_state != state || !may_be_told) tell_queried_bodies(memory, scene, special.order, queried_bodies);
  if (structure_state != state) {
    Recorder recorder;
    StepLaunches recorded(recorder, plan, settings_in_use), launches(launcher, plan, settings_in_use);
    launch_query_structure(recorded, structure);
    for (size_t i = 0; i < buffers.needs().touched.size(); ++i)
      if (recorder.touched[i] && !buffers.is_queried(buffer_at(i))) buffers.ensure_capacity(buffer_at(i), sizes());
    begin_launches();
    launch_query_structure(launches, structure);
    launches_ended = true;
    if (!sleepers.empty()) forget_kept(memory); /* it belongs to other bodies than those of a step */
    structure_state = state;
  }
  return {memory, launcher, structure};
}

/* Before a kernel of a module runs, all buffers are allocated that a step needs, which empties those of queries. So
 * that comes before the hits are found. */
QueryTarget World::Implementation::target_for_kernels()
{
  settle();
  buffers.make_ready(sizes());
  return query_target();
}

} // namespace tandem
