#include "scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double MM = 1e-3;

static void finish(struct table *table)
{
	char err[128];
	if (table_finish(table, err, sizeof err) != 0) {
		fprintf(stderr, "scene: %s\n", err);
		abort();
	}
}

static struct material material(void)
{
	return (struct material){
		.gravity = 9.8,
		.mu_slide = 0.170922,
		.mu_roll = 0.0142435,
		.mu_spin = 3.05e-4,
		.loss_ball = 0.05,
		.loss_cushion = 0.38,
		.topspin_variant = 2,
		.topspin_factor = 0.25,
		.e_ball = 0.95,
		.e_cushion = 0.85,
		.mu_cushion = 0.2,
		.mu_ball_a = 0.009951,
		.mu_ball_b = 0.108,
		.mu_ball_c = 1.088,
		.stronge_omega = 1.8,
	};
}

static void add_pocket(struct table *t, const char *name, double x, double y, double radius, vec2 normal)
{
	struct pocket *p = &t->pocket[t->pocket_count++];
	*p = (struct pocket){.centre = {x * MM, y * MM}, .radius = radius * MM, .normal = vec2_unit(normal)};
	snprintf(p->name, sizeof p->name, "%s", name);
}

static void add_six_pockets(struct table *t, double x, double y, double y_centre, double r, double r_centre)
{
	add_pocket(t, "BOTTOM-LEFT", -x, -y, r, (vec2){1, 1});
	add_pocket(t, "TOP-LEFT", -x, y, r, (vec2){1, -1});
	add_pocket(t, "TOP-CENTER", 0, y_centre, r_centre, (vec2){0, -1});
	add_pocket(t, "TOP-RIGHT", x, y, r, (vec2){-1, -1});
	add_pocket(t, "BOTTOM-RIGHT", x, -y, r, (vec2){-1, 1});
	add_pocket(t, "BOTTOM-CENTER", 0, -y_centre, r_centre, (vec2){0, 1});
}

static void add_cushion(struct table *t, const double *xy, bool main_rail)
{
	t->cushion[t->cushion_count++] = (struct cushion){.a = {xy[0] * MM, xy[1] * MM},
							  .b = {xy[2] * MM, xy[3] * MM},
							  .nose_height = 1.4 * t->ball_radius,
							  .main_rail = main_rail};
}

/* Ends of the 18 segments in mm: the six long noses, then two jaws per pocket. */
static const double thesis_cushion[18][4] = {
	{-940.5, 390, -940.5, -390},	  {940.5, -390, 940.5, 390},	      {-55, 471.5, -860, 471.5},
	{860, 471.5, 55, 471.5},	  {-862.5, -471.5, -57.5, -471.5},    {57.5, -471.5, 862.5, -471.5},
	{-57.5, -471.5, -50, -500},	  {50, -500, 57.5, -471.5},	      {-47.5, 500, -55, 471.5},
	{55, 471.5, 47.5, 500},		  {-940.5, -390, -966.212, -420.642}, {-893.142, -497.212, -862.5, -471.5},
	{-966.212, 420.642, -940.5, 390}, {-860, 471.5, -890.642, 497.212},   {890.642, 497.212, 860, 471.5},
	{940.5, 390, 966.212, 420.642},	  {862.5, -471.5, 893.142, -497.212}, {966.212, -420.642, 940.5, -390},
};

struct table scene_thesis_table(void)
{
	struct table t = {.length = 1.881, .width = 0.943, .ball_radius = 0.02615, .ball_mass = 0.140};
	t.material = material();
	add_six_pockets(&t, 940.5, 471.5, 491.5, 50, 50);
	for (int i = 0; i < 18; i++)
		add_cushion(&t, thesis_cushion[i], i < 6);
	t.spot[COLOUR_BLACK] = (vec2){0.8938, 0};
	t.spot[COLOUR_PINK] = (vec2){0.580, 0};
	t.spot[COLOUR_BLUE] = (vec2){0, 0};
	t.spot[COLOUR_BROWN] = t.baulk_d_centre = (vec2){-0.600, 0};
	t.spot[COLOUR_GREEN] = (vec2){-0.600, -0.200};
	t.spot[COLOUR_YELLOW] = (vec2){-0.600, 0.200};
	t.baulk_d_radius = 0.200;
	finish(&t);
	return t;
}

/* One pocket's mouth: the two rails end at tips of radius r; straight jaws run on from the tips. Mirrored by sx, sy. */
static void add_corner(struct table *t, double sx, double sy)
{
	double x = 1784.5, y = 889, cut = 85, r = 60, jaw = 25;
	double h = r * (1 - sqrt(0.5)), s = r * sqrt(0.5);
	const double at_x[4] = {sx * (x - cut + s), sy * (y + h), sx * (x - cut + s + jaw), sy * (y + h + jaw)};
	const double at_y[4] = {sx * (x + h), sy * (y - cut + s), sx * (x + h + jaw), sy * (y - cut + s + jaw)};
	add_cushion(t, at_x, false);
	add_cushion(t, at_y, false);
	double height = 1.4 * t->ball_radius;
	t->jaw[t->jaw_count++] = (struct jaw){{sx * (x - cut) * MM, sy * (y + r) * MM}, r * MM, height};
	t->jaw[t->jaw_count++] = (struct jaw){{sx * (x + r) * MM, sy * (y - cut) * MM}, r * MM, height};
}

static void add_middle(struct table *t, double sy)
{
	double y = 889, half = 110, r = 60;
	for (int side = -1; side <= 1; side += 2) {
		const double jaw[4] = {side * (half - r), sy * (y + r), side * (half - r), sy * (y + r + 25)};
		add_cushion(t, jaw, false);
		t->jaw[t->jaw_count++] =
			(struct jaw){{side * half * MM, sy * (y + r) * MM}, r * MM, 1.4 * t->ball_radius};
	}
}

struct table scene_snooker_table(void)
{
	struct table t = {.length = 3.569, .width = 1.778, .ball_radius = 0.02625, .ball_mass = 0.142};
	double x = 1784.5, y = 889, cut = 85, half = 110;
	t.material = material();
	t.material.mu_roll = 0.01;
	t.material.mu_slide = 0.2;
	t.material.gravity = 9.81;
	const double rail[6][4] = {
		{-x, -y + cut, -x, y - cut}, {x, -y + cut, x, y - cut}, {-x + cut, y, -half, y},
		{half, y, x - cut, y},	     {-x + cut, -y, -half, -y}, {half, -y, x - cut, -y},
	};
	for (int i = 0; i < 6; i++)
		add_cushion(&t, rail[i], true);
	for (int i = 0; i < 4; i++)
		add_corner(&t, i & 1 ? 1 : -1, i & 2 ? 1 : -1);
	add_middle(&t, -1);
	add_middle(&t, 1);
	add_six_pockets(&t, x + 25, y + 25, y + 42, 43, 43);
	t.spot[COLOUR_BLACK] = (vec2){x * MM - 0.324, 0};
	t.spot[COLOUR_PINK] = (vec2){x * MM / 2, 0};
	t.spot[COLOUR_BLUE] = (vec2){0, 0};
	t.spot[COLOUR_BROWN] = t.baulk_d_centre = (vec2){-x * MM + 0.737, 0};
	t.baulk_d_radius = 0.292;
	t.spot[COLOUR_GREEN] = vec2_add(t.baulk_d_centre, (vec2){0, t.baulk_d_radius});
	t.spot[COLOUR_YELLOW] = vec2_add(t.baulk_d_centre, (vec2){0, -t.baulk_d_radius});
	finish(&t);
	return t;
}

struct table scene_box_table(double length, double width)
{
	struct table t = {.length = length, .width = width, .ball_radius = 0.02625, .ball_mass = 0.140};
	double x = length / 2 / MM, y = width / 2 / MM;
	t.material = material();
	t.material.mu_roll = 0.01;
	t.material.mu_slide = 0.2;
	t.material.gravity = 9.81;
	const double rail[4][4] = {{-x, -y, -x, y}, {x, y, x, -y}, {-x, y, x, y}, {x, -y, -x, -y}};
	for (int i = 0; i < 4; i++)
		add_cushion(&t, rail[i], true);
	finish(&t);
	return t;
}

void scene_rack(const struct table *table, struct ball ball[SCENE_RACK_COUNT])
{
	double d = 2 * table->ball_radius;
	int n = 0;
	ball[n++] = ball_at(COLOUR_WHITE, vec2_add(table->baulk_d_centre, (vec2){0, -0.6 * table->baulk_d_radius}));
	vec2 apex = vec2_add(table->spot[COLOUR_PINK], (vec2){d + 1e-3, 0});
	for (int row = 0; row < 5; row++) {
		for (int k = 0; k <= row; k++) {
			vec2 at = {row * d * sqrt(0.75), (k - 0.5 * row) * d};
			ball[n++] = ball_at(COLOUR_RED, vec2_add(apex, at));
		}
	}
	for (int colour = COLOUR_YELLOW; colour <= COLOUR_BLACK; colour++)
		ball[n++] = ball_at((enum ball_colour)colour, table->spot[colour]);
}
