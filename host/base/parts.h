/* parts.h - work in numbered parts that do not depend on each other, such as the blocks of a hash. Who calls decides
 * what runs them: this library's lower layers know of no threads. */
#pragma once

#include <cstddef>

namespace tandem {

/* Refers to a function of a part's number, which must outlive it; unlike std::function it allocates nothing. */
class PartFunction {
public:
  template <class Function>
  explicit PartFunction(const Function &function)
      : function_(&function),
        call_([](const void *called, size_t part) { (*static_cast<const Function *>(called))(part); })
  {}
  void operator()(size_t part) const { call_(function_, part); }

private:
  const void *function_;
  void (*call_)(const void *, size_t);
};

/* Runs each of the parts 0 ... parts - 1 once. If some throw, all others have run, or none after the lowest of these,
 * whose exception leaves the call: what is thrown does not depend on threads. run_parts of host/runtime/parts.h has
 * several threads. */
using RunParts = void (*)(size_t parts, PartFunction run);

inline void run_parts_in_order(size_t parts, PartFunction run)
{
  for (size_t part = 0; part < parts; ++part) run(part);
}

} // namespace tandem
