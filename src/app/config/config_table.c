#include "app/config/config_table.h"

/* Every key with its unit and range in one row; docs/configuration.md and the files in config/ say the same in
 * words. */
/* A table is read by its columns. */
/* clang-format off */

#define AT(member)	 offsetof(struct config_file, member)
#define IN(type, member) offsetof(struct type, member)

#define RANGE(low, high) .min = low, .max = high
#define NUMBER(key, unit_, low, high, at)                                                                              \
	{                                                                                                              \
		.name = key, .type = CONFIG_NUMBER, .unit = unit_, .offset = at, RANGE(low, high)                      \
	}
#define WHOLE(key, unit_, low, high, at)                                                                               \
	{                                                                                                              \
		.name = key, .type = CONFIG_WHOLE, .unit = unit_, .offset = at, RANGE(low, high)                       \
	}
#define COUNT(key, low, high, at)                                                                                      \
	{                                                                                                              \
		.name = key, .type = CONFIG_COUNT64, .offset = at, RANGE(low, high)                                    \
	}
#define FLAG(key, at)                                                                                                  \
	{                                                                                                              \
		.name = key, .type = CONFIG_FLAG, .offset = at                                                         \
	}
#define TEXT(key, low, high, at)                                                                                       \
	{                                                                                                              \
		.name = key, .type = CONFIG_TEXT, .offset = at, RANGE(low, high), .size = (high) + 1                   \
	}
#define CHOICE(key, names, at)                                                                                         \
	{                                                                                                              \
		.name = key, .type = CONFIG_CHOICE, .offset = at, .choices = names                                     \
	}
#define NUMBERS(key, n, unit_, low, high, at)                                                                          \
	{                                                                                                              \
		.name = key, .type = CONFIG_NUMBERS, .unit = unit_, .offset = at, RANGE(low, high), .size = n          \
	}
/* The same with a value for files that do not have the key. */
#define NUMBER_OR(fallback_, key, unit_, low, high, at)                                                                \
	{                                                                                                              \
		.name = key, .type = CONFIG_NUMBER, .unit = unit_, .offset = at, RANGE(low, high), .optional = true,   \
		.fallback = fallback_                                                                                  \
	}
#define NUMBERS_OR(fallback_, key, n, unit_, low, high, at)                                                            \
	{                                                                                                              \
		.name = key, .type = CONFIG_NUMBERS, .unit = unit_, .offset = at, RANGE(low, high), .size = n,         \
		.optional = true, .fallback = fallback_                                                                \
	}
#define POINT(key, at) NUMBERS(key, 2, UNIT_MM, -5000, 5000, at)
#define SECTION(key, table)                                                                                            \
	{                                                                                                              \
		.name = key, .type = CONFIG_SECTION, .keys = table                                                     \
	}
/* An array member of struct config_file and the member that counts it. */
#define LIST(key, low, high, array, counter, table)                                                                    \
	{                                                                                                              \
		.name = key, .type = CONFIG_LIST, .offset = AT(array), RANGE(low, high),                               \
		.size = sizeof((struct config_file *)0)->array[0], .count_offset = AT(counter), .keys = table          \
	}
#define END                                                                                                            \
	{                                                                                                              \
		.name = NULL                                                                                           \
	}

static const struct config_key cushion_keys[] = {
	POINT("from", IN(cushion, a)),
	POINT("to", IN(cushion, b)),
	FLAG("main_rail", IN(cushion, main_rail)),
	NUMBER_OR(0, "e", UNIT_NONE, 0, 1, IN(cushion, e)),
	NUMBER_OR(0, "mu", UNIT_NONE, 0, 1, IN(cushion, mu)),
	FLAG("two_sided", IN(cushion, two_sided)),
	END,
};

static const struct config_key jaw_keys[] = {
	POINT("centre", IN(jaw, centre)),
	NUMBER("radius", UNIT_MM, 0, 300, IN(jaw, radius)),
	END,
};

static const struct config_key pocket_keys[] = {
	TEXT("name", 1, 15, IN(pocket, name)),
	POINT("centre", IN(pocket, centre)),
	NUMBER("radius", UNIT_MM, 1, 200, IN(pocket, radius)),
	NUMBERS("normal", 2, UNIT_NONE, -1, 1, IN(pocket, normal)),
	END,
};

static const struct config_key spot_keys[] = {
	POINT("yellow", AT(config.table.spot[COLOUR_YELLOW])),
	POINT("green", AT(config.table.spot[COLOUR_GREEN])),
	POINT("brown", AT(config.table.spot[COLOUR_BROWN])),
	POINT("blue", AT(config.table.spot[COLOUR_BLUE])),
	POINT("pink", AT(config.table.spot[COLOUR_PINK])),
	POINT("black", AT(config.table.spot[COLOUR_BLACK])),
	END,
};

static const struct config_key table_keys[] = {
	NUMBER("length", UNIT_MM, 500, 5000, AT(config.table.length)),
	NUMBER("width", UNIT_MM, 300, 3000, AT(config.table.width)),
	NUMBER("ball_diameter", UNIT_MM, 20, 80, AT(config.table.ball_radius)), /* halved by config.c */
	NUMBER("ball_mass", UNIT_KG, 0.01, 1, AT(config.table.ball_mass)),
	NUMBER("nose_height", UNIT_MM, 10, 80, AT(nose_height)),
	POINT("d_centre", AT(config.table.baulk_d_centre)),
	NUMBER("d_radius", UNIT_MM, 10, 1000, AT(config.table.baulk_d_radius)),
	NUMBERS_OR(0, "slope", 2, UNIT_MM_M, -20, 20, AT(config.table.bed.slope)),
	NUMBERS_OR(0, "bowl", 3, UNIT_MM_M2, -20, 20, AT(config.table.bed.bowl)),
	SECTION("spots", spot_keys),
	LIST("cushions", 4, CUSHION_MAX, config.table.cushion, config.table.cushion_count, cushion_keys),
	LIST("jaws", 0, JAW_MAX, config.table.jaw, config.table.jaw_count, jaw_keys),
	LIST("pockets", 0, POCKET_MAX, config.table.pocket, config.table.pocket_count, pocket_keys),
	END,
};

static const struct config_key material_keys[] = {
	NUMBER("gravity", UNIT_MM_S2, 1000, 20000, AT(config.table.material.gravity)),
	NUMBER("mu_slide", UNIT_NONE, 0.01, 1, AT(config.table.material.mu_slide)),
	NUMBER("mu_roll", UNIT_NONE, 0.001, 0.1, AT(config.table.material.mu_roll)),
	NUMBER("mu_spin", UNIT_MM, 0.001, 10, AT(config.table.material.mu_spin)),
	NUMBER("loss_ball", UNIT_NONE, 0, 0.9, AT(config.table.material.loss_ball)),
	NUMBER("loss_cushion", UNIT_NONE, 0, 0.9, AT(config.table.material.loss_cushion)),
	WHOLE("topspin_variant", UNIT_NONE, 0, 2, AT(config.table.material.topspin_variant)),
	NUMBER("topspin_speed", UNIT_MM_S, 0, 1000, AT(topspin_speed)),
	NUMBER("topspin_share", UNIT_NONE, 0, 1, AT(topspin_share)),
	NUMBER("e_ball", UNIT_NONE, 0.1, 1, AT(config.table.material.e_ball)),
	NUMBER("e_cushion", UNIT_NONE, 0.1, 1, AT(config.table.material.e_cushion)),
	NUMBER("mu_cushion", UNIT_NONE, 0, 1, AT(config.table.material.mu_cushion)),
	NUMBER_OR(0, "ball_fall", UNIT_S_M, 0, 1, AT(config.table.material.ball_fall)),
	NUMBER_OR(0, "cushion_fall", UNIT_S_M, 0, 1, AT(config.table.material.cushion_fall)),
	NUMBER_OR(0, "cue_end_mass", UNIT_KG, 0, 0.1, AT(config.table.material.cue_end_mass)),
	NUMBER("mu_ball_a", UNIT_NONE, 0, 1, AT(config.table.material.mu_ball_a)),
	NUMBER("mu_ball_b", UNIT_NONE, 0, 1, AT(config.table.material.mu_ball_b)),
	NUMBER("mu_ball_c", UNIT_S_M, 0, 100, AT(config.table.material.mu_ball_c)),
	NUMBER("stronge_omega", UNIT_NONE, 1, 4, AT(config.table.material.stronge_omega)),
	NUMBER_OR(6.4, "hertz_modulus", UNIT_GPA, 0, 1000, AT(config.table.material.hertz_modulus)),
	END,
};

/* In the order of enum plan_ranking. */
static const char *const ranking_names[] = {"thesis", "success", "value", NULL};

static const struct config_key profile_keys[] = {
	TEXT("name", 1, 15, IN(cost_profile, name)),
	NUMBER("w_distance", UNIT_NONE, 0, 100, IN(cost_profile, w_distance)),
	NUMBER("w_angle", UNIT_NONE, 0, 100, IN(cost_profile, w_angle)),
	NUMBER("w_balls", UNIT_NONE, 0, 100, IN(cost_profile, w_balls)),
	NUMBER("w_rails", UNIT_NONE, 0, 100, IN(cost_profile, w_rails)),
	NUMBER("ball_cost", UNIT_NONE, 0, 100, IN(cost_profile, ball_cost)),
	NUMBER("rail_cost", UNIT_NONE, 0, 100, IN(cost_profile, rail_cost)),
	NUMBER("w_points", UNIT_NONE, 0, 100, IN(cost_profile, w_points)),
	NUMBER("w_speed", UNIT_NONE, 0, 100, IN(cost_profile, w_speed)),
	NUMBER("w_simulation", UNIT_NONE, 0, 100, IN(cost_profile, w_simulation)),
	NUMBER("max_cut", UNIT_DEGREE, 1, 90, IN(cost_profile, max_cut)),
	NUMBER("max_speed", UNIT_MM_S, 100, 20000, IN(cost_profile, max_speed)),
	NUMBER("pocket_speed", UNIT_MM_S, 1, 5000, IN(cost_profile, pocket_speed)),
	NUMBER("speed_step", UNIT_MM_S, 1, 10000, IN(cost_profile, speed_step)),
	NUMBER("clearance", UNIT_MM, 0, 100, IN(cost_profile, clearance)),
	NUMBER("cue_clearance", UNIT_MM, 0, 100, IN(cost_profile, cue_clearance)),
	NUMBER("cue_room", UNIT_MM, 0, 2000, IN(cost_profile, cue_room)),
	NUMBER("sigma_angle", UNIT_DEGREE, 0, 10, IN(cost_profile, error.angle)),
	NUMBER("sigma_speed", UNIT_NONE, 0, 1, IN(cost_profile, error.speed)),
	NUMBER_OR(0, "sigma_tip", UNIT_NONE, 0, 0.5, IN(cost_profile, error.tip)),
	CHOICE("ranking", ranking_names, IN(cost_profile, ranking)),
	FLAG("program_speed", IN(cost_profile, program_speed)),
	WHOLE("aims", UNIT_NONE, 1, 9, IN(cost_profile, aims)),
	FLAG("any_first", IN(cost_profile, any_first)),
	FLAG("keep_flukes", IN(cost_profile, keep_flukes)),
	END,
};

static const struct config_key camera_keys[] = {
	WHOLE("width", UNIT_PX, 64, 8192, AT(config.camera.width)),
	WHOLE("height", UNIT_PX, 64, 8192, AT(config.camera.height)),
	NUMBER("fx", UNIT_PX, 10, 100000, AT(config.camera.fx)),
	NUMBER("fy", UNIT_PX, 10, 100000, AT(config.camera.fy)),
	NUMBER("cx", UNIT_PX, 0, 8192, AT(config.camera.cx)),
	NUMBER("cy", UNIT_PX, 0, 8192, AT(config.camera.cy)),
	NUMBER("k1", UNIT_NONE, -10, 10, AT(config.camera.k1)),
	NUMBER("k2", UNIT_NONE, -10, 10, AT(config.camera.k2)),
	NUMBER("p1", UNIT_NONE, -10, 10, AT(config.camera.p1)),
	NUMBER("p2", UNIT_NONE, -10, 10, AT(config.camera.p2)),
	NUMBER("k3", UNIT_NONE, -10, 10, AT(config.camera.k3)),
	END,
};

#define MARKER_AT(member) (offsetof(struct marker_layout, marker[0].member) - offsetof(struct marker_layout, marker[0]))
static const struct config_key marker_keys[] = {
	WHOLE("id", UNIT_NONE, 0, 49, MARKER_AT(id)),
	POINT("centre", MARKER_AT(centre)),
	END,
};

static const struct config_key markers_keys[] = {
	WHOLE("dictionary_count", UNIT_NONE, 1, 50, AT(config.markers.dictionary_count)),
	WHOLE("dictionary_bits", UNIT_NONE, 3, 7, AT(config.markers.dictionary_bits)),
	NUMBER("side", UNIT_MM, 5, 500, AT(config.markers.side)),
	NUMBER("height", UNIT_MM, -100, 500, AT(config.markers.height)),
	LIST("list", 3, MARKER_MAX, config.markers.marker, config.markers.count, marker_keys),
	END,
};

static const struct config_key vision_keys[] = {
	TEXT("colours", 1, CONFIG_PATH_MAX - 1, AT(config.colours)),
	TEXT("source", 1, CONFIG_PATH_MAX - 1, AT(config.source)),
	NUMBER("camera_rate", UNIT_HERTZ, 0, 100, AT(config.camera_rate)),
	NUMBER("marker_interval", UNIT_SECOND, 0, 3600, AT(config.marker_interval)),
	NUMBER("pose_keep", UNIT_SECOND, 0, 86400, AT(config.pose_keep)),
	END,
};

static const struct config_key planner_keys[] = {
	WHOLE("workers", UNIT_NONE, 0, PLAN_WORKERS_MAX, AT(config.planner.workers)),
	WHOLE("memory_mib", UNIT_NONE, 1, 16384, AT(memory_mib)),
	WHOLE("depth", UNIT_NONE, 1, PLAN_SHOTS_MAX, AT(config.planner.depth)),
	WHOLE("rails", UNIT_NONE, 0, PLAN_RAILS_MAX, AT(config.planner.rails)),
	WHOLE("balls", UNIT_NONE, 1, PLAN_CHAIN_MAX - 1, AT(config.planner.balls)),
	WHOLE("speeds", UNIT_NONE, 1, 32, AT(config.planner.speeds)),
	WHOLE("plans", UNIT_NONE, 1, PLAN_MAX, AT(config.planner.plans)),
	COUNT("budget_nodes", 0, 1e12, AT(config.planner.budget_nodes)),
	NUMBER("budget", UNIT_MS, 0, 600000, AT(config.planner.budget)),
	TEXT("scheme", 1, 15, AT(scheme)),
	NUMBER("sync_period", UNIT_MS, 1, 10000, AT(config.planner.sync_period)),
	NUMBER("sync_window", UNIT_MS, 0, 10000, AT(config.planner.sync_window)),
	END,
};

static const struct config_key infinity_keys[] = {
	NUMBER("still_distance", UNIT_MM, 0.01, 100, AT(config.infinity.still_distance)),
	NUMBER("still_time", UNIT_MS, 10, 60000, AT(config.infinity.still_time)),
	NUMBER_OR(0, "still_frames", UNIT_NONE, 1, 1000, AT(still_frames)), /* older files; config.c turns it into still_time */
	NUMBER("cue_distance", UNIT_MM, 1, 1000, AT(config.infinity.cue_distance)),
	NUMBER("cue_time", UNIT_MS, 10, 60000, AT(config.infinity.cue_time)),
	NUMBER("lost_time", UNIT_MS, 10, 60000, AT(config.infinity.lost_time)),
	NUMBER("new_time", UNIT_MS, 10, 60000, AT(config.infinity.new_time)),
	NUMBER("clear_time", UNIT_MS, 10, 60000, AT(config.infinity.clear_time)),
	NUMBER("moving_time", UNIT_MS, 1, 1000, AT(config.infinity.moving_time)),
	NUMBER("blind_time", UNIT_MS, 1, 10000, AT(config.infinity.blind_time)),
	NUMBER("nudge_distance", UNIT_MM, 0.01, 100, AT(config.infinity.nudge_distance)),
	NUMBER("tell_time", UNIT_MS, 100, 60000, AT(config.infinity.tell_time)),
	NUMBER("silence_time", UNIT_MS, 100, 60000, AT(config.infinity.silence_time)),
	NUMBER("show_time", UNIT_MS, 0, 10000, AT(config.infinity.show_time)),
	NUMBER("better_margin", UNIT_NONE, 0, 10, AT(config.infinity.better_margin)),
	TEXT("game_file", 0, CONFIG_PATH_MAX - 1, AT(config.infinity.game_file)),
	FLAG("rules", AT(config.infinity.rules)),
	NUMBER("plan_timeout", UNIT_MS, 10, 600000, AT(config.infinity.plan_timeout)),
	NUMBER("animation_rate", UNIT_NONE, 0.01, 100, AT(config.infinity.animation_rate)),
	NUMBER("animation_pause", UNIT_MS, 0, 600000, AT(config.infinity.animation_pause)),
	END,
};

static const struct config_key projector_keys[] = {
	WHOLE("width", UNIT_PX, 64, 8192, AT(config.projector.width)),
	WHOLE("height", UNIT_PX, 64, 8192, AT(config.projector.height)),
	NUMBERS("homography", 9, UNIT_NONE, -1e6, 1e6, AT(config.projector.homography)),
	FLAG("fullscreen", AT(config.projector.fullscreen)),
	TEXT("font", 1, 63, AT(config.projector.font)),
	END,
};

/* Times a minute and seconds of each. */
#define FAULT(key, kind) NUMBERS_OR(0, key, 2, UNIT_NONE, 0, 600, AT(config.virtual_table.fault[kind]))
static const struct config_key virtual_keys[] = {
	NUMBER("noise", UNIT_GREY, 0, 64, AT(config.virtual_table.noise)),
	NUMBER("exposure", UNIT_NONE, 0.01, 10, AT(config.virtual_table.exposure)),
	NUMBER("projector_light", UNIT_NONE, 0, 1, AT(config.virtual_table.projector_light)),
	NUMBER("frame_rate", UNIT_HERTZ, 0.1, 240, AT(config.virtual_table.frame_rate)),
	NUMBER("error_angle", UNIT_DEGREE, 0, 10, AT(config.virtual_table.error_angle)),
	NUMBER("error_speed", UNIT_NONE, 0, 1, AT(config.virtual_table.error_speed)),
	COUNT("seed", 0, 1e15, AT(config.virtual_table.seed)),
	NUMBER("time_scale", UNIT_NONE, 0.01, 1000, AT(config.virtual_table.time_scale)),
	NUMBER("think_time", UNIT_MS, 0, 600000, AT(config.virtual_table.think_time)),
	NUMBER("camera_height", UNIT_MM, 200, 10000, AT(config.virtual_table.camera_height)),
	NUMBER("camera_x", UNIT_MM, -5000, 5000, AT(config.virtual_table.camera_x)),
	NUMBER("camera_y", UNIT_MM, -5000, 5000, AT(config.virtual_table.camera_y)),
	NUMBER("camera_tilt_x", UNIT_DEGREE, -45, 45, AT(config.virtual_table.camera_tilt_x)),
	NUMBER("camera_tilt_y", UNIT_DEGREE, -45, 45, AT(config.virtual_table.camera_tilt_y)),
	WHOLE("jpeg_quality", UNIT_NONE, 1, 100, AT(config.virtual_table.jpeg_quality)),
	NUMBER_OR(8, "exposure_time", UNIT_MS, 0, 100, AT(config.virtual_table.exposure_time)),
	NUMBER_OR(0, "shutter_time", UNIT_MS, 0, 100, AT(config.virtual_table.shutter_time)),
	NUMBER_OR(0, "aim_time", UNIT_MS, 0, 600000, AT(config.virtual_table.habit.aim_time)),
	NUMBER_OR(500, "leave_time", UNIT_MS, 0, 600000, AT(config.virtual_table.habit.leave_time)),
	NUMBER_OR(0, "place_time", UNIT_MS, 0, 600000, AT(config.virtual_table.habit.place_time)),
	NUMBER_OR(60000, "patience", UNIT_MS, 0, 3600000, AT(config.virtual_table.habit.patience)),
	NUMBER_OR(0, "other_shot", UNIT_NONE, 0, 1, AT(config.virtual_table.habit.other)),
	NUMBER_OR(0, "quick_shot", UNIT_NONE, 0, 1, AT(config.virtual_table.habit.quick)),
	NUMBER_OR(0, "touch", UNIT_NONE, 0, 1, AT(config.virtual_table.habit.touch)),
	NUMBER_OR(0, "wipe", UNIT_NONE, 0, 1, AT(config.virtual_table.habit.wipe)),
	NUMBER_OR(0, "linger", UNIT_NONE, 0, 1, AT(config.virtual_table.habit.linger)),
	FAULT("fault_drop", 0),
	FAULT("fault_late", 1),
	FAULT("fault_repeat", 2),
	FAULT("fault_freeze", 3),
	FAULT("fault_dark", 4),
	FAULT("fault_bright", 5),
	FAULT("fault_flash", 6),
	FAULT("fault_ghost", 7),
	FAULT("fault_missing", 8),
	FAULT("fault_knock", 9),
	FAULT("fault_bits", 10),
	NUMBER_OR(1, "cloth", UNIT_NONE, 0.2, 5, AT(config.virtual_table.cloth)),
	NUMBER_OR(1, "bounce", UNIT_NONE, 0.2, 1.2, AT(config.virtual_table.bounce)),
	NUMBERS_OR(0, "tilt", 2, UNIT_MM_M, -20, 20, AT(config.virtual_table.tilt)),
	END,
};

static const struct config_key service_keys[] = {
	TEXT("name", 1, 23, IN(config_service, name)),
	TEXT("arguments", 0, 127, IN(config_service, arguments)),
	FLAG("enabled", IN(config_service, enabled)),
	END,
};

const struct config_key config_keys[] = {
	TEXT("name", 1, 31, AT(config.name)),
	TEXT("bus", 1, 127, AT(config.bus)),
	TEXT("model", 1, 23, AT(config.model_name)),
	TEXT("profile", 1, 15, AT(profile)),
	SECTION("table", table_keys),
	SECTION("material", material_keys),
	LIST("profiles", 1, CONFIG_PROFILE_MAX, config.profiles, config.profile_count, profile_keys),
	SECTION("camera", camera_keys),
	SECTION("markers", markers_keys),
	SECTION("vision", vision_keys),
	SECTION("planner", planner_keys),
	SECTION("infinity", infinity_keys),
	SECTION("projector", projector_keys),
	SECTION("virtual_table", virtual_keys),
	LIST("services", 0, CONFIG_SERVICE_MAX, config.service, config.service_count, service_keys),
	END,
};
