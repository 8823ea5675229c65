/* debug.cpp - see debug.h. */
#include "host/debug.h"

namespace tandem {

volatile uint64_t current_step = 0;

} // namespace tandem
