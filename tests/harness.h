/* What every test program shares: main() runs the suite that the file defines; a name filter; a printed seed. */
#ifndef BILLIARD_TESTS_HARNESS_H
#define BILLIARD_TESTS_HARNESS_H

#include <check.h>
#include <stdint.h>

/* Defined by each test file. */
Suite *test_suite(void);

/* Random numbers: splitmix64. The seed is BILLIARD_TEST_SEED or a fixed one, and is printed when first used. */
struct random {
	uint64_t state;
};
struct random random_begin(const char *test);
uint64_t random_u64(struct random *r);
/* Uniform in [low, high). */
double random_in(struct random *r, double low, double high);

/* Folder of the real recordings, or NULL after a printed notice that the test is skipped. */
const char *test_data_folder(const char *test);

#endif
