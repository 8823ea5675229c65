/* step.cpp - the whole step on one page: which kernels run, in which order.
 *
 *   bounds -> pairs -> pairs of leaves -> manifolds -> colours -> constraints -> solver -> commit
 *
 * Nothing here waits for a device: ranges are read from counts on the device, and the plan only says how large the
 * launches should be. Broadphases, batchers and solvers are in folders of their own.
 */
#include "host/pipeline/step.h"

#include <algorithm>
#include <utility>

#include "host/pipeline/batching/batcher.h"
#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/pair_lists.h"
#include "host/pipeline/primitives.h"
#include "host/pipeline/setting_rows.h"
#include "host/pipeline/sleeping.h"
#include "host/pipeline/solvers/solvers.h"
#include "host/pipeline/step_launches.h"
#include "host/runtime/interface/pair_tests.h"
#include "shared/batching/limits.h"
#include "shared/body_codes.h"
#include "shared/midphase/pair_groups.h"
#include "shared/setup/order_codes.h"

namespace tandem {
namespace {

/* So many layers of a stack are known after the first step of a world. The last pass writes the side of cached_standing
 * that the commit makes valid, so there is an odd number of them. */
constexpr uint32_t passes_of_first_step = 129;

class Step : public StepLaunches {
public:
  using StepLaunches::StepLaunches;

  void run_all()
  {
    run(Kernel::begin_step);
    if (plan().sleepers && plan().other_sleepers) list_sleepers(*this);
    run(Kernel::prepare_bodies);
    if (has(FEATURE_LOCKS)) run(Kernel::lock_bodies);
    if (has_links()) {
      run(Kernel::clear_warm_starts);
      run(Kernel::begin_articulations);
    }
    if (has(FEATURE_JOINTS)) take_joint_colors();
    run_extensions(StepPoint::begin);
    find_pairs();
    if (plan().substeps.automatic) clear_standing(Buffer::previous_cached_standing);
    if (plan().substeps.automatic) forget_wishes();
    if (plan().apart) expect_no_pairs();
    else find_constraints();
    if (plan().substeps.automatic && layers_at_start() != 0) {
      count_supports();
      weigh_standing();
    }
    if (has(FEATURE_JOINTS)) run(Kernel::prepare_joints);
    if (has(FEATURE_COUPLINGS)) run(Kernel::prepare_couplings);
    run_extensions(StepPoint::constraints);
    row_of(settings().solver).launch(*this);
    if (plan().substeps.automatic && has(FEATURE_JOINTS)) run(Kernel::weigh_joints, {plan().substeps.starts});
    if (plan().islands_apart) run(Kernel::keep_wishes, {steps_of_wish(plan().substeps, settings())});
    if (has(FEATURE_CONTINUOUS)) keep_out_of_walls();
    run_extensions(StepPoint::solved);
    if (plan().sleeping) find_drowsy_islands(*this);
    commit();
  }

private:
  /* Every pair counts as one that has no colour yet, so that a step with pairs runs again. What the last step, which
   * had none, left of lists and colours is still right. */
  void expect_no_pairs() { run(Kernel::compact_total, {COUNT_BODIES, COUNT_UNCOLORED}, {Buffer::pair_start}); }

  void take_joint_colors()
  {
    run_range(Kernel::copy, COUNT_ZERO, COUNT_HALVES, {}, {Buffer::body_joint_colors, Buffer::body_colors});
  }

  void find_constraints()
  {
    if (has(FEATURE_TREES)) find_leaf_pairs();
    run_extensions(StepPoint::pairs);
    find_contacts();
    if (has(FEATURE_TREES)) merge_contacts();
    run_extensions(StepPoint::contacts);
    color_contacts();
    set_up_contacts();
    if (has(FEATURE_ROLLING)) run(Kernel::prepare_rolling);
  }

  /* Few pairs are read from caches in any order. */
  bool touches_mostly() const
  {
    const uint32_t pairs = plan().known[COUNT_PAIRS];
    return pairs >= 4096 && plan().known[COUNT_CONSTRAINTS] > pairs / 2;
  }

  void set_up_contacts()
  {
    const bool by_pair = touches_mostly();
    if (by_pair) run(Kernel::place_constraints);
    const uint32_t items = by_pair ? COUNT_PAIRS : COUNT_CONSTRAINTS, order = by_pair ? ORDER_BY_PAIR : 0,
                   weighs = layers_at_start() == 0 ? ORDER_WEIGHS : 0;
    if (plan().substeps.automatic) run_range(Kernel::prepare_and_weigh_contacts, COUNT_ZERO, items, {order | weighs});
    else run_range(Kernel::prepare_contacts, COUNT_ZERO, items, {by_pair ? 1u : 0u});
  }

  void find_pairs()
  {
    run(Kernel::compute_bounds);
    if (settings().bounds == Bounds::tight && has(FEATURE_CONVEX)) run(Kernel::tighten_bounds);
    if (plan().forces) run(Kernel::extend_bounds);
    if (plan().sleepers) touch_sleepers();
    row_of(settings().broadphase).launch(*this);
  }

  /* Pairs with sleepers pass through the narrowphase before all others, because their contacts wake. */
  void touch_sleepers()
  {
    find_near_sleepers(*this);
    if (has(FEATURE_TREES)) find_leaf_pairs();
    find_contacts(true);
    run(Kernel::note_touched_sleepers);
    run(Kernel::keep_sleeper_counts);
  }

  void find_leaf_pairs()
  {
    const bool by_subtree = settings().midphase == Midphase::subtrees;
    if (by_subtree) run(Kernel::group_body_pairs);
    if (by_subtree) run_pair_groups(Kernel::count_leaf_pairs_by_subtree, GROUP_PAIRS);
    else run(Kernel::count_leaf_pairs);
    exclusive_scan(launcher(), Buffer::leaf_start, Buffer::leaf_start, Buffer::scan_sums, COUNT_PAIRS,
                   plan().capacity_pairs);
    run(Kernel::count_all_leaf_pairs);
    if (by_subtree) run_pair_groups(Kernel::write_leaf_pairs_by_subtree, GROUP_PAIRS);
    else run(Kernel::write_leaf_pairs);
    run(Kernel::start_leaf_pairs);
    run_range(Kernel::copy, COUNT_ZERO, COUNT_PAIRS, {}, {Buffer::leaf_pair_a, Buffer::pair_a});
    run_range(Kernel::copy, COUNT_ZERO, COUNT_PAIRS, {}, {Buffer::leaf_pair_b, Buffer::pair_b});
  }

  /* Launches groups for as many pairs as the capacity allows, because a device launches no more groups than the host
   * specifies. */
  void run_pair_groups(Kernel kernel, uint32_t pairs_of_group)
  {
    run_at_most(kernel, pair_group_items(plan().capacity_pairs, pairs_of_group));
  }

  void merge_contacts()
  {
    run(Kernel::group_manifolds);
    run(Kernel::merge_manifolds);
    run(Kernel::find_internal_edges);
    run(Kernel::drop_internal_edges);
  }

  /* Launches the kernels of shared/pairs.def for the kinds of pairs that the scene has. */
  void find_contacts(bool with_sleepers = false)
  {
    if (has(FEATURE_PAIR_KINDS)) list_pairs_of_kinds(with_sleepers);
    const bool branches = tests_pairs_side_by_side();
    uint32_t branch = 0;
    for (const PairTest &test : pair_tests) {
      if (!has(test.feature)) continue;
      if (branches) ++branch;
      if (test.kernel == Kernel::collide_convex && settings().narrowphase == Narrowphase::sat_split)
        split_sat(test, branch);
      else collide(test.kernel, test.kind, branch);
      if (test.follower) collide(*test.follower, test.kind, branch);
    }
  }

  /* Finding cores costs a device more than the tests of few far pairs: of 10,000 people on a plane, a third of whose
   * pairs touch, a step took 3.08 ms in place of 2.82 on an H200; of a pile an eighth touches. */
  bool are_mostly_far() const { return plan().known[COUNT_PAIRS] / 4 > plan().known[COUNT_CONSTRAINTS]; }

  /* Neither parts of compounds nor sleepers have cores; and the pairs of small worlds are few. */
  void list_pairs_of_kinds(bool with_sleepers)
  {
    const bool by_core = has(FEATURE_CAPSULE_CAPSULE) && !has(FEATURE_TREES) && !has(FEATURE_WORLDS) &&
                         !with_sleepers && are_mostly_far();
    if (by_core) run(Kernel::find_cores);
    list_pairs(launcher(), plan().capacity_pairs, by_core);
  }

  /* The kernels that follow pairs of one kind leave most of a device idle. Opening branches costs as much as a kernel
   * of few pairs does. */
  bool tests_pairs_side_by_side() const
  {
    constexpr uint32_t least_pairs = 16384;
    const auto is_followed = [&](const PairTest &test) { return test.follower && has(test.feature); };
    return plan().known[COUNT_PAIRS] >= least_pairs &&
           std::count_if(std::begin(pair_tests), std::end(pair_tests), is_followed) > 1;
  }

  void split_sat(const PairTest &test, uint32_t branch)
  {
    for (const Kernel kernel :
         {Kernel::find_separating_axis, Kernel::find_clipping_faces, Kernel::clip_faces, Kernel::reduce_contacts})
      collide(kernel, test.kind, branch);
  }

  /* Kernels that handle convex shapes have a value for the method. */
  void collide(Kernel kernel, uint32_t kind, uint32_t branch)
  {
    const bool takes_method = row_of(kernel).arguments.back().kind == Argument::Kind::value;
    run_pairs(kernel, kind, takes_method ? Values{narrowphase_method(settings())} : Values{}, branch);
  }

  void color_contacts()
  {
    const BatcherRow &batcher = row_of(settings().batching);
    run(Kernel::match_pairs, {batcher.keeps_colors ? 1u : 0u});
    batcher.launch(*this);
    const bool by_world = has_worlds_with_overflow(), by_link = has_links(), by_class = plan().islands_apart;
    if (by_class) part_islands(*this);
    if (by_world) find_color_keys_by_world();
    else if (by_link) run(Kernel::link_color_keys);
    else run(by_class ? Kernel::class_color_keys : Kernel::color_keys);
    sort(Buffer::sort_key, Buffer::sort_value, COUNT_PAIRS, plan().capacity_pairs, 0, 8);
    run(by_world   ? Kernel::world_color_starts
        : by_link  ? Kernel::link_color_starts
        : by_class ? Kernel::class_color_starts
                   : Kernel::color_starts);
    if (settings().check) launch_check(*this);
  }

  void find_color_keys_by_world()
  {
    run_range(Kernel::fill, COUNT_ZERO, COUNT_BODIES, {0}, {Buffer::world_overflows});
    run(Kernel::note_world_overflow);
    run(Kernel::world_color_keys);
  }

  /* COUNT_BRACED_LAYERS that count: all in the first step. */
  uint32_t layers_at_start() const { return plan().substeps.starts ? INDEX_NONE : plan().substeps.layers_at_start; }

  void clear_standing(Buffer standing) { run_range(Kernel::fill, COUNT_ZERO, COUNT_HALVES, {0}, {standing}); }

  void count_supports()
  {
    run_range(Kernel::fill, COUNT_ZERO, COUNT_BODIES, {0}, {Buffer::body_supports});
    run(Kernel::count_supports);
  }

  /* A step carries what stands on a body down by one layer, already where contacts are set up if no supports count. The
   * first step of a world carries it down through stacks, because those that are too tall would have begun to fall by
   * the time that all is known. */
  void weigh_standing()
  {
    const uint32_t passes = plan().substeps.starts ? passes_of_first_step : 1;
    Buffer from = Buffer::cached_standing, to = Buffer::previous_cached_standing, other = Buffer::body_standing_other;
    for (uint32_t pass = 0; pass < passes; ++pass) {
      if (pass > 0) clear_standing(to);
      run(Kernel::weigh_standing, {layers_at_start()}, {from, to});
      from = std::exchange(to, other);
      other = from;
    }
  }

  /* Steps in which all bodies take the fewest substeps keep no wishes, and no side of their buffer may hold any that a
   * step before has kept. */
  void forget_wishes()
  {
    if (plan().forgets_wishes) run_range(Kernel::fill, COUNT_ZERO, COUNT_BODIES, {0}, {Buffer::body_wish});
    if (plan().islands_apart || plan().wishes_left == 0) return;
    run_range(Kernel::fill, COUNT_ZERO, COUNT_BODIES, {0}, {Buffer::previous_cached_wish});
  }

  void keep_out_of_walls()
  {
    run_range(Kernel::fill, COUNT_ZERO, COUNT_BODIES, {WHOLE_TOI_FRACTION}, {Buffer::body_toi_fraction});
    run_pairs(Kernel::clamp_to_time_of_impact, PAIR_KIND_CONVEX_CONVEX, PAIR_KIND_CONVEX_HALF_SPACE, {});
    run(Kernel::stop_at_time_of_impact);
  }

  void commit()
  {
    run(Kernel::check_bodies);
    run(Kernel::finish_step, {plan().colors, highest_load_rate(plan().substeps, settings()), plan().classes});
    if (has(FEATURE_EVENTS)) list_events();
    if (settings().pair_events) list_pair_events();
    if (plan().islands_apart && (plan().classes & MANY_SUBSTEPS)) share_impulses_of_contacts(*this, true);
    launcher().begin_commit();
    run(Kernel::commit_bodies);
    if (balances_trees()) run(Kernel::commit_tree_balance);
    if (settings().moved_bodies) list_moved_bodies();
    if (plan().forces) run(Kernel::clear_forces);
    if (plan().sleeping)
      run_range(Kernel::copy, COUNT_ZERO, COUNT_COMMIT_BODIES, {}, {Buffer::rest_count, Buffer::resting_steps});
    if (plan().islands_apart) run_range(Kernel::fill, COUNT_ZERO, COUNT_COMMIT_BODIES, {0}, {Buffer::body_wish});
    run(Kernel::cache_starts);
    run(Kernel::cache_pairs);
    if (row_of(settings().batching).keeps_colors)
      run_range(Kernel::lower_colors, COLOR_START + KEPT_COLORS, COUNT_COMMIT_CONSTRAINTS);
    run(Kernel::cache_impulses);
    if (has(FEATURE_TREES)) run(Kernel::cache_normals);
    if (has(FEATURE_EVENTS))
      run_range(Kernel::copy, COUNT_ZERO, COUNT_COMMIT_PAIRS, {}, {Buffer::pair_touching, Buffer::cached_touching});
    if (has(FEATURE_ROLLING)) {
      run(Kernel::clear_cached, {1}, {Buffer::cached_rolling_impulse});
      run(Kernel::cache_rolling);
    }
    if (has(FEATURE_JOINTS)) run(Kernel::cache_joints);
    if (has(FEATURE_COUPLINGS)) run(Kernel::cache_couplings);
    if (const auto keep = row_of(settings().solver).commit) keep(*this);
    run_extensions(StepPoint::commit);
  }

  void list_moved_bodies()
  {
    run(Kernel::note_moved);
    compact(launcher(), Buffer::body_moved, Buffer::moved_start, Buffer::scan_sums, Buffer::moved_body,
            COUNT_COMMIT_BODIES, plan().bodies, COUNT_MOVED);
  }

  void list_pair_events()
  {
    run(Kernel::count_pair_events);
    exclusive_scan(launcher(), Buffer::pair_event_start, Buffer::pair_event_start, Buffer::scan_sums,
                   COUNT_COMMIT_BODIES, plan().bodies);
    run(Kernel::compact_total, {COUNT_COMMIT_BODIES, COUNT_PAIR_EVENTS}, {Buffer::pair_event_start});
    run(Kernel::write_pair_events);
  }

  /* This comes before the commit, while bodies are where their contacts were found and the cache is that of the last
   * step. */
  void list_events()
  {
    run(Kernel::pair_impulses);
    run(Kernel::find_touching);
    run(Kernel::count_events);
    exclusive_scan(launcher(), Buffer::event_start, Buffer::event_start, Buffer::scan_sums, COUNT_COMMIT_BODIES,
                   plan().bodies);
    run(Kernel::compact_total, {COUNT_COMMIT_BODIES, COUNT_EVENTS}, {Buffer::event_start});
    run(Kernel::write_events);
  }
};

constexpr uint32_t longest_wait = 4096;

} // namespace

void SettledColors::note_step(uint32_t rounds, uint32_t now)
{
  steps = rounds == 0 && now == colors ? std::min(steps + 1, longest_wait) : 0;
  colors = now;
}

void SettledColors::note_repetition()
{
  if (are_kept()) wait = std::min(2 * wait, longest_wait);
  steps = 0;
}

void launch_step(Launcher &launcher, const StepPlan &plan, const Settings &settings)
{
  Step(launcher, plan, settings).run_all();
}

} // namespace tandem
