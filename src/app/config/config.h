/* The configuration of one table: config/NAME.conf (libconfig). Every key has a unit and a range; the whole file is
 * checked. */
#ifndef BILLIARD_APP_CONFIG_H
#define BILLIARD_APP_CONFIG_H

#include "physics/model.h"
#include "physics/table.h"
#include "search/plan.h"
#include "vision/camera.h"
#include "vision/vision.h"

enum { CONFIG_PATH_MAX = 256, CONFIG_SERVICE_MAX = 8, CONFIG_PROFILE_MAX = 8 };

/* Planner service and defaults of its requests. */
struct config_planner {
	int workers;   /* 0: cores - 1, at least 1 */
	size_t memory; /* bytes */
	int depth, rails, balls, speeds, plans;
	uint64_t budget_nodes; /* of a request by infinity; 0 none */
	double budget;	       /* s; 0 none */
	enum plan_scheme scheme;
	double sync_period, sync_window; /* s, k and n of thesis 4.7; n 0: as long as fits */
};

/* Controller. */
struct config_infinity {
	double still_distance; /* m a ball may move and still rest */
	double still_time;     /* s in which nothing moved */
	double cue_distance;   /* m, of two white balls the cue ball is the one within this of where it was */
	double cue_time;       /* s the cue ball was tracked */
	double lost_time;      /* s no ball was lost */
	double new_time;       /* s no ball was new */
	double clear_time;     /* s nothing was hidden or in doubt */
	double moving_time;    /* s a ball is away from its place until it counts as moving */
	double blind_time;     /* s without calibration or cue ball until the table counts as lost */
	double nudge_distance; /* m a ball must lie elsewhere for a new proposal */
	double tell_time;      /* s until the table says why it does not count as at rest */
	double silence_time;   /* s without a frame, or an answer of the planner, until the table says so */
	double show_time;      /* s a proposal that is not final must be the same to be shown */
	double better_margin;  /* share of its cost by which another must be better to replace it */
	char game_file
		[CONFIG_PATH_MAX]; /* the game is kept there over a restart; empty: $STATE_DIRECTORY/game, or nowhere */
	bool rules;		   /* by the rules of snooker; false: any ball (thesis' infinity mode) */
	double plan_timeout;	   /* s without an answer until the request is repeated */
	double animation_rate;	   /* 1 real time */
	double animation_pause;	   /* s */
};

/* Projector: where table points land on its picture. */
struct config_projector {
	int width, height;    /* px */
	double homography[9]; /* table m (x, y, 1) to px, row by row */
	bool fullscreen;
	char font[64];
};

/* Sensor faults of the virtual table, in the order of enum sensor_fault. */
enum { VIRTUAL_FAULT_COUNT = 11 };

/* Virtual table: light, noise, player. */
struct config_virtual {
	double noise;		/* 1 sigma of the sensor, grey levels */
	double exposure;	/* 1 normal */
	double projector_light; /* share of full white that the projector adds to the cloth */
	double frame_rate;	/* 1/s */
	double error_angle;	/* rad, 1 sigma of the player */
	double error_speed;	/* share, 1 sigma */
	uint64_t seed;
	double time_scale;		     /* 1 real time, 5 five times as fast */
	double think_time;		     /* s the player looks at a proposal before playing */
	double camera_height;		     /* m above the markers' plane */
	double camera_x, camera_y;	     /* m, point below the camera, table frame */
	double camera_tilt_x, camera_tilt_y; /* rad */
	int jpeg_quality;		     /* 1..100 */
	double exposure_time;		     /* s: what moves is blurred by its way in that time */
	double shutter_time;		     /* s from the first row's exposure to the last one's; 0: all at once */
	struct {
		double aim_time;   /* s with arm and cue over the table before the strike; 0: nobody is seen */
		double leave_time; /* s until they have gone after it */
		double place_time; /* s a hand takes to put down a ball that comes back; 0: it is just there */
		double patience;   /* s without a proposal until the player plays a shot of his own; 0: never */
		/* Shares: of shots that are others than proposed, of shots with a second one right after, of rests in which a ball is
		 * touched, the cloth wiped, an arm left lying. */
		double other, quick, touch, wipe, linger;
	} habit;
	double fault[VIRTUAL_FAULT_COUNT][2]; /* sensor_faults.h: times a minute, s of each */
	/* The table of the player where it is another than the planner believes: shares of rolling friction and of what the cushions give back,
	 * and a slope on top of the table's own (rise per way). */
	double cloth, bounce, tilt[2];
};

struct config_service {
	char name[24];	     /* "billiard-vision", ... */
	char arguments[128]; /* added to the command line */
	bool enabled;
};

struct config {
	char path[CONFIG_PATH_MAX]; /* the file it came from */
	char name[32];
	struct table table;
	struct model model; /* what is shown */
	char model_name[24];
	struct cost_profile profiles[CONFIG_PROFILE_MAX];
	int profile_count;
	struct cost_profile profile; /* the chosen one of profiles */
	struct camera_intrinsics camera;
	struct marker_layout markers;
	char colours[CONFIG_PATH_MAX];	   /* colour parameters; in the file relative to it, here to be opened */
	char source[CONFIG_PATH_MAX];	   /* frame source of billiard-vision */
	double camera_rate;		   /* CAMERA messages per second, 0 none */
	double marker_interval, pose_keep; /* s */
	char bus[128];			   /* LCM URL; LCM_DEFAULT_URL overrides */
	struct config_planner planner;
	struct config_infinity infinity;
	struct config_projector projector;
	struct config_virtual virtual_table;
	struct config_service service[CONFIG_SERVICE_MAX];
	int service_count;
};

/* Reads and checks a file. 0, or a negative errno and "file:line: key: found ..., allowed ..." in err; *config is
 * untouched on failure. (Not "config_read": libconfig exports that name.) */
int config_load(struct config *config, const char *path, char *err, size_t err_size);

/* Profile of that name among config->profiles, NULL when there is none. */
const struct cost_profile *config_profile(const struct config *config, const char *name);

/* What a struct vision of this table is created from; borrows config and colours. */
struct vision_def config_vision_def(const struct config *config, const struct colour_model *colours);

/* Path used when no -c is given: $BILLIARD_CONF, ./config/thesis-table.conf, then the installed one. Never NULL. */
const char *config_default_path(void);

#endif
