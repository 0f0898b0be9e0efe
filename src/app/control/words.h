/* What the table says in a word when it does not count as at rest. */
#ifndef BILLIARD_APP_WORDS_H
#define BILLIARD_APP_WORDS_H

#include "app/control/stability.h"
#include "lcmtypes/billiard_stability_condition_t.h"
#include "lcmtypes/billiard_table_state_t.h"
#include "lcmtypes/billiard_vision_doubt_t.h"

enum { WORDS_SIZE = 96 };

/* "RED at (300, 200): hidden", mm. */
void words_of_ball(char out[WORDS_SIZE], const struct ball *ball, const char *what);
/* Why the table cannot be seen. */
void words_of_blindness(char out[WORDS_SIZE], const billiard_table_state_t *state);
/* Which condition fails, and for which ball. layout, view: of the frame that s judged last; doubt: vision's of it. */
void words_of_obstacle(char out[WORDS_SIZE], const struct stability *s, const struct layout *layout,
		       const struct stability_view *view, const billiard_vision_doubt_t *doubt);
/* The same in numbers: what became of each condition. layout: as judged. */
void words_report(billiard_stability_condition_t out[STABILITY_CONDITIONS], const struct stability *s,
		  const struct layout *layout);

#endif
