/* built_features.cpp - the features that MiniCL is compiled for; see built_features.h. It stands beside the kernels,
 * which are the only other sources that the option changes. */
#include "host/runtime/interface/built_features.h"

#include "host/runtime/interface/features.h"
#ifdef TANDEM_SOME_FEATURES
#include "built/features.h"
#else
#define BUILT_OPTION ""
#define BUILT_FEATURES (~Features{0} >> (64 - FEATURE_COUNT))
#endif

namespace tandem {

Features built_features() { return BUILT_FEATURES; }

const char *built_option() { return BUILT_OPTION; }

} // namespace tandem
