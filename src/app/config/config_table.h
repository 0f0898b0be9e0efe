/* The keys of a configuration file, and what its reader fills before config.c turns it into a struct config. */
#ifndef BILLIARD_APP_CONFIG_TABLE_H
#define BILLIARD_APP_CONFIG_TABLE_H

#include "app/config/config.h"
#include "app/config/config_reader.h"

struct config_file {
	struct config config;
	char profile[16];     /* name of the chosen one */
	char scheme[16];      /* of the planner */
	double nose_height;   /* m, one for all cushions and jaws */
	double topspin_speed; /* m/s, factor A of variant 1 */
	double topspin_share; /* factor A of variant 2 */
	int memory_mib;
	double still_frames; /* older files: frames at 30 a second instead of still_time; 0: not there */
};

/* A whole file with every key that has no fallback of its own: the values of what another file leaves out. */
extern const char config_default_text[];

/* Offsets are from the start of struct config_file. */
extern const struct config_key config_keys[];

#endif
