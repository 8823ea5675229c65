/* plan.h - what a scene's world has beside one with every feature: the facts that the text, the JSON and the picture of
 * `tandem plan` show. */
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tandem/world.h>

#include "host/runtime/interface/kernel_list.h"

namespace tandem {

class Plan {
public:
  Plan(World &chosen, World &everything);

  World &chosen, &everything;

  bool has(int feature) const { return (chosen.features() & feature_of_index(feature)) != 0; }
  bool builds(Kernel kernel) const { return built_[index_of(kernel)]; }
  bool builds_with_all(Kernel kernel) const { return built_with_all_[index_of(kernel)]; }
  std::string backend_of(Kernel kernel) const; /* empty unless it is built */
  uint64_t bytes(Buffer buffer) const;
  uint64_t bytes_with_all(Buffer buffer) const;
  std::string flags() const;
  std::string library_option() const; /* configures a library that has these features alone */

private:
  std::vector<bool> built_, built_with_all_;
};

/* The buffer in whose memory this one lies, or none where it has memory of its own. */
std::optional<Buffer> landlord_of(World &world, Buffer buffer);

/* What a world takes for each body, and for each pair that it has room for. */
struct BytesEach {
  uint32_t room = 0;
  double body = 0, pair = 0;
};
BytesEach bytes_each(World &world);

/* The kernels and the bytes of a stage; shared memory counts where its owner does. */
struct StageSum {
  Stage stage;
  size_t kernels = 0, kernels_with_all = 0, kernels_of_all = 0;
  uint64_t bytes = 0, bytes_with_all = 0;
};
std::vector<StageSum> sums_by_stage(const Plan &plan); /* in pipeline order */

/* The picture of plan_picture.h. */
std::string picture_of(const Plan &plan, const std::string &scene);

/* What brings the kernel or the buffer in: features, or an option or a call of the user. */
std::string what_brings_in(Kernel kernel);
std::string what_brings_in(Buffer buffer);

/* The stage that a buffer belongs to: that of the first kernel that writes it, or else reads it. */
Stage stage_of(Buffer buffer);

/* The features of a mask by name: "BOX_BOX or TREES". */
std::string feature_names(Features mask);

} // namespace tandem
