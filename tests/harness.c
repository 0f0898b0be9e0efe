#include "harness.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

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

const char *test_data_folder(const char *test)
{
	const char *folder = getenv("DATA");
	if (!folder)
		folder = DATA;
	if (access(folder, R_OK) == 0)
		return folder;
	printf("%s: SKIPPED, no data at %s\n", test, folder);
	fflush(stdout);
	return NULL;
}

int main(int argc, char **argv)
{
	if (argc > 1)
		setenv("CK_RUN_CASE", argv[1], 1);
	SRunner *runner = srunner_create(test_suite());
	srunner_run_all(runner, CK_NORMAL);
	int failed = srunner_ntests_failed(runner);
	srunner_free(runner);
	return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
