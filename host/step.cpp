/* step.cpp - the whole step on one page: which kernels run, in which order.
 *
 *   bounds -> pairs -> manifolds -> colours -> constraints -> substeps x colours -> commit
 *
 * Nothing here waits for a device: ranges are read from counts on the device, and the plan only says how
 * large the launches should be.
 */
#include "host/step.h"

#include <bit>

#include "host/batching/batcher.h"
#include "host/primitives.h"

namespace tandem {
namespace {

class Step {
public:
  Step(Launcher &launcher, const StepPlan &plan, const Settings &settings) : launcher_(launcher), plan_(plan), settings_(settings) {}

  void run()
  {
    run(Kernel::begin_step);
    run(Kernel::prepare_bodies);
    find_pairs();
    find_contacts();
    color_contacts();
    run(Kernel::prepare_contacts);
    for (uint32_t substep = 0; substep < settings_.substeps; ++substep) solve_substep();
    if (has(FEATURE_RESTITUTION)) for_each_color(Kernel::apply_restitution, Kernel::apply_restitution_tail);
    commit();
  }

private:
  void find_pairs()
  {
    run(Kernel::compute_bounds);
    if (settings_.broadphase == "brute-force") find_pairs_by_brute_force();
    else if (settings_.broadphase == "sap") find_pairs_by_sweep();
    else find_pairs_in_grid();
  }

  void find_pairs_by_brute_force()
  {
    run(Kernel::brute_force_count);
    scan_pairs(Buffer::pair_start);
    run(Kernel::brute_force_write);
  }

  void find_pairs_in_grid()
  {
    find_extent();
    run(Kernel::grid_keys);
    sort(Buffer::sort_key, Buffer::sort_value, COUNT_SMALL, plan_.bodies, 0, bits_of(plan_.capacity_cells));
    run(Kernel::grid_cells);
    run(Kernel::grid_count);
    scan_pairs(Buffer::pair_start);
    run(Kernel::grid_write);
  }

  void find_pairs_by_sweep()
  {
    find_extent();
    run(Kernel::sweep_keys);
    sort(Buffer::sort_key, Buffer::sort_value, COUNT_SMALL, plan_.bodies, 0, 32);
    run(Kernel::sweep_gather);
    run(Kernel::sweep_count);
    scan_pairs(Buffer::sweep_start);
    run(Kernel::sweep_write);
    for (unsigned first_bit : {0u, 32u})
      sort_keys64(launcher_, Buffer::pair_key, Buffer::pair_key_other, Buffer::sort_histogram, Buffer::scan_sums, COUNT_PAIRS,
                  plan_.capacity_pairs, first_bit, first_bit + bits_of(plan_.bodies));
    run(Kernel::sweep_unpack);
    run(Kernel::sweep_starts);
  }

  void find_extent()
  {
    run(Kernel::extent_tiles);
    run(Kernel::extent_whole);
    run(Kernel::lay_out);
  }

  void scan_pairs(Buffer starts)
  {
    exclusive_scan(launcher_, starts, starts, Buffer::scan_sums, COUNT_BODIES, plan_.bodies);
    launcher_.launch({Kernel::count_pairs, {starts}, {}, COUNT_ZERO, COUNT_ONE, 1});
  }

  /* The matrix of shape pairs; a gap is a pair that the scene does not have. */
  void find_contacts()
  {
    if (has(FEATURE_SPHERE_SPHERE)) run(Kernel::collide_sphere_sphere);
    if (has(FEATURE_SPHERE_BOX)) run(Kernel::collide_sphere_box);
    if (has(FEATURE_BOX_BOX)) run(Kernel::collide_box_box);
    if (has(FEATURE_SPHERE_HALF_SPACE)) run(Kernel::collide_sphere_half_space);
    if (has(FEATURE_BOX_HALF_SPACE)) run(Kernel::collide_box_half_space);
  }

  void color_contacts()
  {
    const Batcher &batcher = batcher_named(settings_.batching);
    run(Kernel::match_pairs, {batcher.keeps_colors ? 1u : 0u});
    batcher.launch(launcher_, plan_);
    run(Kernel::color_keys);
    sort(Buffer::sort_key, Buffer::sort_value, COUNT_PAIRS, plan_.capacity_pairs, 0, 8);
    run(Kernel::color_starts);
    if (settings_.check) check_batches(launcher_, plan_);
  }

  void solve_substep()
  {
    run(Kernel::integrate_velocities);
    for_each_color(Kernel::warm_start, Kernel::warm_start_tail);
    for (uint32_t iteration = 0; iteration < settings_.iterations; ++iteration)
      for_each_color(Kernel::solve_contacts, Kernel::solve_tail, {1});
    run(Kernel::integrate_positions);
    for_each_color(Kernel::solve_contacts, Kernel::solve_tail, {0});
  }

  void commit()
  {
    run(Kernel::check_bodies);
    run(Kernel::finish_step, {plan_.colors});
    run(Kernel::commit_bodies);
    run(Kernel::cache_starts);
    run(Kernel::cache_pairs);
    run(Kernel::cache_impulses);
  }

  void for_each_color(Kernel kernel, Kernel tail, const std::vector<uint32_t> &values = {})
  {
    for (uint32_t color = 0; color < std::min(plan_.colors, COLOR_LIMIT); ++color) {
      const uint32_t first = COLOR_START + color;
      launcher_.launch({kernel, {}, values, first, first + 1, plan_.known[first + 1] - plan_.known[first]});
    }
    if (plan_.colors > COLOR_LIMIT) run(tail, values);
  }

  void sort(Buffer keys, Buffer values, uint32_t length, uint32_t capacity, unsigned first_bit, unsigned last_bit)
  {
    sort_pairs(launcher_, keys, values, Buffer::sort_key_other, Buffer::sort_value_other, Buffer::sort_histogram, Buffer::scan_sums, length,
               capacity, first_bit, last_bit);
  }

  void run(Kernel kernel, const std::vector<uint32_t> &values = {})
  {
    const uint32_t last = row_of(kernel).items;
    launcher_.launch({kernel, {}, values, COUNT_ZERO, last, plan_.known[last]});
  }

  bool has(uint32_t feature) const { return (plan_.features & feature) != 0; }
  static unsigned bits_of(uint32_t values) { return std::bit_width(values); }

  Launcher &launcher_;
  const StepPlan &plan_;
  const Settings &settings_;
};

} // namespace

void launch_step(Launcher &launcher, const StepPlan &plan, const Settings &settings) { Step(launcher, plan, settings).run(); }

} // namespace tandem
