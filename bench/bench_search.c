/* Speed of the search on the positions of issue and thesis, and its quality against time. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "app/config/position.h"
#include "report.h"
#include "scenes.h"
#include "search_scenes.h"

enum { BREAKS = 6, PATH_SIZE = 512 };

struct job {
	struct planner *planner;
	struct plan_request request;
	struct plan_result result;
	double first, begin; /* s until the first proposal; when the search began */
};

static double now_s(void *context)
{
	struct timespec t;
	(void)context;
	clock_gettime(CLOCK_MONOTONIC, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static struct planner *new_planner(const struct table *table, const char *model)
{
	struct planner *planner = NULL;
	struct planner_def def = planner_def_default();
	def.table = table;
	def.now = now_s;
	if (!model_from_name(model, &def.model) || planner_create(&planner, &def) != 0) {
		fprintf(stderr, "bench_search: no planner\n");
		exit(1);
	}
	return planner;
}

static void run(void *context)
{
	struct job *job = context;
	char err[200];
	if (planner_run(job->planner, &job->request, NULL, NULL, &job->result, err, sizeof err) < 0) {
		fprintf(stderr, "bench_search: %s\n", err);
		exit(1);
	}
}

static void note_first(void *context, const struct plan_result *result)
{
	struct job *job = context;
	(void)result;
	if (job->first <= 0)
		job->first = now_s(NULL) - job->begin;
}

/* ms until the first proposal, the best of several runs. */
static double time_first(struct job *job)
{
	double best = INFINITY;
	char err[200];
	for (int i = 0; i < 20; i++) {
		job->first = 0;
		job->begin = now_s(NULL);
		planner_run(job->planner, &job->request, note_first, job, &job->result, err, sizeof err);
		best = fmin(best, job->first > 0 ? job->first : now_s(NULL) - job->begin);
	}
	return 1000 * best;
}

/* ---- the positions
 * --------------------------------------------------------------------------------------------------- */

static bool read_situation(const struct table *table, const char *name, struct plan_request *request)
{
	const char *folder = getenv("DATA");
	char path[PATH_SIZE], err[PATH_SIZE];
	struct position position;
	snprintf(path, sizeof path, "%s/positions/%s.txt", folder ? folder : DATA, name);
	if (position_read(&position, table, path, err, sizeof err) < 0) {
		printf("SKIPPED: %s\n", err);
		return false;
	}
	*request = scene_request(position.ball, position.count);
	request->target = TARGET_COLOUR;
	request->target_colour = COLOUR_RED;
	return true;
}

static struct plan_request after_break(const struct table *table, int variant)
{
	struct ball ball[BALL_MAX];
	scene_after_break(table, variant, ball);
	struct plan_request request = scene_request(ball, BALL_MAX);
	request.target = TARGET_RULES;
	return request;
}

/* ---- speed
 * ----------------------------------------------------------------------------------------------------------- */

static double measure(struct report *report, struct job *job, const char *name)
{
	double ms = 1e-6 * bench_time(run, job);
	printf("    %d plans, %llu expansions, %llu simulations, %.1f us a node\n", job->result.plan_count,
	       (unsigned long long)job->result.nodes, (unsigned long long)job->result.sims,
	       1000 * ms / (double)(job->result.nodes + job->result.sims));
	if (report)
		report_number(report, name, ms, "ms");
	return ms;
}

static double bench_situations(struct report *report, const struct table *table)
{
	struct job job = {.planner = new_planner(table, "thesis")};
	double first = 0;
	if (read_situation(table, "situation1", &job.request)) {
		measure(report, &job, "plan.s1_direct_ms");
		first = fmax(first, time_first(&job));
		job.request.rails = 3;
		measure(report, &job, "plan.s1_rails_ms");
		first = fmax(first, time_first(&job));
	}
	if (read_situation(table, "situation2", &job.request)) {
		job.request.rails = 3;
		job.request.depth = 2;
		measure(report, &job, "plan.s2_deep_ms");
		first = fmax(first, time_first(&job));
	}
	planner_destroy(job.planner);
	return first;
}

/* The slowest of several breaks. */
static double bench_breaks(struct report *report, const struct table *table)
{
	struct job job = {.planner = new_planner(table, "thesis")};
	double worst = 0, first = 0;
	for (int i = 0; i < BREAKS; i++) {
		job.request = after_break(table, i);
		job.request.rails = 3;
		job.request.depth = 2;
		worst = fmax(worst, measure(NULL, &job, ""));
		if (!job.result.exhausted)
			printf("    not exhausted\n");
		first = fmax(first, time_first(&job));
	}
	report_number(report, "plan.break_deep_ms", worst, "ms");
	planner_destroy(job.planner);
	return first;
}

static void bench_speed(struct report *report, const struct table *table)
{
	double first = bench_situations(report, table);
	first = fmax(first, bench_breaks(report, table));
	struct job job = {.planner = new_planner(table, "thesis")};
	struct ball rack[SCENE_RACK_COUNT];
	scene_rack(table, rack);
	job.request = scene_request(rack, SCENE_RACK_COUNT);
	job.request.target = TARGET_RULES;
	job.request.rails = 3;
	first = fmax(first, time_first(&job));
	planner_destroy(job.planner);
	report_number(report, "plan.first_ms", first, "ms");
}

/* ---- quality against time
 * ---------------------------------------------------------------------------------------------- */

/* ms, the best of three. */
static double time_quick(struct job *job)
{
	double best = INFINITY;
	for (int i = 0; i < 3; i++) {
		double begin = now_s(NULL);
		run(job);
		best = fmin(best, now_s(NULL) - begin);
	}
	return 1000 * best;
}

/* One line of search.csv per budget: what the best plan is worth after so many nodes. */
static void curve(FILE *csv, struct job *job, const char *position, const char *model)
{
	for (uint64_t nodes = 16; nodes <= 1u << 18; nodes *= 2) {
		job->request.budget.nodes = nodes;
		double ms = time_quick(job);
		const struct plan_result *result = &job->result;
		if (result->plan_count == 0 || result->plan[0].shot[0].target < 0)
			continue;
		job->request.tolerances = 1;
		run(job);
		job->request.tolerances = 0;
		double success = 1;
		for (int s = 0; s < result->plan[0].shot_count; s++)
			success *= isnan(result->plan[0].shot[s].success) ? 0 : result->plan[0].shot[s].success;
		fprintf(csv, "%s,%s,%d,%d,%d,%.4f,%.5f,%.4f\n", position, model, job->request.depth, job->request.rails,
			result->plan[0].shot_count, ms, result->plan[0].cost, success);
		if (result->exhausted)
			break;
	}
	job->request.budget.nodes = 0;
}

static void bench_quality(const char *build, const struct table *table)
{
	static const char *const model[] = {"thesis", "real"};
	char path[PATH_SIZE];
	snprintf(path, sizeof path, "%s/search.csv", build);
	FILE *csv = fopen(path, "w");
	if (!csv) {
		perror(path);
		return;
	}
	fprintf(csv, "position,model,depth,rails,shots,ms,cost,success\n");
	for (int m = 0; m < 2; m++)
		for (int p = 0; p < 5; p++) {
			static const char *const name[] = {"situation1", "situation2", "break 1", "break 3", "break 5"};
			struct job job = {.planner = new_planner(table, model[m])};
			bool there = true;
			if (p < 2)
				there = read_situation(table, name[p], &job.request);
			else
				job.request = after_break(table, 2 * p - 3);
			for (int k = 0; k < 4 && there; k++) {
				job.request.depth = 1 + k % 2;
				job.request.rails = k / 2 * 3;
				curve(csv, &job, name[p], model[m]);
			}
			planner_destroy(job.planner);
		}
	fclose(csv);
}

int main(int argc, char **argv)
{
	const char *build = argc > 1 ? argv[1] : "build";
	struct table table = scene_thesis_table();
	struct report *report = report_open(build, "bench.json");
	bench_speed(report, &table);
	bench_quality(build, &table);
	return report_close(report) < 0;
}
