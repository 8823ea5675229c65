/* event_oracle.h - an oracle of the events of each step, from the buffers that the step leaves, by maps and in double.
 *
 * It observes the launches. At the start of each substep and at the end it adds the accumulated impulses of the
 * contacts. Once the step is known to be complete, it compares the pairs that touch with those of the step before. It
 * uses nothing of shared/events.
 */
#pragma once

#include <map>

#include "host/runtime/interface/backend.h"
#include "host/runtime/memory.h"
#include "shared/platform.h"
#include "tests/physics/physics.h"

namespace tandem::physics_tests {

class EventOracle {
public:
  struct Contact {
    double impulse = 0, separation = 1e30;
    uint32_t points = 0, manifolds = 0;
    Vector point = Vector::Zero(), normal = Vector::Zero(); /* of the only manifold */
  };
  using Contacts = std::map<std::pair<uint32_t, uint32_t>, Contact>;

  explicit EventOracle(World &world) : world_(world)
  {
    world.set_observer([this](const Launch &launch) { observe(launch.kernel); });
  }

  const Contacts &now() const { return now_; }
  const Contacts &before() const { return before_; }

private:
  void observe(Kernel kernel)
  {
    if (kernel == Kernel::begin_step) carried_.clear(), substep_ = 0;
    if (kernel == Kernel::integrate_velocities && substep_++ > 0) add_up();
    if (kernel != Kernel::finish_step) return;
    add_up();
    if (world_.memory().read<uint32_t>(Buffer::counts, 1, COUNT_STATUS)[0] != 0) return;
    before_ = std::move(now_);
    now_.clear();
    find_contacts();
  }

  void add_up()
  {
    const uint32_t n = world_.memory().read<uint32_t>(Buffer::counts, 1, COUNT_CONSTRAINTS)[0];
    const auto pairs = world_.memory().read<uint32_t>(Buffer::constraint_pair, n);
    const auto impulses = world_.memory().read<float4>(Buffer::constraint_normal_impulse, n);
    for (uint32_t i = 0; i < n; ++i)
      carried_.try_emplace(pairs[i], Eigen::Vector4d::Zero()).first->second +=
          Eigen::Vector4d(impulses[i].x, impulses[i].y, impulses[i].z, impulses[i].w);
  }

  void find_contacts()
  {
    Memory &memory = world_.memory();
    const auto counts = memory.read<uint32_t>(Buffer::counts, COUNT_TOTAL);
    const uint32_t n = counts[COUNT_PAIRS];
    const auto a = memory.read<uint32_t>(Buffer::pair_a, n), b = memory.read<uint32_t>(Buffer::pair_b, n);
    const auto points = memory.read<uint32_t>(Buffer::manifold_count, n);
    const auto normals = memory.read<float4>(Buffer::manifold_normal, n);
    const auto rows = memory.read<float4>(Buffer::manifold_points, counts[CAPACITY_POINTS] * counts[CAPACITY_PAIRS]);
    const std::vector<BodyState> states = world_.bodies(); /* where the step started: nothing is committed yet */
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t first = world_.scene_body(a[i]), second = world_.scene_body(b[i]);
      const Eigen::Vector4d impulses = carried_.count(i) ? carried_[i] : Eigen::Vector4d::Zero();
      Contact found;
      Vector pressed = Vector::Zero(), overlapped = Vector::Zero();
      for (uint32_t k = 0; k < points[i]; ++k) {
        const float4 &r = rows[k * counts[CAPACITY_PAIRS] + i];
        if (r.w > 0 && impulses[k] == 0) continue;
        const Vector at = vector_of(states[first].position) +
                          double(normals[i].w) * vector_of(states[first].linear_velocity) + Vector(r.x, r.y, r.z);
        ++found.points;
        found.impulse += impulses[k];
        found.separation = std::min(found.separation, double(r.w));
        pressed += impulses[k] * at;
        overlapped += at;
      }
      if (found.points == 0) continue;
      found.point = found.impulse > 0 ? pressed / found.impulse : overlapped / found.points;
      found.normal = (first < second ? 1.0 : -1.0) * Vector(normals[i].x, normals[i].y, normals[i].z);
      add(std::minmax(first, second), found);
    }
  }

  void add(std::pair<uint32_t, uint32_t> bodies, const Contact &found)
  {
    Contact &whole = now_[bodies];
    if (whole.manifolds++ == 0) whole.point = found.point, whole.normal = found.normal;
    whole.impulse += found.impulse;
    whole.points += found.points;
    whole.separation = std::min(whole.separation, found.separation);
  }

  World &world_;
  int substep_ = 0;
  std::map<uint32_t, Eigen::Vector4d> carried_; /* by pair */
  Contacts now_, before_;
};

} // namespace tandem::physics_tests
