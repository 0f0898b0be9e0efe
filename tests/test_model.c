#include "harness.h"

#include <stdio.h>
#include <string.h>

#include "physics/model.h"

START_TEST(models_by_name)
{
	struct model model;
	ck_assert(model_from_name("thesis", &model));
	ck_assert(model.thesis_motion && model.ball == BALL_MODEL_THESIS && model.cushion == CUSHION_MODEL_THESIS);
	ck_assert(model_from_name("simple", &model));
	ck_assert(model.ball == BALL_MODEL_RESTITUTION && model.pocket == POCKET_MODEL_CIRCLE && !model.thesis_motion);
	ck_assert(model_from_name("simple-elastic", &model));
	ck_assert(model.ball == BALL_MODEL_ELASTIC && model.cushion == CUSHION_MODEL_MIRROR);
	ck_assert(model_from_name("real", &model));
	ck_assert(model.ball == BALL_MODEL_FRICTIONAL && model.cushion == CUSHION_MODEL_STRONGE);
	ck_assert(model.pocket == POCKET_MODEL_JAWS);
	ck_assert(model_from_name("real-mathavan", &model));
	ck_assert(model.cushion == CUSHION_MODEL_MATHAVAN);
}
END_TEST

/* The list for people names every model, and nothing else. */
START_TEST(the_list_holds_every_model)
{
	char list[200];
	struct model model;
	int count = 0;
	snprintf(list, sizeof list, "%s", model_names());
	for (char *rest, *name = strtok_r(list, ", ", &rest); name; name = strtok_r(NULL, ", ", &rest)) {
		ck_assert_msg(model_from_name(name, &model), "%s", name);
		count++;
	}
	ck_assert_int_eq(count, 5);
	ck_assert_ptr_null(strstr(model_names(), ", ,"));
}
END_TEST

START_TEST(unknown_names_change_nothing)
{
	struct model model = {.cushion = CUSHION_MODEL_MATHAVAN};
	ck_assert(!model_from_name("", &model) && !model_from_name("Real", &model) &&
		  !model_from_name("simple ", &model));
	ck_assert(model.cushion == CUSHION_MODEL_MATHAVAN);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("model");
	TCase *tcase = tcase_create("model");
	tcase_add_test(tcase, models_by_name);
	tcase_add_test(tcase, the_list_holds_every_model);
	tcase_add_test(tcase, unknown_names_change_nothing);
	suite_add_tcase(suite, tcase);
	return suite;
}
