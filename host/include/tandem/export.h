/* export.h - marks what the shared libraries export.
 *
 * They export what the public headers declare, and what Tandem::io and Tandem::verify need of the libraries below them.
 * Everything else is hidden, so that internal names cannot collide with those of a program, and no program depends on
 * them.
 */
#pragma once

#if defined(__GNUC__)
#define TANDEM_API __attribute__((visibility("default")))
#else
#define TANDEM_API
#endif
