/* debug.cpp - the variable of debug.h that conditions of breakpoints read. */
#include "host/runtime/interface/debug.h"

namespace tandem {

constinit thread_local volatile uint64_t step_of_launch = 0;

} // namespace tandem
