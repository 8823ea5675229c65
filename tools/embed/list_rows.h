/* list_rows.h - the rows of a list of kernels as tables of text, from which entries of OpenCL are written.
 *
 * The compiler of the host expands the same rows as macros (host/runtime/interface/kernel_list.h). Here they are parsed
 * as text, because an entry needs what macros cannot provide: the type of each buffer, which is given in buffers.def.
 * */
#pragma once

#include <string>
#include <vector>

namespace embed {

/* One parameter of an entry. */
struct Parameter {
  enum class Kind { read, written, value } kind;
  std::string type, name;
};

/* An argument of the shared function: one parameter, or a struct of several (shared/argument_groups.h). */
struct FunctionArgument {
  std::string group_type; /* empty for a single parameter */
  std::vector<std::string> members;
  std::vector<Parameter> parameters;
};

struct KernelRow {
  std::string name, stage, execution, feature;
  std::vector<FunctionArgument> arguments;
  std::string local_words; /* of a kernel of groups: the size of its local memory */
  int line;                /* of kernels.def, from 1 */
};

inline bool has_groups(const KernelRow &row) { return row.execution == "GROUP" || row.execution == "LANES_GROUP"; }

/* The lists of a module. Its rows may also name the pipeline's buffers and groups (ROOT/shared). */
struct Lists {
  std::string root;
  std::string kernels; /* a file, by its name in messages */
  std::string buffers; /* the module's own buffers; empty for the pipeline */
};

/* The rows in the order of the list. Throws std::runtime_error that names an invalid row. */
std::vector<KernelRow> kernel_rows(const Lists &lists);

} // namespace embed
