/* failing_driver.c - an OpenCL driver that does not survive a query for its platforms, as PoCL does not in a container
 * without /sys. FAILING_DRIVER: abort, crash, exit or hang; with any other value it has no platform. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void *clGetExtensionFunctionAddress(const char *name);

/* The function lacks the name that the loader looks up, because that is also one of the loader's own. */
static int platforms_of(unsigned entries, void **platforms, unsigned *count)
{
  const char *displacement = getenv("FAILING_DRIVER");
  (void)entries;
  (void)platforms;
  if (!displacement) displacement = "";
  if (*displacement) fprintf(stderr, "the driver fails: %s\n", displacement);
  if (!strcmp(displacement, "abort")) abort();
  if (!strcmp(displacement, "crash")) raise(SIGSEGV);
  if (!strcmp(displacement, "exit")) exit(3);
  if (!strcmp(displacement, "hang"))
    for (;;) sleep(1);
  if (count) *count = 0;
  return -1001; /* no platform */
}

static int say_nothing(void) { return -30; } /* an invalid value */

/* Loaders want both of a driver before they ask it anything. */
void *clGetExtensionFunctionAddress(const char *name)
{
  if (!strcmp(name, "clIcdGetPlatformIDsKHR")) return (void *)platforms_of;
  return !strcmp(name, "clGetPlatformInfo") ? (void *)say_nothing : NULL;
}
