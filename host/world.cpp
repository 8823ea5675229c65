/* world.cpp - keeps a scene's buffers, runs steps until they are whole; see world.h. */
#include "host/world.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "host/batch_fault.h"
#include "host/body_buffers.h"
#include "host/broadphases/broadphase.h"
#include "host/broadphases/choice.h"
#include "host/contact_events.h"
#include "host/debug.h"
#include "host/hash.h"
#include "host/host_stages.h"
#include "host/layout.h"
#include "host/parameters.h"
#include "host/recorder.h"
#include "host/scene_counts.h"
#include "host/specialise.h"
#include "host/step.h"
#include "minicl/floating_point.h"
#include "shared/batching/limits.h"
#include "shared/platform.h"

namespace tandem {
namespace {

/* Each repetition fixes one cause; many in one step means that something is wrong. */
constexpr int most_repetitions = 64;

Settings resolved(Settings settings, const Scene &scene, const Placement &placement)
{
  if (settings.broadphase == "auto") settings.broadphase = choose_broadphase(scene, placement.on).name;
  return settings;
}

} // namespace

struct World::Implementation {
  Implementation(const Scene &given, const Settings &chosen, const Placement &placement)
      : scene(given), settings(resolved(chosen, given, placement)), wanted(placement), special(specialise(given, chosen)), hulls(hull_sizes(given, cube_map_cells(chosen))), trees(tree_tables(given)),
        launcher(memory, [this](Kernel kernel) -> Backend & { return backend_of(kernel); })
  {
    scene_features = special.features;
    if (!settings.specialise) special.features = all_features();
    plan.features = special.features;
    plan.bodies = static_cast<uint32_t>(scene.bodies.size());
    plan.capacity_cells = cells_for(plan.bodies);
    plan.capacity_pairs = 5 * plan.bodies + 1024;
    record_kernels();
    place(wanted);
    allocate();
    upload_scene();
    guess_counts();
  }

  ~Implementation()
  {
    for (auto &[text, backend] : backends) backend->finish();
  }

  Sizes sizes() const
  {
    return {.bodies = plan.bodies,
            .materials = static_cast<uint32_t>(scene.materials.size()),
            .hulls = hulls,
            .trees = trees.sizes,
            .pairs = plan.capacity_pairs,
            .cells = plan.capacity_cells,
            .features = special.features};
  }

  /* Kernels and buffers of the tail only once there is one. */
  void record_kernels()
  {
    StepPlan all = plan;
    all.colors = std::max(plan.colors, COLOR_LIMIT);
    all.rounds = BATCH_ROUNDS * COLOR_LIMIT; /* the most after which a batcher launches another kernel */
    Recorder recorder;
    launch_step(recorder, all, settings);
    kernels = recorder.kernels;
    touched = recorder.touched;
  }

  /* Backends once made are kept: a buffer may live on one that runs no kernel any more. */
  Backend &backend_named(const std::string &text, bool allow_inexact)
  {
    if (const auto known = backends.find(text); known != backends.end()) return *known->second;
    std::unique_ptr<Backend> made = make_backend(text, allow_inexact);
    made->set_profiling(profiling);
    return *backends.emplace(text, std::move(made)).first->second;
  }

  static std::string backend_text(const Placement &placement, Kernel kernel)
  {
    std::string text = placement.on;
    for (const auto &[what, where] : placement.exceptions)
      if (what == name_of(row_of(kernel).stage) || what == row_of(kernel).name) text = where;
    return text;
  }

  /* Stages of the host run there whatever is said of them; a name that means nothing is refused all the same. */
  Backend &backend_for(const Placement &placement, Kernel kernel)
  {
    Backend &named = backend_named(backend_text(placement, kernel), placement.allow_inexact);
    if (row_of(kernel).form != Form::host) return named;
    std::unique_ptr<Backend> &host = backends[host_stages_name];
    if (!host) {
      host = make_host_stages();
      host->set_profiling(profiling);
    }
    return *host;
  }

  /* All that can fail comes before the first change of what is placed. */
  void place(const Placement &placement)
  {
    std::map<Backend *, std::vector<Kernel>> own;
    for (Kernel kernel : kernels) own[&backend_for(placement, kernel)].push_back(kernel);
    for (const auto &[backend, theirs] : own) backend->prepare(special.features, theirs);
    placed.fill(nullptr);
    for (const auto &[backend, theirs] : own)
      for (Kernel kernel : theirs) placed[index_of(kernel)] = backend;
    wanted = placement;
  }

  /* Of the buffers that grow, the cache alone carries anything over to the next step. */
  void allocate()
  {
    const Sizes now = sizes();
    for (size_t i = 0; i < buffer_count; ++i) {
      const bool cached = i >= index_of(Buffer::cached_start) && i <= index_of(Buffer::cached_rolling_impulse);
      memory.resize(buffer_at(i), touched[i] || queried[i] ? bytes_of(buffer_at(i), now) : 0, cached);
    }
  }

  void upload_scene()
  {
    upload_bodies(memory, scene, special.order);
    upload_shapes(memory, scene, special.order);
    upload_hulls(memory, scene, cube_map_cells(settings));
    upload_trees(memory, scene, trees, special.order);
    trees = {trees.sizes, {}, {}, {}, {}, {}, {}, {}, {}}; /* the buffers hold the rest */
    upload_materials(memory, scene);
    upload_parameters();
    std::vector<uint32_t> counts(COUNT_TOTAL);
    for (const auto &[entry, value] : scene_counts()) counts[entry] = value;
    counts[CAPACITY_PAIRS] = plan.capacity_pairs;
    counts[CAPACITY_CELLS] = plan.capacity_cells;
    memory.upload(Buffer::counts, counts.data(), counts.size() * sizeof(uint32_t));
    index_of_body.resize(plan.bodies);
    for (uint32_t i = 0; i < plan.bodies; ++i) index_of_body[special.order[i]] = i;
  }

  std::vector<std::pair<int, uint32_t>> scene_counts() const { return entries_of({plan.bodies, special.boundless, special.large}); }

  void upload_parameters()
  {
    const Parameters parameters = parameters_of(scene, settings, special.features);
    memory.upload(Buffer::parameters, &parameters, sizeof parameters);
  }

  /* Before the first step the host knows no counts: launches are sized as if the buffers were full. */
  void guess_counts()
  {
    auto &known = plan.known;
    known.fill(plan.capacity_pairs);
    for (const auto &[entry, value] : scene_counts()) known[entry] = value;
    known[COUNT_COMMIT_BODIES] = plan.bodies;
    known[COUNT_COMMIT_BODIES_PLUS_ONE] = plan.bodies + 1;
    known[COUNT_CELLS_PLUS_ONE] = plan.capacity_cells + 1;
    for (uint32_t color = 0; color <= COLOR_LIMIT; ++color) known[COLOR_START + color] = static_cast<uint32_t>(uint64_t{plan.capacity_pairs} * color / 8);
  }

  void step()
  {
    launcher.set_step(statistics.steps);
    ++state;
    for (int repetition = 0; repetition < most_repetitions; ++repetition) {
      begin_launches();
      launch_step(launcher, plan, settings);
      memory.download(Buffer::counts, plan.known.data(), sizeof plan.known);
      launches_ended = true;
      if (plan.known[COUNT_STATUS] == 0) return accept();
      prepare_repetition(plan.known[COUNT_STATUS]);
    }
    throw std::runtime_error(fmt::format("step {} did not complete in {} repetitions (status {})", statistics.steps, most_repetitions,
                                         plan.known[COUNT_STATUS]));
  }

  /* Where launches broke off, by an exception that the caller survived, what is kept may be of no launch. */
  void begin_launches()
  {
    if (!launches_ended) forget_kept(memory);
    launches_ended = false;
  }

  /* Some rounds and a colour of slack keep a growing scene from repeating every step. */
  void accept()
  {
    if (settings.check && !fault) fault = find_batch_fault(memory, plan.known, special.order, statistics.steps);
    ++statistics.steps;
    plan.rounds = std::clamp<uint32_t>(plan.known[COUNT_ROUNDS] + 3, 4, most_rounds);
    plan.colors = std::min(plan.known[COUNT_COLORS] + 1, COLOR_LIMIT);
    if (plan.known[COUNT_COLORS] > COLOR_LIMIT) plan.colors = COLOR_LIMIT + 1;
  }

  void prepare_repetition(uint32_t status)
  {
    if (status & STATUS_ROUNDS) plan.rounds = std::min(2 * plan.rounds, most_rounds);
    if (status & STATUS_COLORS) plan.colors = plan.known[COUNT_COLORS];
    if (plan.colors > COLOR_LIMIT && !(status & STATUS_PAIRS)) make_room_for_tail();
    if (status & STATUS_NONFINITE) quarantine(plan.known[COUNT_NONFINITE]);
    plan.known[COUNT_COMMIT_BODIES] = plan.bodies;
    plan.known[COUNT_COMMIT_BODIES_PLUS_ONE] = plan.bodies + 1;
    plan.known[COUNT_COMMIT_PAIRS] = plan.known[COUNT_PAIRS];
    plan.known[COUNT_COMMIT_CONSTRAINTS] = plan.known[COUNT_CONSTRAINTS];
    if (status & STATUS_PAIRS) grow_pairs(plan.known[COUNT_PAIRS_NEEDED]); /* last: it forgets what is known */
  }

  void grow_pairs(uint32_t needed)
  {
    ++statistics.overflow;
    const uint32_t before = plan.capacity_pairs;
    plan.capacity_pairs = needed + needed / 4;
    record_kernels(); /* longer scans and sorts take other kernels */
    forget_kept(memory);
    try {
      allocate();
    } catch (const std::bad_alloc &) {
      plan.capacity_pairs = before;
      record_kernels();
      allocate();
      throw std::runtime_error(fmt::format("out of memory: {} contact pairs need more than there is; the state is that before the step", needed));
    }
    memory.upload(Buffer::counts, &plan.capacity_pairs, sizeof(uint32_t), CAPACITY_PAIRS * sizeof(uint32_t));
    place(wanted);
    guess_counts();
  }

  void make_room_for_tail()
  {
    record_kernels();
    try {
      allocate();
    } catch (const std::bad_alloc &) {
      plan.colors = COLOR_LIMIT;
      record_kernels();
      allocate();
      throw std::runtime_error("out of memory: contacts past the last colour need more than there is; the state is that before the step");
    }
    place(wanted);
  }

  void quarantine(uint32_t code)
  {
    static const char *const stages[] = {"start", "solve", "integrate"};
    const uint32_t index = code & 0x0fffffffu, body = special.order[index];
    quarantined.push_back({body, scene.bodies[body].name, stages[code >> 28], statistics.steps});
    ++statistics.nonfinite;
    quarantine_body(memory, index);
    forget_kept(memory);
  }

  /* Kernels of queries are built when they are first asked for, then kept. */
  Backend &backend_of(Kernel kernel)
  {
    Backend *&backend = placed[index_of(kernel)];
    if (!backend) {
      Backend &chosen = backend_for(wanted, kernel);
      chosen.prepare(special.features, {kernel}); /* may fail, and then none is chosen */
      backend = &chosen;
    }
    return *backend;
  }

  /* Of the state as it is: once for all queries between two changes of it. */
  QueryTarget query_target()
  {
    const uint32_t structure = broadphase_named(settings.broadphase).queries;
    if (structure_state != state) {
      Recorder recorder;
      StepLaunches recorded(recorder, plan, settings), launches(launcher, plan, settings);
      launch_query_structure(recorded, structure);
      for (size_t i = 0; i < buffer_count; ++i)
        if (recorder.touched[i] && !queried[i]) make_room(buffer_at(i));
      begin_launches();
      launch_query_structure(launches, structure);
      launches_ended = true;
      structure_state = state;
    }
    return {memory, launcher, scene, special.order, structure};
  }
  void make_room(Buffer buffer)
  {
    queried[index_of(buffer)] = true;
    if (!touched[index_of(buffer)]) memory.resize(buffer, bytes_of(buffer, sizes()));
  }

  static constexpr uint32_t most_rounds = 1 << 20;

  Scene scene;
  Settings settings;
  Placement wanted;
  Specialisation special;
  HullSizes hulls;
  TreeTables trees;
  uint32_t scene_features = 0; /* what the scene needs, also where all is run */
  std::map<std::string, std::unique_ptr<Backend>> backends; /* outlive the memory, which lives in their storage */
  Memory memory;
  PlacedLauncher launcher;
  StepPlan plan;
  std::vector<Kernel> kernels;
  std::array<bool, buffer_count> touched{}; /* by some kernel of the step; the others take no memory */
  std::array<bool, buffer_count> queried{}; /* by the structure that queries walk */
  uint64_t state = 1, structure_state = 0;  /* the state that is, and the one that this structure is of */
  bool launches_ended = true;
  std::array<Backend *, kernel_count> placed{};
  bool profiling = false; /* of backends made later too */
  std::vector<uint32_t> index_of_body;
  std::vector<Quarantine> quarantined;
  std::optional<BatchFault> fault;
  Statistics statistics;
};

World::World(const Scene &scene, const Settings &settings, const Placement &placement)
{
  validate(scene, scene.name);
  validate(settings);
  const minicl::ExactFloatingPoint environment; /* what is derived from the scene rounds alike too */
  implementation_ = std::make_unique<Implementation>(scene, settings, placement);
}

World::~World() = default;

void World::step() { implementation_->step(); }
void World::place(const Placement &placement) { implementation_->place(placement); }
const Scene &World::scene() const { return implementation_->scene; }
const Settings &World::settings() const { return implementation_->settings; }
const std::vector<Quarantine> &World::quarantined() const { return implementation_->quarantined; }
const std::optional<BatchFault> &World::batch_fault() const { return implementation_->fault; }
uint32_t World::features() const { return implementation_->special.features; }
std::vector<Kernel> World::kernels() const { return implementation_->kernels; }
Memory &World::memory() { return implementation_->memory; }
Backend &World::backend_of(Kernel kernel) { return implementation_->backend_of(kernel); }
uint32_t World::scene_body(uint32_t buffer_index) const { return implementation_->special.order.at(buffer_index); }
void World::set_observer(Observer observer) { implementation_->launcher.set_observer(std::move(observer)); }

std::vector<BodyState> World::bodies() { return download_bodies(implementation_->memory, implementation_->special.order); }

std::vector<PreciseBodyState> World::precise_bodies()
{
  return download_precise_bodies(implementation_->memory, implementation_->special.order);
}

void World::set_body(uint32_t body, const BodyState &state)
{
  if (body >= implementation_->plan.bodies)
    throw InputError(fmt::format("set_body: body {} does not exist; the scene has {}", body, implementation_->plan.bodies));
  if (!is_finite(state)) throw InputError(fmt::format("set_body: body {} would not be finite", body));
  set_body_unchecked(body, state);
}

void World::set_body_unchecked(uint32_t body, const BodyState &state)
{
  const minicl::ExactFloatingPoint environment;
  ++implementation_->state;
  upload_body(implementation_->memory, implementation_->index_of_body.at(body), state);
}

std::vector<ContactEvent> World::contact_events()
{
  if (!implementation_->settings.events) throw InputError("contact_events: there are none without Settings::events");
  return download_events(implementation_->memory, implementation_->scene, implementation_->special.order);
}

std::vector<PairEvent> World::pair_events()
{
  if (!implementation_->settings.pair_events) throw InputError("pair_events: there are none without Settings::pair_events");
  return download_pair_events(implementation_->memory, implementation_->special.order);
}

std::vector<RayHit> World::cast_rays(std::span<const Ray> rays)
{
  check_rays(rays);
  const minicl::ExactFloatingPoint environment;
  return tandem::cast_rays(implementation_->query_target(), rays);
}

std::vector<bool> World::find_blocked_rays(std::span<const Ray> rays)
{
  check_rays(rays);
  const minicl::ExactFloatingPoint environment;
  return tandem::find_blocked_rays(implementation_->query_target(), rays);
}

std::vector<std::vector<RayHit>> World::cast_rays_through(std::span<const Ray> rays)
{
  check_rays(rays);
  const minicl::ExactFloatingPoint environment;
  return tandem::cast_rays_through(implementation_->query_target(), rays);
}

std::vector<std::vector<BoxHit>> World::sweep_boxes(std::span<const QueryBox> boxes)
{
  check_boxes(boxes);
  const minicl::ExactFloatingPoint environment;
  return tandem::sweep_boxes(implementation_->query_target(), boxes);
}

std::vector<SweepHit> World::sweep(const Shape &shape, std::span<const Pose> poses, std::span<const Vec3> displacements, const QueryFilter &filter)
{
  check_sweep(shape, poses, displacements);
  const minicl::ExactFloatingPoint environment;
  return tandem::sweep(implementation_->query_target(), shape, poses, displacements, filter);
}

Statistics World::statistics()
{
  Statistics s = implementation_->statistics;
  measure_contacts(implementation_->memory, s);
  s.kinetic_energy = kinetic_energy(implementation_->memory, implementation_->scene, implementation_->special.order);
  return s;
}

uint64_t World::body_hash()
{
  return hash_buffers(implementation_->memory, {Buffer::body_position, Buffer::body_orientation, Buffer::body_velocity}, implementation_->plan.bodies);
}

uint64_t World::state_hash()
{
  Memory &memory = implementation_->memory;
  const std::vector<uint32_t> starts = memory.read<uint32_t>(Buffer::cached_start, implementation_->plan.bodies + 1);
  uint64_t hash = hash_bytes(starts.data(), starts.size() * sizeof(uint32_t), body_hash());
  hash = hash_buffers(memory, {Buffer::cached_b, Buffer::cached_feature, Buffer::cached_color, Buffer::cached_normal_impulse, Buffer::cached_friction_impulse},
                      starts.back(), hash);
  const bool rolls = implementation_->scene_features & FEATURE_ROLLING;
  if (rolls) hash = hash_buffers(memory, {Buffer::cached_rolling_impulse}, starts.back(), hash);
  return implementation_->settings.events ? hash_buffers(memory, {Buffer::cached_touching}, starts.back(), hash) : hash;
}

void World::finish()
{
  for (auto &[text, backend] : implementation_->backends) backend->finish();
}

void World::set_profiling(bool on)
{
  implementation_->profiling = on;
  for (auto &[text, backend] : implementation_->backends) {
    backend->set_profiling(on);
    backend->take_kernel_times();
  }
}

std::vector<KernelTime> World::take_kernel_times()
{
  std::vector<KernelTime> times;
  for (auto &[text, backend] : implementation_->backends) {
    const std::vector<Backend::Time> spent = backend->take_kernel_times();
    for (size_t k = 0; k < kernel_count; ++k)
      if (spent[k].launches > 0) times.push_back({kernel_at(k), backend->name(), spent[k].nanoseconds * 1e-6, spent[k].launches});
  }
  return times;
}

double World::build_milliseconds() const
{
  double total = 0;
  for (const auto &[text, backend] : implementation_->backends) total += backend->build_milliseconds;
  return total;
}

} // namespace tandem
