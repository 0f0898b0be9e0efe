#include "app/light/lease.h"

#include <math.h>

#include "app/light/draw.h"

static const double TEXT_HEIGHT = 0.05, TEXT_BELOW = 0.09; /* m */
static const uint32_t TEXT_RGBA = 0xffffffff;
static const char NOTICE[] = "billiard-infinity is silent";

void lease_picture(struct lease *lease, int64_t seq, double now)
{
	lease->seq = seq;
	lease->until = now + lease->seconds;
}

void lease_take(struct lease *lease, const billiard_lease_t *message, double now)
{
	/* The first one begins the picture's time, whichever it is for: before it nothing ran out. */
	if (!lease->known || message->seq == lease->seq)
		lease->until = now + message->seconds;
	lease->known = true;
	lease->seconds = message->seconds;
}

bool lease_is_over(const struct lease *lease, double now)
{
	return lease->known && now > lease->until;
}

void lease_notice(billiard_draw_list_t *list, double width)
{
	draw_clear(list);
	vec2 at = {-draw_text_width(NOTICE, TEXT_HEIGHT) / 2, -width / 2 - TEXT_BELOW};
	draw_text(list, at, TEXT_HEIGHT, TEXT_RGBA, NOTICE);
}
