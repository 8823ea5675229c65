/* kernel_list.cpp - the tables of kernels.def and buffers.def, and the names and sizes of their rows. */
#include "host/runtime/interface/kernel_list.h"

#include <iterator>

#include <tandem/world.h>

#include "host/runtime/interface/module.h"
#include "shared/argument_groups.h"
#include "shared/parameters.h"

namespace tandem {
namespace {

using enum Buffer;

/* Checks at compile time that a group (shared/argument_groups.h) and buffers.def agree about the type of a buffer. */
template <class Rows> constexpr Buffer of_element(const Rows &rows, Buffer buffer, Element element)
{
  return rows[index_of(buffer)].element == element ? buffer : throw "the group names another type";
}

#define KERNEL_LIST "shared/kernels.def"
#define BUFFER_LIST "shared/buffers.def"
#define STAGE_OF(stage) Stage::stage
#define OF_ELEMENT(buffer, element) of_element(buffer_rows, buffer, element)
#include "host/runtime/interface/list_rows.inc"
static_assert(std::size(kernel_rows) == kernel_count + 1 && std::size(buffer_rows) == buffer_count + 1);

} // namespace

const KernelRow &row_of(Kernel kernel)
{
  return index_of(kernel) < kernel_count ? kernel_rows[index_of(kernel)] : row_of_module(kernel);
}

const BufferRow &row_of(Buffer buffer)
{
  return index_of(buffer) < buffer_count ? buffer_rows[index_of(buffer)] : row_of_module(buffer);
}

const char *name_of(Kernel kernel) { return row_of(kernel).name; }
const char *name_of(Buffer buffer) { return row_of(buffer).name; }

const char *name_of(Stage stage)
{
  static const char *const names[] = {
#define STAGE(name) #name,
#include "shared/stages.def"
#undef STAGE
  };
  const size_t index = static_cast<size_t>(stage);
  return index < stage_count ? names[index] : module_at(index - stage_count).name();
}

size_t size_of(Element element)
{
  switch (element) {
  case Element::float4: return sizeof(float4);
  case Element::real: return sizeof(memory_real);
  case Element::uint: return sizeof(uint);
  case Element::ulong: return sizeof(ulong);
  case Element::Parameters: return sizeof(Parameters);
  }
  return 0;
}

} // namespace tandem
