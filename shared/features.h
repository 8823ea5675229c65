/* features.h - the rows of features.def as bits of a mask, and the tests of that mask in kernels.
 *
 * C99 has no enumeration constant beyond an int, so a feature is the index of its bit here, and the tests take its bare
 * name: HAS_FEATURE(parameters, TREES). The host's constants of the whole mask are in
 * host/runtime/interface/features.h.
 *
 * In OpenCL the mask is the compile-time constant FEATURES (-D FEATURES=...), so features that a scene lacks cost
 * nothing. MiniCL is compiled ahead of time and reads the mask from the parameters. Both give the same bits
 * (tests/parity/specialised_test.cpp). */
#ifndef TANDEM_SHARED_FEATURES_H
#define TANDEM_SHARED_FEATURES_H

enum {
#define FEATURE(name, what) FEATURE_INDEX_##name,
#include "shared/features.def"
#undef FEATURE
  FEATURE_COUNT
};

/* mask: 64 bits, unsigned. */
#define HAS_BIT(mask, index) ((((mask) >> (index)) & 1u) != 0u)

#ifdef FEATURES
#define IS_BUILT(index) HAS_BIT((ulong)(FEATURES), index)
#define HAS_FEATURE(parameters, name) IS_BUILT(FEATURE_INDEX_##name)
/* MAY_OCCUR(bit) is false where the scene lacks the feature, so that the compiler of a device drops the code. Hulls and
 * round shapes may occur in queries of any scene, because the shape of a query need not be one of the scene's. */
#ifdef ASKED_ABOUT_ANY_SHAPE
#define MAY_OCCUR(name)                                                            \
  (IS_BUILT(FEATURE_INDEX_##name) || FEATURE_INDEX_##name == FEATURE_INDEX_HULL || \
   FEATURE_INDEX_##name == FEATURE_INDEX_ROUND)
#else
#define MAY_OCCUR(name) IS_BUILT(FEATURE_INDEX_##name)
#endif
#else
#define HAS_FEATURE(parameters, name) HAS_BIT((parameters)->features, FEATURE_INDEX_##name)
#define MAY_OCCUR(name) 1
#endif

#endif
