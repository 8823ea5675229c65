/* nncg_state.h - indices in the buffer nncg_state, for rows of contacts (solve/nncg.h) and joints (joints/nncg.h). */
#ifndef TANDEM_SHARED_SOLVE_NNCG_STATE_H
#define TANDEM_SHARED_SOLVE_NNCG_STATE_H

enum { NNCG_SUM_BEFORE, NNCG_BETA };

#endif
