/* module.cpp - the registry of the modules that were added; see module.h. */
#include "host/runtime/interface/module.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>

#include <tandem/error.h>

namespace tandem {
namespace {

constexpr size_t most_modules = 64, most_rows = 4096; /* most_rows: of all lists together */

/* A thread that has the number of a kernel or a buffer got it from a module that was added before, so the row was
 * written before the number was known, and readers need no lock. */
struct Registry {
  std::mutex mutex;
  std::array<std::unique_ptr<const Module>, most_modules> modules;
  std::array<const KernelRow *, most_rows> kernels{};
  std::array<const BufferRow *, most_rows> buffers{};
  std::atomic<size_t> module_total{0}, kernel_total{kernel_count}, buffer_total{buffer_count};
};

Registry &registry()
{
  static Registry &only = *new Registry; /* never destroyed, because worlds may outlive static objects */
  return only;
}

[[noreturn]] void refuse(const ModuleLists &lists, const std::string &why)
{
  throw InputError(std::string("module '") + lists.name + "': " + why);
}

template <class Rows, class RowAt>
void check_names(const ModuleLists &lists, const char *what, const Rows &rows, size_t known, RowAt row_at)
{
  for (size_t i = 0; i < known; ++i)
    for (const auto &row : rows)
      if (std::string(row.name) == row_of(row_at(i)).name)
        refuse(lists, std::string(what) + " '" + row.name + "' is already there, of another module; use another name");
}

bool are_the_same(const ModuleLists &one, const ModuleLists &other)
{
  return one.kernels.data() == other.kernels.data() && one.buffers.data() == other.buffers.data() &&
         std::string(one.name) == other.name;
}

void check(const ModuleLists &lists, const Registry &known)
{
  for (size_t i = 0; i < known.module_total + stage_count; ++i)
    if (std::string(lists.name) == name_of(static_cast<Stage>(i)))
      refuse(lists, "a stage of this name is already there; use another name");
  if (known.module_total == most_modules || known.kernel_total + lists.kernels.size() > most_rows ||
      known.buffer_total + lists.buffers.size() > most_rows)
    refuse(lists, "there is no room for it: " + std::to_string(most_modules) + " modules and " +
                      std::to_string(most_rows) + " rows of each kind are the most");
  for (const KernelRow &row : lists.kernels)
    if (row.execution == Execution::host)
      refuse(lists, std::string("kernel '") + row.name + "' is of execution HOST, which the pipeline's own are alone");
  for (const BufferRow &row : lists.buffers) {
    if (row.per_item == 0)
      refuse(lists, std::string("buffer '") + row.name + "' has no elements per item; use 1 or more");
    if (row.capacity == Capacity::NOTHING && (row.lifetime == Lifetime::STATE || row.lifetime == Lifetime::CACHE))
      refuse(lists, std::string("buffer '") + row.name + "' has capacity NOTHING, so its lifetime is SCENE or KEPT");
  }
  check_names(lists, "kernel", lists.kernels, known.kernel_total, kernel_at);
  check_names(lists, "buffer", lists.buffers, known.buffer_total, buffer_at);
}

} // namespace

Module::Module(const ModuleLists &lists, size_t number, size_t first_kernel, size_t first_buffer)
    : lists_(lists), stage_(static_cast<Stage>(stage_count + number)), first_kernel_(first_kernel),
      first_buffer_(first_buffer), kernel_rows_(lists.kernels.begin(), lists.kernels.end()),
      buffer_rows_(lists.buffers.begin(), lists.buffers.end())
{
  arguments_.reserve(kernel_rows_.size());
  for (KernelRow &row : kernel_rows_) {
    std::vector<Argument> &arguments = arguments_.emplace_back(row.arguments.begin(), row.arguments.end());
    for (Argument &argument : arguments)
      if (argument.kind == Argument::Kind::buffer && index_of(argument.buffer) >= first_own_buffer)
        argument.buffer = buffer(index_of(argument.buffer) - first_own_buffer);
    row.arguments = arguments;
    row.stage = stage_;
  }
}

const Module &add_module(const ModuleLists &lists)
{
  Registry &known = registry();
  const std::lock_guard<std::mutex> lock(known.mutex);
  for (size_t i = 0; i < known.module_total; ++i)
    if (are_the_same(known.modules[i]->lists(), lists)) return *known.modules[i];
  check(lists, known);
  const size_t number = known.module_total, first_kernel = known.kernel_total, first_buffer = known.buffer_total;
  known.modules[number] = std::make_unique<const Module>(lists, number, first_kernel, first_buffer);
  const Module &added = *known.modules[number];
  for (size_t i = 0; i < added.kernels(); ++i) known.kernels[first_kernel + i] = &added.kernel_row(i);
  for (size_t i = 0; i < added.buffers(); ++i) known.buffers[first_buffer + i] = &added.buffer_row(i);
  known.kernel_total = first_kernel + added.kernels();
  known.buffer_total = first_buffer + added.buffers();
  ++known.module_total;
  return added;
}

size_t module_count() { return registry().module_total; }
const Module &module_at(size_t number) { return *registry().modules.at(number); }

const KernelRow &row_of_module(Kernel kernel)
{
  if (index_of(kernel) >= all_kernels())
    throw InputError("kernel " + std::to_string(index_of(kernel)) + " is of no module; take kernels from its header");
  return *registry().kernels[index_of(kernel)];
}

const BufferRow &row_of_module(Buffer buffer)
{
  if (index_of(buffer) >= all_buffers())
    throw InputError("buffer " + std::to_string(index_of(buffer)) + " is of no module; take buffers from its header");
  return *registry().buffers[index_of(buffer)];
}

std::optional<Kernel> find_kernel(const std::string &name)
{
  for (size_t i = 0; i < all_kernels(); ++i)
    if (name == row_of(kernel_at(i)).name) return kernel_at(i);
  return std::nullopt;
}

std::optional<Buffer> find_buffer(const std::string &name)
{
  for (size_t i = 0; i < all_buffers(); ++i)
    if (name == row_of(buffer_at(i)).name) return buffer_at(i);
  return std::nullopt;
}

Kernel kernel_named(const std::string &name)
{
  if (const std::optional<Kernel> kernel = find_kernel(name)) return *kernel;
  throw InputError("no kernel is called '" + name + "'; shared/kernels.def has the pipeline's");
}

Buffer buffer_named(const std::string &name)
{
  if (const std::optional<Buffer> buffer = find_buffer(name)) return *buffer;
  throw InputError("no buffer is called '" + name + "'; shared/buffers.def has the pipeline's");
}

size_t all_kernels() { return registry().kernel_total; }
size_t all_buffers() { return registry().buffer_total; }
size_t all_stages() { return stage_count + registry().module_total; }

} // namespace tandem
