/* plan_picture.h - draws two plans beside each other as one SVG: what is kept and what is left out, and why.
 *
 *   this scene                         with every feature
 *   narrowphase  2 of 17 kernels       narrowphase  15 of 17 kernels
 *   +---------+ +---------+            +---------+ +---------+
 *   | kept    | | left out|            | kept    | | kept    |      boxes stand at the same place in both columns,
 *   | on tbb  | | BOX_BOX |            | serial  | | serial  |      so that what differs shows
 *   +---------+ +---------+            +---------+ +---------+
 *
 * Kernels that are kept have the colour of their backend, buffers that are kept an outline, and what is left out is
 * grey, with what brings it in. Each box has a <title>, which browsers show on hover.
 */
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace tandem {

/* A kernel or a buffer as one plan has it. */
struct PlanBox {
  std::string name;
  std::string note;    /* the second line: a backend, bytes, or what brings it in */
  std::string meaning; /* on hover */
  bool kept = false;
  std::optional<size_t> color; /* of the backend; a buffer has none */
};

struct PlanStage {
  std::string name, summary;
  std::vector<PlanBox> kernels, buffers; /* the same names in both columns, in the same order */
};

struct PlanColumn {
  std::string title, summary;
  std::vector<PlanStage> stages; /* the same in both columns */
};

std::string svg_of(const std::string &title, const std::array<PlanColumn, 2> &columns);

} // namespace tandem
