/* export.h - marks what the shared libraries export.
 *
 * That is what the public headers declare, and what Tandem::io and Tandem::verify need of the libraries below them. All
 * else is hidden: names inside the library can neither collide with a program's nor be relied on.
 */
#pragma once

#if defined(__GNUC__)
#define TANDEM_API __attribute__((visibility("default")))
#else
#define TANDEM_API
#endif
