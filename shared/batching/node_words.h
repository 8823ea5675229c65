/* node_words.h - the words of body_link, for kernels and the host. */
#ifndef TANDEM_SHARED_BATCHING_NODE_WORDS_H
#define TANDEM_SHARED_BATCHING_NODE_WORDS_H

/* The node of the graph of contacts, the articulation (INDEX_NONE: none), and the number of the link. */
enum { LINK_WORDS = 3 };

#endif
