/* order_codes.h - in which order contacts are set up where a world chooses its substeps, and what is done besides.
 *
 * The host launches prepare_and_weigh_contacts (standing.h) with a sum of these. */
#ifndef TANDEM_SHARED_SETUP_ORDER_CODES_H
#define TANDEM_SHARED_SETUP_ORDER_CODES_H

/* ORDER_BY_PAIR: items are pairs, as by_pair of prepare_contacts has it. ORDER_WEIGHS: contacts pass on what stands on
 * them. */
enum { ORDER_BY_PAIR = 1, ORDER_WEIGHS = 2 };

#endif
