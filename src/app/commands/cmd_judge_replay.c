/* billiard judge --replay: a fresh vision looks at recorded frames. */
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/commands/cmd.h"
#include "app/commands/cmd_judge.h"
#include "app/process/bus.h"
#include "app/process/event_log.h"
#include "app/process/private_bus.h"
#include "app/process/clock.h"
#include "app/virtual/judge_match.h"

static const double START_TIME = 20; /* s that vision may take until it says that it is there */
static const double FRAME_TIME = 2;  /* s it may take for a frame; it is sent again once */
static const double STOP_TIME = 3;   /* s it may take to end */

struct replay {
	struct bus *bus;	      /* owned */
	pid_t vision;		      /* 0: does not run */
	billiard_table_state_t seen;  /* the newest answer to a frame */
	billiard_table_state_t truth; /* the log's last one */
	billiard_image_t frame;	      /* decoded, the frame in play; owned */
	int64_t asked;		      /* us, time of the frame that is waited for */
	bool has_truth, is_there, answered;
	int frames, lost; /* lost: frames that vision gave no answer to */
};

/* ---- what comes back ------------------------------------------------------------------------------------------------ */

static bool on_state(void *context, const void *message)
{
	struct replay *r = context;
	const billiard_table_state_t *state = message;
	if (state->utime != r->asked || r->asked == 0)
		return true;
	r->seen = *state;
	r->answered = true;
	return true;
}

static bool on_status(void *context, const void *message)
{
	struct replay *r = context;
	const billiard_status_t *status = message;
	r->is_there |= strncmp((const char *)status->process, "billiard-vision", sizeof status->process) == 0;
	return true;
}

/* Lets the bus speak until *done. False after that many seconds, or when vision has ended. */
static bool wait_for(struct replay *r, const bool *done, double seconds)
{
	double until = clock_seconds() + seconds;
	while (!*done && clock_seconds() < until) {
		struct pollfd fd = {.fd = bus_descriptor(r->bus), .events = POLLIN};
		if (poll(&fd, 1, 50) > 0 && bus_drain(r->bus) < 0)
			return false;
		if (waitpid(r->vision, NULL, WNOHANG) == r->vision) {
			r->vision = 0;
			return false;
		}
	}
	return *done;
}

/* ---- vision --------------------------------------------------------------------------------------------------------- */

/* Signals that this process blocks must reach the child. */
static int spawn(pid_t *pid, const char *program, char *const argv[])
{
	posix_spawnattr_t attributes;
	sigset_t none;
	sigemptyset(&none);
	posix_spawnattr_init(&attributes);
	posix_spawnattr_setsigmask(&attributes, &none);
	posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
	int r = posix_spawn(pid, program, NULL, &attributes, argv, environ);
	posix_spawnattr_destroy(&attributes);
	return -r;
}

static int start_vision(struct replay *r, const struct config *config, const char *url, char *err, size_t err_size)
{
	static char name[] = "billiard-vision", conf[] = "-c", bus[] = "--bus", source[] = "--source",
		    camera[] = "lcm:CAMERA";
	char program[512], path[CONFIG_PATH_MAX], address[PRIVATE_BUS_URL_SIZE];
	ssize_t n = readlink("/proc/self/exe", program, sizeof program - sizeof name - 1);
	char *slash = n > 0 ? (program[n] = '\0', strrchr(program, '/')) : NULL;
	if (!slash) {
		snprintf(err, err_size, "billiard judge: /proc/self/exe cannot be read");
		return -ENOENT;
	}
	strcpy(slash + 1, name);
	snprintf(path, sizeof path, "%s", config->path);
	snprintf(address, sizeof address, "%s", url);
	char *const argv[] = {name, conf, path, bus, address, source, camera, NULL};
	r->is_there = false;
	int code = spawn(&r->vision, program, argv);
	if (code < 0) {
		r->vision = 0;
		snprintf(err, err_size, "%s: %s", program, strerror(-code));
		return code;
	}
	if (wait_for(r, &r->is_there, START_TIME))
		return 0;
	snprintf(err, err_size, "billiard judge: billiard-vision does not start");
	return -ETIMEDOUT;
}

static void stop_vision(struct replay *r)
{
	double until = clock_seconds() + STOP_TIME;
	if (!r->vision)
		return;
	kill(r->vision, SIGTERM);
	while (waitpid(r->vision, NULL, WNOHANG) == 0) {
		if (clock_seconds() > until)
			kill(r->vision, SIGKILL);
		usleep(10000);
	}
	r->vision = 0;
}

/* ---- a log ---------------------------------------------------------------------------------------------------------- */

static int refuse(const char *path, const char *what, char *err, size_t err_size)
{
	snprintf(err, err_size, "%s: %s", path, what);
	return -EINVAL;
}

/* One frame, and the answer to it. A lost message is nobody's fault: once more. */
static void play(struct replay *r)
{
	r->asked = r->frame.utime;
	r->answered = false;
	for (int i = 0; i < 2 && !r->answered && r->vision; i++) {
		bus_publish(r->bus, "CAMERA", &bus_image, &r->frame);
		wait_for(r, &r->answered, FRAME_TIME);
	}
	r->frames++;
	r->lost += !r->answered;
}

static int play_event(struct replay *r, const struct log_event *event, const char *path, char *err, size_t err_size)
{
	if (strcmp(event->channel, "TRUTH") == 0) {
		if (!log_event_decode(event, &bus_table_state, &r->truth))
			return refuse(path, "TRUTH is malformed or of another version", err, err_size);
		r->has_truth = true;
	}
	if (strcmp(event->channel, "CAMERA") == 0) {
		if (!log_event_decode(event, &bus_image, &r->frame))
			return refuse(path, "CAMERA is malformed or of another version", err, err_size);
		play(r);
		bus_image.cleanup(&r->frame);
	}
	return 0;
}

static int play_log(struct replay *r, const char *path, char *err, size_t err_size)
{
	struct event_log *log;
	struct log_event event;
	int code = event_log_open(&log, path, err, err_size);
	if (code < 0)
		return code;
	while ((code = event_log_next(log, &event, err, err_size)) > 0)
		if ((code = play_event(r, &event, path, err, err_size)) < 0)
			break;
	event_log_close(log);
	if (code == 0 && (!r->has_truth || r->frames == 0))
		code = refuse(path, r->frames ? "holds no TRUTH" : "holds no CAMERA", err, err_size);
	return code;
}

/* Vision is started for logs that can be read only. */
static int check_log(const char *path, char *err, size_t err_size)
{
	struct event_log *log;
	struct log_event event;
	bool camera = false;
	int code = event_log_open(&log, path, err, err_size);
	if (code < 0)
		return code;
	while ((code = event_log_next(log, &event, err, err_size)) > 0)
		camera |= strcmp(event.channel, "CAMERA") == 0;
	event_log_close(log);
	return code == 0 && !camera ? refuse(path, "holds no CAMERA", err, err_size) : code;
}

/* ---- what is said --------------------------------------------------------------------------------------------------- */

static int report(const struct replay *r, const char *path, const struct config *config, bool json)
{
	struct judge_position real, seen;
	struct judge_match match;
	judge_position_from(&real, r->truth.balls, r->truth.ball_count);
	judge_position_from(&seen, r->seen.balls, r->seen.calibration != 0 ? r->seen.ball_count : 0);
	judge_match(&real, &seen, 2 * config->table.ball_radius, &match);
	double error = 1e3 * match.max_error;
	if (!json) {
		printf("%s: %d balls, %d missing, %d extra, %d of another colour, worst %.2f mm (%d frames, %d lost)\n",
		       path, real.count, match.missing, match.extra, match.colour_wrong, error, r->frames, r->lost);
		return CMD_OK;
	}
	return cmd_json_line(json_pack("{s:s,s:i,s:i,s:i,s:i,s:f,s:b,s:i,s:i}", "log", path, "balls", real.count,
				       "missing", match.missing, "extra", match.extra, "colour_wrong",
				       match.colour_wrong, "max_error_mm", error, "calibrated",
				       r->seen.calibration != 0, "frames", r->frames, "frames_lost", r->lost));
}

static int judge_one(const struct config *config, const struct judge_options *options, const char *url,
		     const char *path)
{
	char err[CMD_ERROR_SIZE];
	struct replay r = {0};
	if (check_log(path, err, sizeof err) < 0)
		return cmd_bad_input("%s", err);
	int code = bus_open(&r.bus, url, err, sizeof err), status = CMD_FAILED;
	code = code < 0 ? code
			: bus_subscribe(r.bus, &(struct bus_subscription){"TABLE_STATE", &bus_table_state, BUS_EACH,
									  on_state, &r});
	code = code < 0 ? code
			: bus_subscribe(r.bus,
					&(struct bus_subscription){"STATUS", &bus_status, BUS_EACH, on_status, &r});
	code = code < 0 ? code : start_vision(&r, config, url, err, sizeof err);
	if (code == 0) {
		code = play_log(&r, path, err, sizeof err);
		status = code < 0 ? CMD_BAD_INPUT : report(&r, path, config, options->json);
	}
	if (code < 0)
		fprintf(stderr, "%s\n", err);
	stop_vision(&r);
	bus_close(r.bus);
	return status;
}

int cmd_judge_replay(const struct config *config, const struct judge_options *options, int count, char **path)
{
	char url[PRIVATE_BUS_URL_SIZE];
	int worst = CMD_OK;
	private_bus(url, sizeof url);
	for (int i = 0; i < count; i++) {
		int status = judge_one(config, options, url, path[i]);
		worst = status > worst ? status : worst;
		fflush(stdout);
	}
	return worst;
}
