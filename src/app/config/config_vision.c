#include "app/config/config.h"

/* Apart from config.c, so that reading a configuration does not pull the vision module in. */
struct vision_def config_vision_def(const struct config *config, const struct colour_model *colours)
{
	struct vision_def def = vision_def_default();
	def.table = &config->table;
	def.intrinsics = config->camera;
	def.markers = config->markers;
	def.marker_interval = config->marker_interval;
	def.pose_keep = config->pose_keep;
	def.colours = colours;
	return def;
}
