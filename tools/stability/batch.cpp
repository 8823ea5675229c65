/* batch.cpp - orders the runs, executes them in parallel and reports progress; see batch.h. */
#include "tools/stability/batch.h"

#include <algorithm>
#include <mutex>
#include <numeric>

#include "tools/command/parallel.h"
#include "tools/command/progress.h"

namespace tandem::stability {
namespace {

struct Task {
  const Case *which;
  std::string solver;
  uint64_t work; /* bodies times passes, plus a constant for each step */
};

std::vector<Task> tasks_of(const Batch &batch)
{
  const uint64_t beside_bodies = 50;
  std::vector<Task> tasks;
  for (const Case *each : batch.cases) {
    const Trial trial = each->build(batch.length);
    for (const std::string &solver : batch.solvers) {
      const Settings settings = settings_of(trial, solver);
      tasks.push_back(
          {each, solver,
           trial.steps * settings.substeps * settings.iterations * (trial.scene.bodies.size() + beside_bodies)});
    }
  }
  return tasks;
}

/* With one run at a time the order is that of the list. With several at once the longest come first, so that none is
 * left over at the end. */
std::vector<size_t> order_of(const std::vector<Task> &tasks, size_t at_once)
{
  std::vector<size_t> order(tasks.size());
  std::iota(order.begin(), order.end(), size_t{0});
  if (at_once > 1)
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return tasks[a].work > tasks[b].work; });
  return order;
}

uint64_t total_work(const std::vector<Task> &tasks)
{
  uint64_t sum = 0;
  for (const Task &task : tasks) sum += task.work;
  return sum;
}

/* One bar for all threads. A case that is repeated with other settings is counted once. */
class SharedProgress {
public:
  explicit SharedProgress(uint64_t total) : progress_("stability", total) {}
  void add(uint64_t work)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    progress_.update(done_ += work);
  }
  void clear()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    progress_.clear();
  }

private:
  std::mutex mutex_;
  Progress progress_;
  uint64_t done_ = 0;
};

Outcome run_task(const Task &task, const Batch &batch, SharedProgress &progress)
{
  uint64_t counted = 0;
  Outcome outcome = run_case(*task.which, batch.length, task.solver, batch.placement, [&](uint64_t done, uint64_t of) {
    const uint64_t reached = task.work * done / of;
    if (reached <= counted) return;
    progress.add(reached - counted);
    counted = reached;
  });
  progress.add(task.work - counted);
  return outcome;
}

} // namespace

Results run_batch(const Batch &batch, const std::function<void(const Results &so_far)> &after_each)
{
  const std::vector<Task> tasks = tasks_of(batch);
  const std::vector<size_t> order = order_of(tasks, batch.at_once);
  Results results{batch.placement.on, batch.solvers, batch.length, {}, tasks.size(), batch.at_once};
  SharedProgress progress(total_work(tasks));
  std::mutex mutex;
  in_parallel(tasks.size(), batch.at_once, [&](size_t k) {
    const Task &task = tasks[order[k]];
    Outcome outcome = run_task(task, batch, progress);
    const Scene scene = task.which->build(batch.length).scene;
    const std::lock_guard<std::mutex> lock(mutex);
    results.add(*task.which, scene, std::move(outcome), order[k]);
    progress.clear();
    if (after_each) after_each(results);
  });
  return results;
}

} // namespace tandem::stability
