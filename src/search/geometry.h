/* Ways over the table: free or not, room for the cue, mirrors at the cushions (thesis 4.6.1.1). All m, table frame. */
#ifndef BILLIARD_SEARCH_GEOMETRY_H
#define BILLIARD_SEARCH_GEOMETRY_H

#include <stdint.h>

#include "search/plan.h"

enum { MIRROR_MAX = 8, MIRROR_SPANS = 4, SEQUENCE_MAX = 1 + MIRROR_MAX + MIRROR_MAX * 7 + MIRROR_MAX * 7 * 7 };

/* One side of the bed, seen by a ball's centre: the noses shifted by a radius. Cushions in one line are one mirror. */
struct mirror {
	vec2 point, normal;	      /* a point of the shifted line; unit, into the bed */
	vec2 along;		      /* vec2_perp(normal) */
	double span[MIRROR_SPANS][2]; /* where there is a nose, along vec2_perp(normal) */
	int span_count;
};

/* Cushions in a row, as a tree that grows from the target: a ball meets mirror first and then those of parent. 0 is the
 * direct way. */
struct sequence {
	uint16_t parent;
	uint8_t mirror, length;
};

struct mirrors {
	struct mirror mirror[MIRROR_MAX];
	int count;
	struct sequence sequence[SEQUENCE_MAX];
	int sequence_count[PLAN_RAILS_MAX + 1]; /* sequences of at most that many cushions */
};

/* Takes the main rails of a finished table. */
void mirrors_init(struct mirrors *mirrors, const struct table *table);

/* Images of a target and of a direction there, for each sequence of at most rails cushions. */
struct images {
	vec2 at[SEQUENCE_MAX], direction[SEQUENCE_MAX];
	double behind[SEQUENCE_MAX]; /* m, how far at lies behind the mirror that is met first */
	bool valid[SEQUENCE_MAX];    /* false: out of the definition domain (4.14 to 4.18) */
	int count;
};
void images_init(struct images *images, const struct mirrors *mirrors, vec2 target, vec2 direction, int rails);

/* A way of one ball: start, cushion contacts, end. */
struct way {
	vec2 point[PLAN_RAILS_MAX + 2];
	double leg[PLAN_RAILS_MAX + 1]; /* m */
	vec2 normal[PLAN_RAILS_MAX];	/* of the cushions met */
	int rails;
};
/* From start to the images' target over a sequence. False when a contact lies beside the nose or behind the ball. */
bool way_build(struct way *way, const struct mirrors *mirrors, const struct images *images, int sequence, vec2 start);

/* Squared distance of p from the segment a b. */
double segment_distance2(vec2 a, vec2 b, vec2 p);

/* Balls that may be in the way: those on the table whose bit is set. Borrowed. */
struct obstacles {
	const struct ball *ball;
	int count;
	uint32_t mask;
};

/* None of them within distance of the segment a b. */
bool segment_is_free(const struct obstacles *obstacles, vec2 a, vec2 b, double distance);

/* 4.19: room behind the cue ball at cue for a shot in that (unit) direction. */
bool cue_has_room(const struct table *table, const struct cost_profile *profile, const struct obstacles *obstacles,
		  vec2 cue, vec2 direction);

#endif
