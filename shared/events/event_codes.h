/* event_codes.h - the kinds of events, for kernels and the host. */
#ifndef TANDEM_SHARED_EVENTS_EVENT_CODES_H
#define TANDEM_SHARED_EVENTS_EVENT_CODES_H

enum { EVENT_BEGIN = 0, EVENT_PERSIST = 1, EVENT_END = 2, EVENT_NONE = 3 };

#endif
