#include "physics/model.h"

#include <string.h>

/* The thesis' program, by its published source, cuts the coefficients of 4.76 to 4.80 off after six digits, in metres
 * and seconds (the text does not say so). Its balls meet mostly hundredths of a millimetre before they touch, which a
 * chain of contacts makes centimetres of. */
static const double PROGRAM_GRID = 1e-6;

/* Name, balls, cushions, pockets, thesis motion, contact grid, lasting contacts. */
/* A table is read by its columns. */
/* clang-format off */
#define MODELS(ROW)                                                                                                    \
	ROW("thesis", BALL_MODEL_THESIS, CUSHION_MODEL_THESIS, POCKET_MODEL_CIRCLE, true, PROGRAM_GRID, false)         \
	ROW("simple", BALL_MODEL_RESTITUTION, CUSHION_MODEL_RESTITUTION, POCKET_MODEL_CIRCLE, false, 0, false)         \
	ROW("simple-elastic", BALL_MODEL_ELASTIC, CUSHION_MODEL_MIRROR, POCKET_MODEL_CIRCLE, false, 0, false)          \
	ROW("real", BALL_MODEL_FRICTIONAL, CUSHION_MODEL_STRONGE, POCKET_MODEL_JAWS, false, 0, true)                   \
	ROW("real-mathavan", BALL_MODEL_FRICTIONAL, CUSHION_MODEL_MATHAVAN, POCKET_MODEL_JAWS, false, 0, true)
/* clang-format on */

#define AS_MODEL(name, ...) {name, {__VA_ARGS__}},
#define AS_NAME(name, ...)  ", " name

static const struct {
	const char *name;
	struct model model;
} models[] = {MODELS(AS_MODEL)};

const char *model_names(void)
{
	static const char list[] = MODELS(AS_NAME);
	return &list[2]; /* without the first comma */
}

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
