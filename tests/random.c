#include "harness.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

struct random random_begin(const char *test)
{
	const char *text = getenv("BILLIARD_TEST_SEED");
	uint64_t seed = text ? strtoull(text, NULL, 0) : 20211221;
	printf("%s: seed %" PRIu64 "\n", test, seed);
	fflush(stdout);
	return (struct random){seed};
}

uint64_t random_u64(struct random *r)
{
	uint64_t z = (r->state += 0x9e3779b97f4a7c15u);
	z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
	z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
	return z ^ (z >> 31);
}

double random_in(struct random *r, double low, double high)
{
	return low + (high - low) * ((double)(random_u64(r) >> 11) * 0x1p-53);
}
