/* kernel_list.cpp - the rows of kernels.def and buffers.def, expanded. */
#include "host/runtime/interface/kernel_list.h"

#include <array>

#include <tandem/world.h>

#include "shared/argument_groups.h"
#include "shared/parameters.h"

namespace tandem {
namespace {

constexpr uint32_t COUNT_GIVEN = items_given;

constexpr std::array<BufferRow, buffer_count> buffer_rows = {{
#define SIDE(name, element, capacity, per_item, feature, lifetime, fields) \
  {#name, Element::element, Capacity::capacity, per_item, FEATURE_##feature, Lifetime::lifetime, fields},
#include "shared/buffers.def"
}};

/* A group (shared/argument_groups.h) and buffers.def agree about types, or this does not compile. */
constexpr Buffer of_element(Buffer buffer, Element element)
{
  return buffer_rows[index_of(buffer)].element == element ? buffer : throw "the group names another type";
}

#define IN(name) Argument{Argument::Kind::buffer, Access::in, Buffer::name, #name},
#define OUT(name) Argument{Argument::Kind::buffer, Access::out, Buffer::name, #name},
#define INOUT(name) Argument{Argument::Kind::buffer, Access::inout, Buffer::name, #name},
#define SLOT_IN(element, name) Argument{Argument::Kind::slot, Access::in, {}, #name},
#define SLOT_OUT(element, name) Argument{Argument::Kind::slot, Access::out, {}, #name},
#define SLOT_INOUT(element, name) Argument{Argument::Kind::slot, Access::inout, {}, #name},
#define VALUE(name) Argument{Argument::Kind::value, Access::in, {}, #name},
#define LOCAL_MEMORY(words) /* no argument of a launch */

#define ELEMENT_row Element::row
#define ELEMENT_uint Element::uint
#define ELEMENT_ulong Element::ulong
#define ELEMENT_memory_real Element::real
#define MEMBER(access, name, type) \
  Argument{Argument::Kind::buffer, Access::access, of_element(Buffer::name, ELEMENT_##type), #name},
#define IN_MEMBER(name, type, member) MEMBER(in, name, type)
#define OUT_MEMBER(name, type, member) MEMBER(out, name, type)
#define INOUT_MEMBER(name, type, member) MEMBER(inout, name, type)
#define IN_GROUP(name) GROUP_##name(IN_MEMBER)
#define OUT_GROUP(name) GROUP_##name(OUT_MEMBER)
#define INOUT_GROUP(name) GROUP_##name(INOUT_MEMBER)

#define KERNEL(name, stage, form, items, feature, arguments) constexpr Argument arguments_of_##name[] = {arguments};
#include "shared/kernels.def"
#undef KERNEL

#define FORM_ITEM Form::item
#define FORM_LANES Form::lanes
#define FORM_GROUP Form::group
#define FORM_HOST Form::host
constexpr std::array<KernelRow, kernel_count> kernel_rows = {{
#define KERNEL(name, stage, form, items, feature, arguments) \
  {#name, Stage::stage, FORM_##form, COUNT_##items, FEATURE_##feature, arguments_of_##name},
#include "shared/kernels.def"
#undef KERNEL
}};

} // namespace

const KernelRow &row_of(Kernel kernel) { return kernel_rows[index_of(kernel)]; }
const BufferRow &row_of(Buffer buffer) { return buffer_rows[index_of(buffer)]; }

const char *name_of(Kernel kernel) { return row_of(kernel).name; }
const char *name_of(Buffer buffer) { return row_of(buffer).name; }

const char *name_of(Stage stage)
{
  static const char *const names[] = {
#define STAGE(name) #name,
#include "shared/stages.def"
#undef STAGE
  };
  return names[static_cast<size_t>(stage)];
}

size_t size_of(Element element)
{
  switch (element) {
  case Element::row: return sizeof(row);
  case Element::real: return sizeof(memory_real);
  case Element::uint: return sizeof(uint);
  case Element::ulong: return sizeof(ulong);
  case Element::Parameters: return sizeof(Parameters);
  }
  return 0;
}

} // namespace tandem
