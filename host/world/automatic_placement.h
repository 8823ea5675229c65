/* automatic_placement.h - a placement that follows the times of steps: runs the candidates of placement_choice.h, times
 * them, and says what was chosen.
 */
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tandem/world.h>

#include "host/pipeline/step.h"
#include "host/world/placed_backends.h"
#include "host/world/placement_choice.h"
#include "host/world/stage_cut.h"

namespace tandem {

class AutomaticPlacement {
public:
  /* What a step needs to know of the scene. */
  struct Scene {
    const StepPlan &plan;
    const Settings &settings;
    Memory &memory;
    uint32_t bodies; /* that exist in the buffers */
    uint32_t bodies_awake;
  };

  explicit AutomaticPlacement(const Placement &asked);
  /* The placement of the first steps: the CPU. */
  static Placement first_of(const Placement &asked);

  /* Makes the device, so that one that is not there is refused at once, and begins to build its kernels. */
  void look_for_device(PlacedBackends &backends, const std::vector<Kernel> &kernels);
  /* The same, and whether the kernels are built. What cannot be built counts as built, and fails where it is placed. */
  bool has_looked_for_device(PlacedBackends &backends, const std::vector<Kernel> &kernels);
  /* A placement that the next step should have, if it is another one than that of the last step. */
  std::optional<Placement> wanted() const;
  void was_placed() { placed_ = choice_.next(); }
  void device_fails(const std::string &why);
  bool has_device() const { return no_device_.empty(); }

  /* Around a step; a step that fails is abandoned. Times say nothing while an observer looks at each launch, a user
   * profiles, or kernels are being built. */
  void begin_step(PlacedBackends &backends, bool observed);
  void end_step(PlacedBackends &backends, const Scene &scene);
  void abandon_step(PlacedBackends &backends);
  void measure_again() { choice_.measure_again(); }

  PlacementReport report() const;

private:
  Placement placement_of(Candidate candidate) const;
  std::string text_of(Candidate candidate) const;
  std::string why() const;
  double now() const;
  void take_stage_times(PlacedBackends &backends, Candidate candidate);
  void look_for_cut(const Scene &scene);
  std::vector<double> scaled_stages(Candidate candidate) const;

  Placement asked_;
  PlacementChoice choice_;
  Candidate placed_ = Candidate::cpu;
  std::string no_device_; /* why there is none; else empty */
  StageCut cut_;
  std::vector<double> stages_[candidates]; /* ms of each stage, of cpu and device */
  bool profiles_ = false;
  std::optional<double> began_; /* ms; nothing while no step that counts is under way */
};

} // namespace tandem
