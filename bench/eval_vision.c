/* Accuracy of the vision on the recorded photographs and videos and on rendered frames, each number beside its bar. */
#include <stdio.h>
#include <stdlib.h>

#include "vision_eval.h"

int main(int argc, char **argv)
{
	static struct config config;
	char err[640];
	if (argc != 3) {
		fprintf(stderr, "usage: %s BUILD DATA\n", argv[0]);
		return 2;
	}
	if (config_load(&config, "config/thesis-table.conf", err, sizeof(err)) < 0) {
		fprintf(stderr, "%s\n", err);
		return 1;
	}
	struct report *report = report_open(argv[1], "eval.json");
	eval_photos(report, &config, argv[1], argv[2]);
	eval_videos(report, &config, argv[2]);
	eval_rendered(report, &config);
	return report_close(report) < 0;
}
