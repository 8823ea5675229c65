/* features.h - the rows of features.def as bits of a mask, and the tests of that mask in kernels.
 *
 * C99 has no enumeration constant beyond an int, so a feature is the index of its bit here, and the tests take its bare
 * name: HAS_FEATURE(parameters, TREES). The host's constants of the whole mask are in
 * host/runtime/interface/features.h.
 *
 * In OpenCL the mask is the compile-time constant FEATURES (-D FEATURES=...), so features that a scene lacks cost
 * nothing. MiniCL is compiled ahead of time and reads the mask from the parameters. A library that is configured for
 * some features has the constant BUILT_FEATURES too, and others cost nothing there (cmake/Features.cmake). All give the
 * same bits (tests/parity/specialised_test.cpp, tests/features). */
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

#if defined(FEATURES)
#define IS_BUILT(index) HAS_BIT((ulong)(FEATURES), index)
#define HAS_FEATURE(parameters, name) IS_BUILT(FEATURE_INDEX_##name)
#elif defined(BUILT_FEATURES)
#define IS_BUILT(index) HAS_BIT((ulong)(BUILT_FEATURES), index)
#define HAS_FEATURE(parameters, name) \
  (IS_BUILT(FEATURE_INDEX_##name) && HAS_BIT((parameters)->features, FEATURE_INDEX_##name))
#else
#define IS_BUILT(index) 1
#define HAS_FEATURE(parameters, name) HAS_BIT((parameters)->features, FEATURE_INDEX_##name)
#endif

/* MAY_OCCUR(name) is false where no scene has the feature, so that the compiler drops the code. Hulls and round shapes
 * may occur in queries of any scene, because the shape of a query need not be one of the scene's. */
#ifdef ASKED_ABOUT_ANY_SHAPE
#define MAY_OCCUR(name)                                                            \
  (IS_BUILT(FEATURE_INDEX_##name) || FEATURE_INDEX_##name == FEATURE_INDEX_HULL || \
   FEATURE_INDEX_##name == FEATURE_INDEX_ROUND)
#else
#define MAY_OCCUR(name) IS_BUILT(FEATURE_INDEX_##name)
#endif

#endif
