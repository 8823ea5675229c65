/* module.h - a module: a list of kernels and a list of buffers, and the functions that run them on every backend.
 *
 * The pipeline is the first module, and its rows are enumerators of Kernel and Buffer. Other modules, of projects
 * outside the tree, are added while a program runs; their kernels and buffers get numbers after all earlier ones, so
 * that memory, placement, profiles and comparisons treat them as the pipeline's own. tandem_add_module()
 * (cmake/TandemModules.cmake) writes the source that calls add_module(); docs/your-own-kernel.md describes its use.
 */
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tandem/export.h>
#include <tandem/module.h>

#include "host/runtime/interface/embedded_program.h"
#include "host/runtime/interface/kernel_list.h"

namespace tandem {

/* Runs items (or, of GROUP kernels, groups) first .. last - 1. arguments[k] points to the buffer, or to the 4-byte
 * value, of the k-th argument of the kernel's row. */
using RunRange = void (*)(void *const *arguments, uint32_t first, uint32_t last);

/* The variants in which MiniCL compiles the same source; see minicl/kernel_table.h. */
enum class Width : uint8_t { scalar, scalar_avx2, backward, reference, lanes4, lanes8, lanes16 };
constexpr size_t width_count = 7;

/* A buffer of the module itself in the arguments of its rows, before add_module() has numbered it. */
constexpr uint16_t first_own_buffer = 0x8000;
constexpr Buffer own_buffer(size_t row) { return static_cast<Buffer>(first_own_buffer + row); }

/* The stage of each row of a module before add_module() has numbered it. The whole module is one stage with the
 * module's name. */
constexpr Stage own_stage{0xff};

struct ModuleLists {
  const char *name; /* a C identifier; the stage of every row */
  std::span<const KernelRow> kernels;
  std::span<const BufferRow> buffers;
  std::array<const RunRange *, width_count> run; /* by Width: a function for each kernel, or null for a width that has
                                                    none */
  const std::vector<EmbeddedProgram> *programs;  /* for OpenCL: one program, with the module's name */
};

class Module {
public:
  const char *name() const { return lists_.name; }
  Stage stage() const { return stage_; }
  Kernel kernel(size_t row) const { return kernel_at(first_kernel_ + row); }
  Buffer buffer(size_t row) const { return buffer_at(first_buffer_ + row); }
  size_t kernels() const { return kernel_rows_.size(); }
  size_t buffers() const { return buffer_rows_.size(); }
  RunRange run(Width width, size_t row) const
  {
    const RunRange *const table = lists_.run[static_cast<size_t>(width)];
    return table ? table[row] : nullptr;
  }
  const std::vector<EmbeddedProgram> &programs() const { return *lists_.programs; }
  const ModuleLists &lists() const { return lists_; }

  Module(const ModuleLists &lists, size_t number, size_t first_kernel, size_t first_buffer);
  const KernelRow &kernel_row(size_t row) const { return kernel_rows_[row]; }
  const BufferRow &buffer_row(size_t row) const { return buffer_rows_[row]; }

private:
  ModuleLists lists_;
  Stage stage_;
  size_t first_kernel_, first_buffer_;
  std::vector<std::vector<Argument>> arguments_;
  std::vector<KernelRow> kernel_rows_;
  std::vector<BufferRow> buffer_rows_;
};

/* Adds a module for the life of the process. If it was added before, the earlier one is returned. Threads may call it
 * at the same time; worlds made before cannot use the module. Throws InputError if a name is taken or there are too
 * many modules or rows. */
TANDEM_API const Module &add_module(const ModuleLists &lists);

size_t module_count();
const Module &module_at(size_t number); /* in the order in which they were added */
/* By the name in any module's list. */
TANDEM_API std::optional<Kernel> find_kernel(const std::string &name);
TANDEM_API std::optional<Buffer> find_buffer(const std::string &name);
const KernelRow &row_of_module(Kernel kernel);
const BufferRow &row_of_module(Buffer buffer);

} // namespace tandem
