/* kernel_list.h - kernels.def, buffers.def and stages.def as enums and tables: the pipeline as the host sees it.
 *
 * The pipeline is the first module of kernels and buffers. Those of other modules have numbers after its own
 * (host/runtime/interface/module.h), and row_of() finds the rows of all of them.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <tandem/export.h>

#include "host/runtime/interface/buffer_sides.h"
#include "host/runtime/interface/features.h"
#include "shared/counts.h"

namespace tandem {

enum class Kernel : uint16_t {
#define KERNEL(name, stage, execution, items, feature, arguments) name,
#include "shared/kernels.def"
#undef KERNEL
};

constexpr size_t kernel_count = 0
#define KERNEL(name, stage, execution, items, feature, arguments) +1
#include "shared/kernels.def"
#undef KERNEL
    ;

#define BUFFER BUFFER_SIDES
enum class Buffer : uint16_t {
#define SIDE(name, element, capacity, per_item, feature, lifetime, fields) name,
#include "shared/buffers.def"
#undef SIDE
};

constexpr size_t buffer_count = 0
#define SIDE(name, element, capacity, per_item, feature, lifetime, fields) +1
#include "shared/buffers.def"
#undef SIDE
    ;
#undef BUFFER

enum class Execution : uint8_t { item, lanes, lanes_padded, group, host };
enum class Access : uint8_t { in, out, inout };
enum class Stage : uint8_t {
#define STAGE(name) name,
#include "shared/stages.def"
#undef STAGE
};

constexpr size_t stage_count = 0
#define STAGE(name) +1
#include "shared/stages.def"
#undef STAGE
    ;

/* The quantity that sizes a buffer. buffers.def names it, and items_of in host/pipeline/layout.cpp gives the number of
 * items. */
enum class Capacity : uint8_t {
  NOTHING,
  ONE,
  MATERIALS,
  HULLS,
  HULL_VERTICES,
  HULL_FACES,
  HULL_CORNERS,
  HULL_EDGES,
  HULL_CHUNKS,
  HULL_LINKS,
  TREES,
  TREE_NODES,
  TREE_LEAVES,
  TREE_SUBTREES,
  MESH_VERTICES,
  MESH_TRIANGLES,
  SHAPES,
  FILTERS,
  JOINTS,
  JOINT_AXES,
  COUPLINGS,
  ARTICULATIONS,
  LINKS,
  PATH_ENTRIES,
  BODIES,
  BODIES_PLUS_ONE,
  SLEEPERS,
  MOVED_ROWS,
  PAIRS,
  TREE_CONTACTS,
  TREE_CONTACT_FREEDOMS,
  PAIRS_PLUS_ONE,
  EVENTS,
  CELLS,
  LEAVES,
  LEAF_TILES,
  CANDIDATE_PAIRS,
  TILES,
  SORTABLE,
  SORT_HISTOGRAM,
  SCAN_SUMS,
  REDUCE_PARTIAL
};

enum class Element : uint8_t { float4, real, uint, ulong, Parameters };

/* How long the contents of a buffer are needed; buffers.def defines each word. */
enum class Lifetime : uint8_t { SCENE, STATE, CACHE, KEPT, SCRATCH };

struct Argument {
  enum class Kind : uint8_t { buffer, slot, value } kind;
  Access access;
  Buffer buffer; /* Kind::buffer only */
  const char *name;
  Element element = Element::uint; /* of Kind::slot; the element of a buffer is in its own row */
};

constexpr uint32_t items_given = 0xffffffffu; /* the launch names both ends of the range */

struct KernelRow {
  const char *name;
  Stage stage;
  Execution execution;
  uint32_t items;   /* entry of counts that ends the range, or items_given */
  Features feature; /* 0: always */
  std::span<const Argument> arguments;
};

struct BufferRow {
  const char *name;
  Element element;
  Capacity capacity;
  uint32_t per_item; /* elements */
  Features feature;  /* 0: always */
  Lifetime lifetime;
  const char *fields; /* names of the scalars of one item, separated by spaces */
};

constexpr bool has_rows_of_joints(const BufferRow &row)
{
  return row.capacity == Capacity::JOINTS || row.capacity == Capacity::JOINT_AXES;
}

TANDEM_API const KernelRow &row_of(Kernel kernel);
TANDEM_API const BufferRow &row_of(Buffer buffer);
TANDEM_API const char *name_of(Stage stage);
TANDEM_API size_t size_of(Element element);

inline Kernel kernel_at(size_t index) { return static_cast<Kernel>(index); }
inline Buffer buffer_at(size_t index) { return static_cast<Buffer>(index); }
constexpr size_t index_of(Kernel kernel) { return static_cast<size_t>(kernel); }
constexpr size_t index_of(Buffer buffer) { return static_cast<size_t>(buffer); }

/* The numbers of rows of the pipeline and of all modules added so far. */
TANDEM_API size_t all_kernels();
TANDEM_API size_t all_buffers();
size_t all_stages();

} // namespace tandem
