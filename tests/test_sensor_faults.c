#include "app/virtual/sensor_faults.h"

#include "harness.h"

static struct sensor_faults faults;
static struct config_virtual def;

static void set_up(void)
{
	def = (struct config_virtual){.seed = 5};
}

START_TEST(without_rates_nothing_is_wrong)
{
	sensor_faults_init(&faults, &def, 0);
	for (uint64_t frame = 0; frame < 10000; frame++) {
		double now = (double)frame / 30;
		sensor_faults_frame(&faults, frame, now);
		for (int i = 0; i < SENSOR_FAULT_COUNT; i++)
			ck_assert(!sensor_faults_hold(&faults, (enum sensor_fault)i, now));
	}
}
END_TEST

/* As often and as long as asked for, at any frame rate. */
START_TEST(rates_and_lengths_are_kept)
{
	const double fps[] = {15, 60};
	for (int k = 0; k < 2; k++) {
		def.fault[FAULT_DARK][0] = 6;
		def.fault[FAULT_DARK][1] = 0.5;
		sensor_faults_init(&faults, &def, 0);
		int held = 0, frames = (int)(36000 * fps[k] / 10);
		for (int frame = 0; frame < frames; frame++) {
			double now = frame / fps[k];
			sensor_faults_frame(&faults, (uint64_t)frame, now);
			held += sensor_faults_hold(&faults, FAULT_DARK, now);
			ck_assert(!sensor_faults_hold(&faults, FAULT_DROP, now));
		}
		/* 360 in an hour, each half a second and the frame it begins with */
		ck_assert_double_eq_tol((double)faults.number[FAULT_DARK], 360, 60);
		ck_assert_double_eq_tol(held / fps[k], 360 * (0.5 + 0.5 / fps[k]), 36);
	}
}
END_TEST

START_TEST(a_command_begins_one)
{
	sensor_faults_init(&faults, &def, 10);
	ck_assert(sensor_faults_command(&faults, "drop 0.5", 10));
	ck_assert(sensor_faults_hold(&faults, FAULT_DROP, 10.4));
	ck_assert(!sensor_faults_hold(&faults, FAULT_DROP, 10.6));
	ck_assert(!sensor_faults_hold(&faults, FAULT_FREEZE, 10.4));
	static const char *const bad[] = {"", "drop", "drop x", "drop -1", "drop 1e9", "drop nan", "earthquake 1"};
	for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
		ck_assert(!sensor_faults_command(&faults, bad[i], 20));
	uint64_t first = sensor_faults_random(&faults, FAULT_GHOST);
	ck_assert(first == sensor_faults_random(&faults, FAULT_GHOST));
	ck_assert(sensor_faults_command(&faults, "ghost 1", 30));
	ck_assert(first != sensor_faults_random(&faults, FAULT_GHOST));
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("sensor_faults");
	TCase *tcase = tcase_create("faults");
	tcase_add_checked_fixture(tcase, set_up, NULL);
	tcase_add_test(tcase, without_rates_nothing_is_wrong);
	tcase_add_test(tcase, rates_and_lengths_are_kept);
	tcase_add_test(tcase, a_command_begins_one);
	suite_add_tcase(suite, tcase);
	return suite;
}
