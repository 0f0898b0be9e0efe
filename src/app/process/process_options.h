/* The command line of the services. */
#ifndef BILLIARD_APP_PROCESS_OPTIONS_H
#define BILLIARD_APP_PROCESS_OPTIONS_H

/* Command line shared by the services. */
struct process_options {
	const char *config;   /* -c FILE; the default path when not given; borrowed from argv */
	const char *bus;      /* --bus URL, NULL: LCM_DEFAULT_URL or the configuration's */
	const char *source;   /* --source, billiard-vision only; NULL: the configuration's */
	double hold;	      /* --hold, billiard-vision only: s each photograph of a folder is shown */
	const char *position; /* --position, billiard-table only; NULL: the opening position of snooker */
};

/* Parses argv (getopt_long). 0; 1 when --help or --version answered (exit 0); -EINVAL after one line on stderr (exit 2). */
int process_parse(struct process_options *out, const char *name, int argc, char **argv);

#endif
