/* What the source files of `billiard judge` share. */
#ifndef BILLIARD_APP_CMD_JUDGE_H
#define BILLIARD_APP_CMD_JUDGE_H

#include "app/config/config.h"

struct judge_options {
	const char *config, *bus; /* borrowed from argv; bus NULL: the configuration's */
	const char *out;	  /* folder for replays of wrong rests, NULL none */
	double keep;		  /* s of each that are kept */
	double seconds;		  /* s that --live listens, 0 until it is stopped */
	double shots;		  /* that --live waits for, 0 any number */
	bool json, live, replay;
};

/* Plays the CAMERA messages of each log to a fresh billiard-vision on a bus of its own; prints how what it saw at the end
 * differs from the log's last TRUTH. Exit status. */
int cmd_judge_replay(const struct config *config, const struct judge_options *options, int count, char **path);

/* Judges each log, a line each. Exit status. */
int cmd_judge_logs(const struct config *config, const struct judge_options *options, int count, char **path);
/* Judges what is on the bus until it is stopped. Exit status. */
int cmd_judge_live(const struct config *config, const struct judge_options *options);

#endif
