/* features.h - the rows of features.def as bits, and the test that kernels make of them.
 *
 * In OpenCL the mask is the compile-time constant FEATURES (-D FEATURES=...), so what a scene does
 * not need costs nothing. MiniCL is compiled ahead, so it reads the mask from the parameters; with
 * every bit set both give the bits of the specialised build (tests/parity/specialised_test.cpp). */
#ifndef TANDEM_SHARED_FEATURES_H
#define TANDEM_SHARED_FEATURES_H

enum {
#define FEATURE(name, what) FEATURE_INDEX_##name,
#include "shared/features.def"
#undef FEATURE
  FEATURE_COUNT
};

enum {
#define FEATURE(name, what) FEATURE_##name = 1 << FEATURE_INDEX_##name,
#include "shared/features.def"
#undef FEATURE
  FEATURE_ALWAYS = 0
};

#ifdef FEATURES
#define HAS_FEATURE(parameters, bit) (((FEATURES) & (uint)(bit)) != 0u)
/* For what cannot be true of a scene without the feature: a compiler of devices then leaves it out. The shape of a
 * query need not be one of the scene's. */
#ifdef ASKED_ABOUT_ANY_SHAPE
#define MAY_OCCUR(bit) (((FEATURES) & (uint)(bit)) != 0u || ((bit) & (FEATURE_HULL | FEATURE_ROUND)) != 0)
#else
#define MAY_OCCUR(bit) (((FEATURES) & (uint)(bit)) != 0u)
#endif
#else
#define HAS_FEATURE(parameters, bit) (((parameters)->features & (uint)(bit)) != 0u)
#define MAY_OCCUR(bit) 1
#endif

#endif
