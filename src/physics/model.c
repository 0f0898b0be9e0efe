#include "physics/model.h"

#include <string.h>

static const struct {
	const char *name;
	struct model model;
} models[] = {
	{"thesis", {BALL_MODEL_THESIS, CUSHION_MODEL_THESIS, POCKET_MODEL_CIRCLE, true}},
	{"simple", {BALL_MODEL_RESTITUTION, CUSHION_MODEL_RESTITUTION, POCKET_MODEL_CIRCLE, false}},
	{"simple-elastic", {BALL_MODEL_ELASTIC, CUSHION_MODEL_MIRROR, POCKET_MODEL_CIRCLE, false}},
	{"real", {BALL_MODEL_FRICTIONAL, CUSHION_MODEL_STRONGE, POCKET_MODEL_JAWS, false}},
	{"real-mathavan", {BALL_MODEL_FRICTIONAL, CUSHION_MODEL_MATHAVAN, POCKET_MODEL_JAWS, false}},
};

bool model_from_name(const char *name, struct model *model)
{
	for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
		if (strcmp(name, models[i].name) == 0) {
			*model = models[i].model;
			return true;
		}
	}
	return false;
}
