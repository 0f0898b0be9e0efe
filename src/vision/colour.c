#include "vision/colour.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <string.h>

#include "vision/linear.h"
#include "vision/reason.h"

enum { F = COLOUR_FEATURES, SIDE_SAMPLES = 17, SAMPLE_MAX = SIDE_SAMPLES * SIDE_SAMPLES, CLASS_SAMPLES_MIN = 3 };
static const double INSIDE = 0.75; /* of the outline: its rim mixes with the cloth */
static const double FLOOR = 6;	   /* levels added before a logarithm: noise of black */
/* Spread added to every class, as standard deviations: light that differs from what was learned. */
static const double SPREAD[F] = {0.10, 0.10, 0.10, 0.10, 0.10, 0.05};
static const double POOLED_SHARE = 0.05; /* of the classes' common covariance in each class' own */
static const double SCALE_FLOOR = 0.01;	 /* least spread of the apparent radius */
static const double UNKNOWN_DISTANCE = 9;

/* ---- measuring
 * ------------------------------------------------------------------------------------------------------- */

struct pixels {
	int count;
	uint8_t value[3][SAMPLE_MAX];
};

static void gather(const struct image *frame, const struct outline *o, struct pixels *out)
{
	out->count = 0;
	double step = 2 * INSIDE * o->radius_px / (SIDE_SAMPLES - 1);
	for (int i = 0; i < SIDE_SAMPLES; i++)
		for (int j = 0; j < SIDE_SAMPLES; j++) {
			double dx = (j - SIDE_SAMPLES / 2) * step, dy = (i - SIDE_SAMPLES / 2) * step;
			int x = (int)lround(o->centre.x + dx), y = (int)lround(o->centre.y + dy);
			double reach = INSIDE * o->radius_px;
			if (dx * dx + dy * dy > reach * reach || x < 0 || y < 0 || x >= frame->width ||
			    y >= frame->height)
				continue;
			const uint8_t *p = frame->data + y * frame->stride + 3 * x;
			for (int c = 0; c < 3; c++)
				out->value[c][out->count] = p[c];
			out->count++;
		}
}

/* The value that a share of them lies below; hist counts them by value. */
static double quantile(const uint16_t hist[256], int count, double share)
{
	int sum = hist[0], v = 0;
	while (sum <= share * count && v < 255)
		sum += hist[++v];
	/* Within the bin: whole levels would make a step of the logarithm. */
	double before = sum - hist[v];
	return hist[v] > 0 ? v - 0.5 + fmax(0, share * count - before) / hist[v] : v;
}

struct colour_feature colour_measure(const struct image *frame, const struct outline *outline, const float cloth[3])
{
	struct pixels px;
	struct colour_feature f = {{0}};
	gather(frame, outline, &px);
	if (px.count == 0)
		return f;
	double median[3], light[3];
	for (int c = 0; c < 3; c++) {
		uint16_t hist[256] = {0};
		for (int i = 0; i < px.count; i++)
			hist[px.value[c][i]]++;
		median[c] = fmax(0, quantile(hist, px.count, 0.5));
		light[c] = fmax(0, quantile(hist, px.count, 0.75));
		f.v[c] = log((median[c] + FLOOR) / (cloth[c] + FLOOR));
	}
	double dim = 20;
	f.v[3] = log((median[0] + dim) / (median[1] + dim));
	f.v[4] = log((median[2] + dim) / (median[1] + dim));
	double low = fmin(light[0], fmin(light[1], light[2])), high = fmax(light[0], fmax(light[1], light[2]));
	f.v[5] = (low + dim) / (high + dim);
	return f;
}

double colour_difference(const struct colour_feature *a, const struct colour_feature *b)
{
	double sum = 0;
	for (int i = 0; i < F; i++)
		sum += (a->v[i] - b->v[i]) * (a->v[i] - b->v[i]);
	return sqrt(sum);
}

/* ---- learning
 * -------------------------------------------------------------------------------------------------------- */

/* Mean and spread of the apparent radius; fits that went wrong are left out. */
static void class_scale(const struct colour_sample *sample, int count, int class, struct colour_class *out)
{
	double mean = 1, reach = 0.15;
	for (int round = 0; round < 4; round++) {
		double sum = 0, sum2 = 0, n = 0;
		for (int i = 0; i < count; i++)
			if ((int)sample[i].colour == class && fabs(sample[i].scale - mean) < reach) {
				double d = sample[i].scale - mean;
				sum += d;
				sum2 += d * d;
				n++;
			}
		if (n < CLASS_SAMPLES_MIN)
			break;
		double spread = sqrt(fmax(0, sum2 / n - sum / n * sum / n) + SCALE_FLOOR * SCALE_FLOOR);
		mean += sum / n;
		reach = 2.5 * spread;
		out->scale_spread = spread;
	}
	out->scale = mean;
	if (!(out->scale_spread > 0))
		out->scale_spread = reach;
}

static void class_moments(const struct colour_sample *sample, int count, int class, struct colour_class *out)
{
	*out = (struct colour_class){0};
	for (int i = 0; i < count; i++)
		if ((int)sample[i].colour == class) {
			out->samples++;
			for (int a = 0; a < F; a++)
				out->mean[a] += sample[i].feature.v[a];
		}
	if (out->samples == 0)
		return;
	class_scale(sample, count, class, out);
	for (int a = 0; a < F; a++)
		out->mean[a] /= out->samples;
	for (int i = 0; i < count; i++)
		if ((int)sample[i].colour == class)
			for (int a = 0; a < F; a++)
				for (int b = 0; b < F; b++)
					out->covariance[a][b] += (sample[i].feature.v[a] - out->mean[a]) *
								 (sample[i].feature.v[b] - out->mean[b]) / out->samples;
}

/* Mean of the classes' covariances, each counted once: reds are many. */
static void pool(const struct colour_model *model, double pooled[F][F])
{
	int classes = 0;
	memset(pooled, 0, sizeof(double[F][F]));
	for (int k = 0; k < COLOUR_CLASSES; k++) {
		classes += model->class[k].samples > 0;
		for (int a = 0; a < F && model->class[k].samples > 0; a++)
			for (int b = 0; b < F; b++)
				pooled[a][b] += model->class[k].covariance[a][b];
	}
	for (int a = 0; a < F && classes > 0; a++)
		for (int b = 0; b < F; b++)
			pooled[a][b] /= classes;
}

int colour_learn(const struct colour_sample *sample, int count, struct colour_model *out, char *err, size_t err_size)
{
	struct colour_model model = {.unknown_distance = UNKNOWN_DISTANCE};
	double pooled[F][F];
	for (int k = 0; k < COLOUR_CLASSES; k++) {
		class_moments(sample, count, k, &model.class[k]);
		if (model.class[k].samples > 0 && model.class[k].samples < CLASS_SAMPLES_MIN)
			return vision_fail(-EINVAL, err, err_size, "only %d samples of %s, at least %d are needed",
					   model.class[k].samples, ball_colour_name((enum ball_colour)k),
					   CLASS_SAMPLES_MIN);
	}
	pool(&model, pooled);
	for (int k = 0; k < COLOUR_CLASSES; k++)
		for (int a = 0; a < F; a++)
			for (int b = 0; b < F; b++) {
				double *c = &model.class[k].covariance[a][b];
				*c = (1 - POOLED_SHARE) * *c + POOLED_SHARE * pooled[a][b] +
				     (a == b ? SPREAD[a] * SPREAD[a] : 0);
			}
	*out = model;
	return 0;
}

/* ---- using
 * ----------------------------------------------------------------------------------------------------------- */

static bool invert(const double m[F][F], double out[F][F])
{
	for (int c = 0; c < F; c++) {
		double a[F * F], b[F] = {0};
		memcpy(a, m, sizeof(a));
		b[c] = 1;
		if (!solve_spd(a, b, F))
			return false;
		for (int r = 0; r < F; r++)
			out[r][c] = b[r];
	}
	return true;
}

/* ln of the determinant by elimination; the matrix is positive definite. */
static double log_determinant(const double m[F][F])
{
	double a[F][F], sum = 0;
	memcpy(a, m, sizeof(a));
	for (int i = 0; i < F; i++) {
		sum += log(a[i][i]);
		for (int r = i + 1; r < F; r++)
			for (int c = F - 1; c >= i; c--)
				a[r][c] -= a[r][i] / a[i][i] * a[i][c];
	}
	return sum;
}

static int check_class(const struct colour_class *class, const char *name, char *err, size_t err_size)
{
	double inverse[F][F];
	if (class->samples < 0)
		return vision_fail(-EINVAL, err, err_size, "%s: samples %d is negative", name, class->samples);
	if (class->samples == 0)
		return 0;
	for (int a = 0; a < F; a++) {
		if (!isfinite(class->mean[a]) || fabs(class->mean[a]) > 100)
			return vision_fail(-EINVAL, err, err_size, "%s: mean[%d] = %g, allowed -100..100", name, a,
					   class->mean[a]);
		for (int b = 0; b < F; b++)
			if (!isfinite(class->covariance[a][b]) || class->covariance[a][b] != class->covariance[b][a] ||
			    fabs(class->covariance[a][b]) > 1e4)
				return vision_fail(-EINVAL, err, err_size,
						   "%s: covariance[%d][%d] = %g is not a symmetric matrix's", name, a,
						   b, class->covariance[a][b]);
		if (class->covariance[a][a] < 1e-9)
			return vision_fail(-EINVAL, err, err_size, "%s: covariance[%d][%d] = %g, at least 1e-9", name,
					   a, a, class->covariance[a][a]);
	}
	if (!(class->scale >= 0.5 && class->scale <= 1.5))
		return vision_fail(-EINVAL, err, err_size, "%s: scale = %g, allowed 0.5..1.5", name, class->scale);
	if (!(class->scale_spread > 0 && class->scale_spread <= 1))
		return vision_fail(-EINVAL, err, err_size, "%s: scale_spread = %g, allowed 0..1", name,
				   class->scale_spread);
	if (!invert(class->covariance, inverse))
		return vision_fail(-EINVAL, err, err_size, "%s: the covariance is not positive definite", name);
	return 0;
}

int colour_model_check(const struct colour_model *model, char *err, size_t err_size)
{
	if (!(model->unknown_distance > 0) || !(model->unknown_distance < 1e6))
		return vision_fail(-EINVAL, err, err_size, "unknown_distance = %g, allowed 0..1e6",
				   model->unknown_distance);
	for (int k = 0; k < COLOUR_CLASSES; k++) {
		int rc = check_class(&model->class[k], ball_colour_name((enum ball_colour)k), err, err_size);
		if (rc < 0)
			return rc;
	}
	return 0;
}

struct colour_classifier colour_classifier(const struct colour_model *model)
{
	struct colour_classifier c = {.unknown_distance = model->unknown_distance};
	for (int k = 0; k < COLOUR_CLASSES; k++) {
		c.known[k] = model->class[k].samples > 0;
		if (!c.known[k])
			continue;
		memcpy(c.mean[k], model->class[k].mean, sizeof(c.mean[k]));
		bool inverted = invert(model->class[k].covariance, c.inverse[k]);
		assert(inverted);
		(void)inverted;
		c.scale[k] = model->class[k].scale;
		c.scale_spread[k] = model->class[k].scale_spread;
		c.log_norm[k] = -0.5 * log_determinant(model->class[k].covariance);
	}
	return c;
}

/* Squared Mahalanobis distance. */
static double distance2(const struct colour_classifier *c, int class, const struct colour_feature *f)
{
	double sum = 0;
	for (int a = 0; a < F; a++)
		for (int b = 0; b < F; b++)
			sum += (f->v[a] - c->mean[class][a]) * c->inverse[class][a][b] * (f->v[b] - c->mean[class][b]);
	return sum;
}

/* Log likelihood of every class for one ball; "unknown" is a class of constant likelihood. */
static void likelihoods(const struct colour_classifier *c, const struct colour_feature *f, double out[COLOUR_COUNT])
{
	double best_norm = -INFINITY;
	for (int k = 0; k < COLOUR_CLASSES; k++) {
		out[k] = c->known[k] ? c->log_norm[k] - 0.5 * distance2(c, k, f) : -INFINITY;
		best_norm = c->known[k] ? fmax(best_norm, c->log_norm[k]) : best_norm;
	}
	out[COLOUR_UNKNOWN] = isfinite(best_norm) ? best_norm - 0.5 * c->unknown_distance * c->unknown_distance : 0;
}

static int best_class(const double likely[COLOUR_COUNT], const bool taken[COLOUR_COUNT])
{
	int best = COLOUR_UNKNOWN;
	for (int k = 0; k < COLOUR_CLASSES; k++)
		if (!taken[k] && likely[k] > likely[best])
			best = k;
	return best;
}

enum ball_colour colour_likeliest(const struct colour_classifier *classifier, const struct colour_feature *feature)
{
	const bool taken[COLOUR_COUNT] = {false};
	double likely[COLOUR_COUNT];
	likelihoods(classifier, feature, likely);
	return (enum ball_colour)best_class(likely, taken);
}

/* What the ball would lose by not getting this class. */
static double regret(const double likely[COLOUR_COUNT], const bool refused[COLOUR_COUNT], int class)
{
	bool without[COLOUR_COUNT];
	memcpy(without, refused, sizeof(without));
	without[class] = true;
	double other = likely[best_class(likely, without)];
	return isfinite(other) ? likely[class] - other : INFINITY;
}

/* Share of the chosen class among all that the ball could still be. */
static double certainty(const double likely[COLOUR_COUNT], int class)
{
	double sum = 0;
	for (int k = 0; k < COLOUR_COUNT; k++)
		sum += exp(fmin(likely[k] - likely[class], 50));
	return 1 / sum;
}

void colour_assign(const struct colour_classifier *classifier, const struct colour_feature *feature, int count,
		   struct colour_verdict *out)
{
	assert(count <= COLOUR_BALLS_MAX);
	double likely[COLOUR_BALLS_MAX][COLOUR_COUNT];
	bool refused[COLOUR_BALLS_MAX][COLOUR_COUNT] = {{false}};
	int class[COLOUR_BALLS_MAX], holder[COLOUR_COUNT];
	for (int i = 0; i < count; i++) {
		likelihoods(classifier, &feature[i], likely[i]);
		class[i] = -1;
	}
	for (int k = 0; k < COLOUR_COUNT; k++)
		holder[k] = -1;
	/* Every ball asks for its best class; of two that want a class that exists once, the one that would lose more
	 * by going without keeps it and the other asks for its next best. Each round refuses something, so it ends. */
	for (bool moved = true; moved;) {
		moved = false;
		for (int i = 0; i < count; i++) {
			if (class[i] >= 0)
				continue;
			moved = true;
			int k = class[i] = best_class(likely[i], refused[i]);
			if (k == COLOUR_RED || k == COLOUR_UNKNOWN)
				continue;
			int rival = holder[k];
			if (rival < 0) {
				holder[k] = i;
				continue;
			}
			bool wins = regret(likely[i], refused[i], k) > regret(likely[rival], refused[rival], k);
			int loser = wins ? rival : i;
			holder[k] = wins ? i : rival;
			refused[loser][k] = true;
			class[loser] = -1;
		}
	}
	for (int i = 0; i < count; i++)
		out[i] = (struct colour_verdict){(enum ball_colour) class[i], certainty(likely[i], class[i])};
}
