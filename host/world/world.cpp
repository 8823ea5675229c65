/* world.cpp - keeps a scene's buffers, runs steps until they are whole; see world.h. */
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <tandem/world.h>

#include "host/base/hash.h"
#include "host/base/out_of_memory.h"
#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/broadphases/choice.h"
#include "host/pipeline/host_stages.h"
#include "host/pipeline/layout.h"
#include "host/pipeline/scene_counts.h"
#include "host/pipeline/setting_rows.h"
#include "host/pipeline/step.h"
#include "host/runtime/interface/debug.h"
#include "host/runtime/interface/floating_point.h"
#include "host/runtime/launcher.h"
#include "host/runtime/make_backend.h"
#include "host/runtime/recorder.h"
#include "host/scene/body_buffers.h"
#include "host/scene/parameters.h"
#include "host/scene/specialise.h"
#include "host/world/batch_fault.h"
#include "host/world/carried.h"
#include "host/world/contact_events.h"
#include "host/world/queries.h"
#include "shared/batching/limits.h"
#include "shared/broadphase/near_limits.h"
#include "shared/platform.h"

namespace tandem {
namespace {

/* Each repetition fixes one cause; many in one step means that something is wrong. */
constexpr size_t most_repetitions = 64;

/* So many bodies of a step that stop being finite are taken out by a repetition each, so that what one of them would
 * have infected in another pass stays; where there are more, all that are not finite by then. */
constexpr size_t taken_one_by_one = 32;

/* A body's number shares a word with the stage that it failed in (COUNT_NONFINITE). */
constexpr uint32_t body_numbers = 1u << 28;

void check_numbers(const Scene &scene)
{
  if (scene.bodies.size() >= body_numbers)
    throw InputError(
        fmt::format("scene '{}': {} bodies; kernels can number {}", scene.name, scene.bodies.size(), body_numbers - 1));
}

/* The pairs that there is room for at first; a step that finds more runs again. */
uint32_t first_room(const Scene &scene, const Settings &settings)
{
  return static_cast<uint32_t>(std::min<uint64_t>(5 * uint64_t{scene.bodies.size()} + 1024, settings.max_pairs));
}

Settings resolved(Settings settings, const Scene &scene, const Placement &placement)
{
  if (settings.broadphase == Broadphase::automatic)
    settings.broadphase = choose_broadphase(scene, placement.on).broadphase;
  return settings;
}

} // namespace

struct World::Implementation {
  Implementation(const Scene &given, const Settings &chosen, const Placement &placement)
      : scene(given), settings(resolved(chosen, given, placement)), wanted(placement),
        special(specialise(given, chosen)), hulls(hull_sizes(given, cube_map_cells(chosen))), trees(tree_tables(given)),
        launcher(memory, [this](Kernel kernel) -> Backend & { return backend_of(kernel); })
  {
    launcher.set_on_commit([this] { turn(); });
    scene_features = special.features;
    if (!settings.specialise) special.features = all_features();
    plan.features = special.features;
    plan.bodies = static_cast<uint32_t>(scene.bodies.size());
    scene_entries = entries_of({plan.bodies, special.boundless, special.large});
    plan.capacity_cells = cells_for(plan.bodies);
    plan.capacity_pairs = first_room(scene, settings);
    record_kernels();
    place(wanted);
    allocate();
    upload_scene();
    guess_counts();
  }

  ~Implementation()
  {
    for (auto &[text, backend] : backends) finish_at_last(*backend);
  }

  /* What failed was told when it did; a destructor has no one to tell. */
  static void finish_at_last(Backend &backend) noexcept
  {
    try {
      backend.finish();
    } catch (const std::exception &) {}
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
    for (const CarriedBuffer &carried : carried_buffers()) {
      bool &now = recorder.touched[index_of(carried.now)], &previous = recorder.touched[index_of(carried.previous)];
      now = previous = now || previous;
    }
    kernels = std::move(recorder.kernels);
    touched = recorder.touched;
    uses = std::move(recorder.uses);
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
    if (const auto known = backends.find(host_stages_name); known != backends.end()) return *known->second;
    std::unique_ptr<Backend> host = make_host_stages();
    host->set_profiling(profiling);
    return *backends.emplace(host_stages_name, std::move(host)).first->second;
  }

  /* All that can fail comes before the first change of what is placed. */
  void place(const Placement &placement)
  {
    Placement changed = placement;
    std::map<Backend *, std::vector<Kernel>> own;
    for (Kernel kernel : kernels) own[&backend_for(placement, kernel)].push_back(kernel);
    for (const auto &[backend, theirs] : own) backend->prepare(special.features, theirs);
    placed.fill(nullptr);
    for (const auto &[backend, theirs] : own)
      for (Kernel kernel : theirs) placed[index_of(kernel)] = backend;
    wanted = std::move(changed);
    ready = false;
  }

  /* Of the buffers that grow, those alone carry anything over to the next step that never lose it: they come last, when
   * the others have let go of their room. */
  void allocate()
  {
    const Sizes now = sizes();
    const auto wished = [&](Buffer buffer) {
      return touched[index_of(buffer)] || queried[index_of(buffer)] ? bytes_of(buffer, now) : 0;
    };
    for (size_t i = 0; i < buffer_count; ++i)
      if (touched[i] || queried[i]) check_size(buffer_at(i), now);
    for (size_t i = 0; i < buffer_count; ++i)
      if (!is_carried(row_of(buffer_at(i)).lifetime)) memory.resize(buffer_at(i), wished(buffer_at(i)));
    for (const CarriedBuffer &carried : carried_buffers()) memory.resize(carried.previous, wished(carried.previous));
    for (const CarriedBuffer &carried : carried_buffers()) memory.grow(carried.now, wished(carried.now));
  }

  /* Every buffer where its kernels run, before the first of them does: a step that has begun does not run out of
   * memory. */
  void make_ready()
  {
    if (ready) return;
    allocate();
    for (const auto &[kernel, buffer] : uses) memory.reserve(buffer, backend_of(kernel).storage());
    for (const CarriedBuffer &carried : carried_buffers())
      for (const auto &[text, backend] : backends)
        if (memory.holds(carried.now, backend->storage())) memory.reserve(carried.previous, backend->storage());
    for (const auto &[text, backend] : backends) settle(*backend);
    ready = true;
  }

  /* Drivers may put allocation off until the work that fills the buffers is done. */
  void settle(Backend &backend)
  {
    try {
      backend.finish();
    } catch (const std::runtime_error &error) {
      throw OutOfMemory(
          fmt::format("out of memory: {} bytes of buffers do not fit: {}", memory.total_bytes(), error.what()));
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
    for (const auto &[entry, value] : scene_entries) counts[entry] = value;
    counts[CAPACITY_PAIRS] = plan.capacity_pairs;
    counts[CAPACITY_CELLS] = plan.capacity_cells;
    memory.upload(Buffer::counts, counts.data(), counts.size() * sizeof(uint32_t));
    index_of_body.resize(plan.bodies);
    for (uint32_t i = 0; i < plan.bodies; ++i) index_of_body[special.order[i]] = i;
  }

  void upload_parameters()
  {
    const Parameters parameters = parameters_of(scene, settings, special.features);
    memory.upload(Buffer::parameters, &parameters, sizeof parameters);
  }

  /* Before the first step the host knows no counts: launches are sized as if the buffers were full. */
  void guess_counts() noexcept
  {
    auto &known = plan.known;
    known.fill(plan.capacity_pairs);
    known[COUNT_KEPT] = 0;
    for (const auto &[entry, value] : scene_entries) known[entry] = value;
    known[COUNT_COMMIT_BODIES] = plan.bodies;
    known[COUNT_COMMIT_BODIES_PLUS_ONE] = plan.bodies + 1;
    known[COUNT_CELLS_PLUS_ONE] = plan.capacity_cells + 1;
    for (uint32_t color = 0; color <= COLOR_LIMIT; ++color)
      known[COLOR_START + color] = static_cast<uint32_t>(uint64_t{plan.capacity_pairs} * color / 8);
  }

  void step()
  {
    launcher.set_step(statistics.steps);
    ++state;
    const Attempt before{plan, statistics, quarantined.size()};
    try {
      restore_bodies(); /* where the last attempt could not */
      make_ready();
      run_until_whole();
    } catch (...) {
      undo(before);
      tell_why_step_failed();
    }
    whole = true;
  }

  void run_until_whole()
  {
    bool may_forget = launches_ended && plan.known[COUNT_KEPT] != 0;
    for (size_t repetition = 0; repetition < most_repetitions + taken_one_by_one; ++repetition) {
      begin_launches();
      launch_step(launcher, plan, settings);
      memory.download(Buffer::counts, plan.known.data(), sizeof plan.known);
      launches_ended = true;
      if (plan.known[COUNT_STATUS] == 0) return accept();
      turn_back();
      prepare_repetition(plan.known[COUNT_STATUS], may_forget);
    }
    throw std::runtime_error(
        fmt::format("it did not complete in {} repetitions, in which {} bodies did not stay finite (status {})",
                    most_repetitions + taken_one_by_one, taken_out.size(), plan.known[COUNT_STATUS]));
  }

  /* --- a step happens whole or not at all: host/world/carried.h ---------------------------------------------- */

  struct Attempt {
    StepPlan plan;
    Statistics statistics;
    size_t quarantined;
  };

  void turn() noexcept
  {
    turn_carried(memory);
    turned = true;
  }
  void turn_back() noexcept
  {
    if (turned) turn_carried(memory);
    turned = false;
  }

  void undo(const Attempt &before) noexcept
  {
    turn_back();
    launches_ended = whole = false;
    statistics = before.statistics;
    quarantined.erase(quarantined.begin() + static_cast<ptrdiff_t>(before.quarantined), quarantined.end());
    const uint32_t capacity = plan.capacity_pairs;
    plan = before.plan;
    plan.capacity_pairs = capacity;
    if (capacity != before.plan.capacity_pairs) guess_counts();
    try {
      restore_bodies();
    } catch (const std::exception &) { /* the next step does, before all else */
    }
  }

  /* Bodies that were taken out by an attempt that failed later on. */
  void restore_bodies()
  {
    for (; !taken_out.empty(); taken_out.pop_back())
      write_body(memory, taken_out.back().first, taken_out.back().second);
  }

  /* Out of the handler of what went wrong. */
  [[noreturn]] void tell_why_step_failed() const
  {
    const auto told = [&](const char *why) {
      return fmt::format("step {}: {}; of {} bodies, with room for {} pairs, in {} bytes of buffers; the state is that "
                         "before the step",
                         statistics.steps, why, plan.bodies, plan.capacity_pairs, memory.total_bytes());
    };
    try {
      throw;
    } catch (const OutOfMemory &error) {
      throw OutOfMemory(told(error.what()));
    } catch (const std::bad_alloc &) {
      throw OutOfMemory(told("out of memory"));
    } catch (const std::runtime_error &error) {
      throw std::runtime_error(told(error.what()));
    }
  }

  /* Where launches broke off, by an exception that the caller survived, what is kept may be of no launch. */
  void begin_launches()
  {
    if (!launches_ended) forget_kept(memory);
    launches_ended = false;
  }

  /* Some rounds and a colour of slack keep a growing scene from repeating every step. Nothing fails once the state has
   * been accepted. */
  void accept()
  {
    if (settings.check && !fault) fault = find_batch_fault(memory, plan.known, special.order, statistics.steps);
    turned = false;
    taken_out.clear();
    ++statistics.steps;
    plan.rounds = std::clamp<uint32_t>(plan.known[COUNT_ROUNDS] + 3, 4, most_rounds);
    plan.colors = std::min(plan.known[COUNT_COLORS] + 1, COLOR_LIMIT);
    if (plan.known[COUNT_COLORS] > COLOR_LIMIT) plan.colors = COLOR_LIMIT + 1;
  }

  void prepare_repetition(uint32_t status, bool &may_forget)
  {
    const uint32_t needed = plan.known[COUNT_PAIRS_NEEDED];
    if (status & STATUS_ROUNDS) plan.rounds = std::min(2 * plan.rounds, most_rounds);
    if (status & STATUS_COLORS) plan.colors = plan.known[COUNT_COLORS];
    if (plan.colors > COLOR_LIMIT && !(status & STATUS_PAIRS)) enlarge(plan.capacity_pairs);
    if (status & STATUS_NONFINITE) quarantine_from(plan.known[COUNT_NONFINITE]);
    plan.known[COUNT_COMMIT_BODIES] = plan.bodies;
    plan.known[COUNT_COMMIT_BODIES_PLUS_ONE] = plan.bodies + 1;
    plan.known[COUNT_COMMIT_PAIRS] = plan.known[COUNT_PAIRS];
    plan.known[COUNT_COMMIT_CONSTRAINTS] = plan.known[COUNT_CONSTRAINTS];
    if (status & STATUS_PAIRS) grow_pairs(needed, may_forget); /* last: it forgets what is known */
  }

  /* The pairs among what did not fit are not known then. */
  bool near_list_overflows() const
  {
    return plan.known[COUNT_NEAR_NEEDED] > uint64_t{NEAR_PER_PAIR} * plan.capacity_pairs;
  }

  /* A broadphase that keeps its list may need room for more changes than there are pairs: without what is kept it needs
   * none. */
  void grow_pairs(uint32_t needed, bool &may_forget)
  {
    if (needed > settings.max_pairs && std::exchange(may_forget, false)) return forget_kept(memory);
    if (needed > settings.max_pairs)
      throw std::runtime_error(
          fmt::format("room for {}{} pairs is needed, and {} are the most (--max-pairs, Settings::max_pairs)",
                      needed == UINT32_MAX || near_list_overflows() ? "at least " : "", needed, settings.max_pairs));
    ++statistics.overflow;
    enlarge(static_cast<uint32_t>(std::min<uint64_t>(uint64_t{needed} + needed / 4, settings.max_pairs)));
    guess_counts();
  }

  /* Room for so many pairs, and for what the present plan launches; longer scans and sorts take other kernels. */
  void enlarge(uint32_t pairs)
  {
    const uint32_t capacity = plan.capacity_pairs;
    auto before = std::tuple(kernels, touched, uses);
    const auto give_up = [&] {
      plan.capacity_pairs = capacity;
      std::tie(kernels, touched, uses) = std::move(before);
      ready = false;
    };
    try {
      plan.capacity_pairs = pairs;
      record_kernels();
      place(wanted);
      forget_kept(memory);
      make_ready();
      memory.upload(Buffer::counts, &pairs, sizeof pairs, CAPACITY_PAIRS * sizeof pairs);
    } catch (const OutOfMemory &error) {
      give_up();
      throw OutOfMemory(
          fmt::format("room for {} pairs and {} colours is needed: {}", pairs, plan.colors, error.what()));
    } catch (...) {
      give_up();
      throw;
    }
  }

  /* code: COUNT_NONFINITE, the first body that is not finite, and where. */
  void quarantine_from(uint32_t code)
  {
    const uint32_t first = code & (body_numbers - 1), stage = code / body_numbers;
    quarantine(first, stage);
    if (taken_out.size() > taken_one_by_one)
      for (const uint32_t body : bodies_not_finite(memory, plan.bodies))
        if (body != first) quarantine(body, stage);
    forget_kept(memory);
  }

  void quarantine(uint32_t index, uint32_t stage)
  {
    static const char *const stages[] = {"start", "solve", "integrate"};
    const uint32_t body = special.order[index];
    quarantined.push_back({body, scene.bodies[body].name, stages[stage], statistics.steps});
    ++statistics.nonfinite;
    taken_out.emplace_back(index,
                           read_body(memory, index)); /* first: a body that stays as it is can be restored, too */
    quarantine_body(memory, index);
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
    const uint32_t structure = row_of(settings.broadphase).queries;
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
  uint32_t scene_features = 0;                              /* what the scene needs, also where all is run */
  std::map<std::string, std::unique_ptr<Backend>> backends; /* outlive the memory, which lives in their storage */
  Memory memory;
  PlacedLauncher launcher;
  StepPlan plan;
  std::vector<std::pair<int, uint32_t>> scene_entries; /* of counts */
  std::vector<Kernel> kernels;
  std::array<bool, buffer_count> touched{}; /* by some kernel of the step; the others take no memory */
  std::set<std::pair<Kernel, Buffer>> uses; /* the same, by which */
  bool ready = false;                       /* there is room for all of these, where they run */
  std::array<bool, buffer_count> queried{}; /* by the structure that queries walk */
  uint64_t state = 1, structure_state = 0;  /* the state that is, and the one that this structure is of */
  bool launches_ended = true;
  bool turned = false; /* the commit of an unfinished step has begun */
  bool whole = true;   /* the last step was; after one that failed there is nothing to say of it */
  std::vector<std::pair<uint32_t, BodyRecord>>
      taken_out; /* in an unfinished step, by their index in the buffers; as they were */
  std::array<Backend *, kernel_count> placed{};
  bool profiling = false; /* of backends made later too */
  std::vector<uint32_t> index_of_body;
  std::vector<Quarantine> quarantined;
  std::optional<BatchFault> fault;
  Statistics statistics;
};

World::World(const Scene &scene, const Settings &settings, const Placement &placement)
{
  const minicl::ExactFloatingPoint environment; /* what is derived from the scene rounds alike too */
  const auto told = [&](const char *why) {
    return fmt::format("scene '{}' of {} bodies, with room for {} pairs: {}", scene.name, scene.bodies.size(),
                       first_room(scene, settings), why);
  };
  try {
    validate(scene, scene.name);
    validate(settings);
    check_numbers(scene);
    implementation_ = std::make_unique<Implementation>(scene, settings, placement);
  } catch (const OutOfMemory &error) {
    throw OutOfMemory(told(error.what()));
  } catch (const std::bad_alloc &) {
    throw OutOfMemory(told("out of memory for its tables and buffers"));
  }
}

namespace {

/* What was asked of a world of so many bodies, where there was no room for the answer. */
template <class Work> auto answer(const char *what, size_t bodies, Work work)
{
  return naming_what_failed(
      [&] {
        return fmt::format("out of memory: {} of a world of {} bodies: its lists need more than there is", what,
                           bodies);
      },
      work);
}

} // namespace

World::~World() = default;

void World::step() { implementation_->step(); }
void World::place(const Placement &placement)
{
  answer("the placement", implementation_->plan.bodies, [&] { implementation_->place(placement); });
}
const Scene &World::scene() const { return implementation_->scene; }
const Settings &World::settings() const { return implementation_->settings; }
const std::vector<Quarantine> &World::quarantined() const { return implementation_->quarantined; }
const std::optional<BatchFault> &World::batch_fault() const { return implementation_->fault; }
Features World::features() const { return implementation_->special.features; }
std::vector<Kernel> World::kernels() const { return implementation_->kernels; }
Memory &World::memory() { return implementation_->memory; }
Backend &World::backend_of(Kernel kernel) { return implementation_->backend_of(kernel); }
uint32_t World::scene_body(uint32_t buffer_index) const { return implementation_->special.order.at(buffer_index); }
void World::set_observer(Observer observer) { implementation_->launcher.set_observer(std::move(observer)); }

std::vector<BodyState> World::bodies()
{
  return answer("the bodies", implementation_->plan.bodies,
                [&] { return download_bodies(implementation_->memory, implementation_->special.order); });
}

std::vector<PreciseBodyState> World::precise_bodies()
{
  return answer("the bodies", implementation_->plan.bodies,
                [&] { return download_precise_bodies(implementation_->memory, implementation_->special.order); });
}

void World::set_body(uint32_t body, const BodyState &state)
{
  if (body >= implementation_->plan.bodies)
    throw InputError(
        fmt::format("set_body: body {} does not exist; the scene has {}", body, implementation_->plan.bodies));
  if (!is_finite(state)) throw InputError(fmt::format("set_body: body {} would not be finite", body));
  set_body_unchecked(body, state);
}

void World::set_body_unchecked(uint32_t body, const BodyState &state)
{
  const minicl::ExactFloatingPoint environment;
  ++implementation_->state;
  answer("a body", implementation_->plan.bodies,
         [&] { upload_body(implementation_->memory, implementation_->index_of_body.at(body), state); });
}

std::vector<ContactEvent> World::contact_events()
{
  if (!implementation_->settings.events) throw InputError("contact_events: there are none without Settings::events");
  if (!implementation_->whole) return {};
  return answer("the contact events", implementation_->plan.bodies, [&] {
    return download_events(implementation_->memory, implementation_->scene, implementation_->special.order);
  });
}

std::vector<PairEvent> World::pair_events()
{
  if (!implementation_->settings.pair_events)
    throw InputError("pair_events: there are none without Settings::pair_events");
  if (!implementation_->whole) return {};
  return answer("the pair events", implementation_->plan.bodies,
                [&] { return download_pair_events(implementation_->memory, implementation_->special.order); });
}

std::vector<RayHit> World::cast_rays(std::span<const Ray> rays)
{
  check_rays(rays);
  const minicl::ExactFloatingPoint environment;
  return answer("queries", implementation_->plan.bodies,
                [&] { return tandem::cast_rays(implementation_->query_target(), rays); });
}

std::vector<bool> World::find_blocked_rays(std::span<const Ray> rays)
{
  check_rays(rays);
  const minicl::ExactFloatingPoint environment;
  return answer("queries", implementation_->plan.bodies,
                [&] { return tandem::find_blocked_rays(implementation_->query_target(), rays); });
}

std::vector<std::vector<RayHit>> World::cast_rays_through(std::span<const Ray> rays)
{
  check_rays(rays);
  const minicl::ExactFloatingPoint environment;
  return answer("queries", implementation_->plan.bodies,
                [&] { return tandem::cast_rays_through(implementation_->query_target(), rays); });
}

std::vector<std::vector<BoxHit>> World::sweep_boxes(std::span<const QueryBox> boxes)
{
  check_boxes(boxes);
  const minicl::ExactFloatingPoint environment;
  return answer("queries", implementation_->plan.bodies,
                [&] { return tandem::sweep_boxes(implementation_->query_target(), boxes); });
}

std::vector<SweepHit> World::sweep(const Shape &shape, std::span<const Pose> poses, std::span<const Vec3> displacements,
                                   const QueryFilter &filter)
{
  check_sweep(shape, poses, displacements);
  const minicl::ExactFloatingPoint environment;
  return answer("queries", implementation_->plan.bodies,
                [&] { return tandem::sweep(implementation_->query_target(), shape, poses, displacements, filter); });
}

Statistics World::statistics()
{
  return answer("the statistics", implementation_->plan.bodies, [&] {
    Statistics s = implementation_->statistics;
    if (implementation_->whole) measure_contacts(implementation_->memory, s);
    s.kinetic_energy = kinetic_energy(implementation_->memory, implementation_->scene, implementation_->special.order);
    return s;
  });
}

uint64_t World::body_hash()
{
  const std::vector<Buffer> state{Buffer::body_position, Buffer::body_orientation, Buffer::body_velocity};
  return answer("the hash", implementation_->plan.bodies,
                [&] { return hash_buffers(implementation_->memory, state, implementation_->plan.bodies); });
}

uint64_t World::state_hash()
{
  const Implementation &world = *implementation_;
  uint64_t hash = answer("the hash", world.plan.bodies, [&] {
    return hash_carried(implementation_->memory, world.plan.bodies, world.scene_features);
  });
  for (const Quarantine &taken : world.quarantined) hash = hash_bytes(&taken.body, sizeof taken.body, hash);
  return hash;
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
      if (spent[k].launches > 0)
        times.push_back({kernel_at(k), backend->name(), spent[k].nanoseconds * 1e-6, spent[k].launches});
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
