/* list_rows.h - the rows of a list of kernels as tables of text, from which entries of OpenCL are written.
 *
 * The compiler of the host expands the same rows as macros (host/runtime/interface/kernel_list.h). Here they are read
 * as text, because an entry needs what macros cannot give: the type of each buffer, which stands in buffers.def. */
#pragma once

#include <string>
#include <vector>

namespace embed {

/* What becomes one parameter of an entry. */
struct Parameter {
  enum class Kind { read, written, value } kind;
  std::string type, name;
};

/* An argument of the shared function: a parameter, or a struct of several (shared/argument_groups.h). */
struct FunctionArgument {
  std::string group_type; /* empty: the one parameter itself */
  std::vector<std::string> members;
  std::vector<Parameter> parameters;
};

struct KernelRow {
  std::string name, stage, execution;
  std::vector<FunctionArgument> arguments;
  std::string local_words; /* of a GROUP kernel: the size of its local memory */
  int line;                /* of kernels.def, from 1 */
};

/* The lists of a module. The pipeline's buffers and groups (ROOT/shared) can be named by all. */
struct Lists {
  std::string root;
  std::string kernels; /* a file, as it is named in messages */
  std::string buffers; /* of the module's own; empty: the pipeline's alone */
};

/* Rows in the order of the list; std::runtime_error names a row that does not fit. */
std::vector<KernelRow> kernel_rows(const Lists &lists);

} // namespace embed
