#include "harness.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

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
