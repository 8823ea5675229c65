/* failing_threads.c - a library to preload, which starts THREADS_THAT_START threads and fails for each one after
 * them. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

typedef int Start(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*routine)(void *), void *argument)
{
  static atomic_int started;
  const char *granted = getenv("THREADS_THAT_START");
  Start *start = NULL;
  if (granted && atomic_fetch_add(&started, 1) >= atoi(granted)) return EAGAIN;
  *(void **)&start = dlsym(RTLD_NEXT, "pthread_create");
  return start(thread, attributes, routine, argument);
}
