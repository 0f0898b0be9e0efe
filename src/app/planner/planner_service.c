#include "app/planner/planner_service.h"

#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <time.h>
#include <unistd.h>

#include "app/process/text.h"
#include "app/process/clock.h"
#include "app/planner/request_message.h"
#include "app/planner/plan_message.h"

static const double IMPROVEMENT_PERIOD = 0.1; /* s between improved answers at least */
static const double OUTDATED = 2;	      /* s after the last answer within which an older request is a late one */
static const double ANSWER_TIME = 0.003;      /* s of a live budget that go into making and sending the final answer */
static const double LEAST_TIME = 0.001;	      /* s that a search gets in any case */
static const char REPLACED[] = "replaced by a newer request or cancelled";

/* Answers on their way to the loop. A request makes at most one final answer; improvements replace each other. */
enum { ANSWER_MAX = 4 };

static double thread_seconds(void)
{
	struct timespec t;
	clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A request as it came, as the search takes it, and when (s, monotonic). */
struct asked {
	billiard_plan_request_t message;
	struct plan_request request;
	double time;
};

struct planner_service {
	const struct config *config; /* borrowed */
	struct planner *planner;     /* owned */
	pthread_t thread;
	bool thread_runs;
	int descriptor;		     /* eventfd: answers wait */
	struct trace_entry *scratch; /* owned, the search thread's */
	billiard_plan_t draft;	     /* the search thread's */

	pthread_mutex_t lock; /* of all below */
	pthread_cond_t wake;
	bool stop;
	bool has_request, busy;
	uint64_t run;	    /* number of the running or last search */
	int64_t present_id; /* newest id taken */
	struct asked asked;
	billiard_plan_t answer[ANSWER_MAX];
	int answer_count;
	billiard_plan_t last; /* the last answer to present_id, for repeated requests; request_id 0: none yet */
	double last_time;     /* s, monotonic, when it was given */
	struct planner_service_figures figures;
};

/* What one search needs besides the service. */
struct search {
	struct planner_service *service;
	int32_t sequence;
	double request_time, started, last_sent;
};

static double search_clock(void *unused)
{
	(void)unused;
	return clock_seconds();
}

/* Hands a plan to the loop. An improvement still waiting is replaced; a final answer never is. Locked by the caller. */
static void post(struct planner_service *service, const billiard_plan_t *plan)
{
	if (plan->request_id == service->present_id) {
		service->last = *plan;
		service->last_time = clock_seconds();
	}
	int at = service->answer_count;
	if (at > 0 && !service->answer[at - 1].is_final && service->answer[at - 1].request_id == plan->request_id)
		at--;
	if (at == ANSWER_MAX) {
		/* The loop has not kept up with finals of cancelled requests: the oldest goes. */
		memmove(&service->answer[0], &service->answer[1], (ANSWER_MAX - 1) * sizeof service->answer[0]);
		at--;
	}
	service->answer[at] = *plan;
	service->answer_count = at + 1;
	uint64_t one = 1;
	if (write(service->descriptor, &one, sizeof one) < 0)
		return; /* the counter is full: the loop is awake anyway */
}

static void send_plan(struct search *search, bool final)
{
	struct planner_service *service = search->service;
	billiard_plan_t *plan = &service->draft;
	double now = clock_seconds();
	plan->utime = clock_utime();
	plan->sequence = search->sequence++;
	plan->is_final = final;
	plan->seconds = now - search->started;
	pthread_mutex_lock(&service->lock);
	if (plan->sequence == 0)
		service->figures.last_first = now - search->request_time;
	if (final) {
		service->figures.last_final = now - search->request_time;
		service->figures.cancelled += plan->status == PLAN_MESSAGE_CANCELLED;
	}
	post(service, plan);
	pthread_mutex_unlock(&service->lock);
	search->last_sent = now;
}

/* A live budget counts from the request's arrival to the answer. */
static void spend(struct plan_request *request, double request_time)
{
	if (request->budget.seconds <= 0)
		return;
	double left = request_time + request->budget.seconds - ANSWER_TIME - clock_seconds();
	request->budget.seconds = left > LEAST_TIME ? left : LEAST_TIME;
}

static void on_progress(void *context, const struct plan_result *result)
{
	struct search *search = context;
	struct planner_service *service = search->service;
	if (search->sequence > 0 && clock_seconds() - search->last_sent < IMPROVEMENT_PERIOD)
		return;
	plan_message_fill(&service->draft, result, &service->config->table, &service->config->model, service->scratch);
	send_plan(search, false);
}

static void run_search(struct planner_service *service, struct asked *asked)
{
	char err[sizeof service->draft.reason] = "";
	struct search search = {service, 0, asked->time, clock_seconds(), 0};
	struct plan_result result = {0};
	plan_message_begin(&service->draft, &asked->message);
	spend(&asked->request, asked->time);
	int r = planner_run(service->planner, &asked->request, on_progress, &search, &result, err, sizeof err);
	if (r == -EINVAL) {
		service->draft.status = PLAN_MESSAGE_REFUSED;
		service->draft.entry_count = 0;
		pthread_mutex_lock(&service->lock);
		service->figures.refused++;
		pthread_mutex_unlock(&service->lock);
	} else {
		plan_message_fill(&service->draft, &result, &service->config->table, &service->config->model,
				  service->scratch);
		if (r == -ECANCELED) {
			service->draft.status = PLAN_MESSAGE_CANCELLED;
			snprintf(err, sizeof err, "%s", REPLACED);
		} else if (service->draft.status == PLAN_MESSAGE_NONE) {
			snprintf(err, sizeof err, "no shot found");
		}
	}
	text_set(service->draft.reason, sizeof service->draft.reason, err);
	send_plan(&search, true);
}

static void *search_thread(void *context)
{
	struct planner_service *service = context;
	struct asked asked;
	pthread_mutex_lock(&service->lock);
	while (!service->stop) {
		if (!service->has_request) {
			pthread_cond_wait(&service->wake, &service->lock);
			continue;
		}
		asked = service->asked;
		service->has_request = false;
		service->busy = true;
		asked.request.run = ++service->run;
		pthread_mutex_unlock(&service->lock);
		double began = clock_seconds(), cpu = thread_seconds();
		run_search(service, &asked);
		pthread_mutex_lock(&service->lock);
		service->figures.searched += clock_seconds() - began;
		service->figures.manager += thread_seconds() - cpu;
		service->busy = false;
	}
	pthread_mutex_unlock(&service->lock);
	return NULL;
}

static struct planner_def define(const struct config *config)
{
	const struct config_planner *planner = &config->planner;
	long cores = sysconf(_SC_NPROCESSORS_ONLN);
	struct planner_def def = planner_def_default();
	def.table = &config->table;
	def.model = config->model;
	def.profile = config->profile;
	def.workers = planner->workers ? planner->workers : cores > 2 ? (int)cores - 1 : 1;
	if (def.workers > PLAN_WORKERS_MAX)
		def.workers = PLAN_WORKERS_MAX;
	if (planner->memory)
		def.memory = planner->memory;
	def.scheme = planner->scheme;
	def.sync_period = planner->sync_period;
	/* A window for each worker and one for the manager must fit into a period. */
	/* A hair less, so that rounding does not make them too many. */
	double longest = def.sync_period / (def.workers + 1) * (1 - 1e-9);
	def.sync_window = planner->sync_window > 0 && planner->sync_window < longest ? planner->sync_window : longest;
	def.progress_plans = 1; /* each costs simulations for its keyframes: all of them come with the final answer */
	def.result_plans = PLAN_MESSAGE_ENTRIES;
	return def;
}

int planner_service_create(struct planner_service **out, const struct config *config, char *err, size_t err_size)
{
	*out = NULL;
	struct planner_service *service = calloc(1, sizeof *service);
	if (!service) {
		snprintf(err, err_size, "out of memory");
		return -ENOMEM;
	}
	service->config = config;
	pthread_mutex_init(&service->lock, NULL);
	pthread_cond_init(&service->wake, NULL);
	service->descriptor = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
	service->scratch = malloc(PLAN_TRACE_MAX * sizeof service->scratch[0]);
	struct planner_def def = define(config);
	def.now = search_clock;
	int r = service->descriptor < 0 ? -errno
		: !service->scratch	? -ENOMEM
					: planner_create(&service->planner, &def);
	if (r == 0)
		r = -pthread_create(&service->thread, NULL, search_thread, service);
	if (r < 0) {
		snprintf(err, err_size, "planner: %s",
			 r == -EINVAL ? "memory_mib is too small for so many workers" : strerror(-r));
		planner_service_destroy(service);
		return r;
	}
	service->thread_runs = true;
	*out = service;
	return 0;
}

void planner_service_destroy(struct planner_service *service)
{
	if (!service)
		return;
	if (service->thread_runs) {
		pthread_mutex_lock(&service->lock);
		service->stop = true;
		service->has_request = false;
		planner_cancel(service->planner, UINT64_MAX);
		pthread_cond_signal(&service->wake);
		pthread_mutex_unlock(&service->lock);
		pthread_join(service->thread, NULL);
	}
	planner_destroy(service->planner);
	if (service->descriptor >= 0)
		close(service->descriptor);
	pthread_cond_destroy(&service->wake);
	pthread_mutex_destroy(&service->lock);
	free(service->scratch);
	free(service);
}

int planner_service_descriptor(const struct planner_service *service)
{
	return service->descriptor;
}

/* A request that is not worked on still ends with a final answer. Locked by the caller. */
static void answer_without_search(struct planner_service *service, const billiard_plan_request_t *request,
				  enum plan_message_status status, const char *reason)
{
	billiard_plan_t plan;
	plan_message_begin(&plan, request);
	plan.utime = clock_utime();
	plan.is_final = 1;
	plan.status = (int8_t)status;
	text_set(plan.reason, sizeof plan.reason, reason);
	post(service, &plan);
}

/* Ends what waits or runs. Locked by the caller. */
static void drop_present(struct planner_service *service)
{
	if (!service->has_request) {
		planner_cancel(service->planner, service->run);
		return;
	}
	answer_without_search(service, &service->asked.message, PLAN_MESSAGE_CANCELLED, REPLACED);
	service->figures.cancelled++;
	service->has_request = false;
}

/* Locked by the caller. */
static void answer_refused(struct planner_service *service, const billiard_plan_request_t *request, const char *reason)
{
	answer_without_search(service, request, PLAN_MESSAGE_REFUSED, reason);
	service->figures.refused++;
}

/* Locked by the caller. */
static void take(struct planner_service *service, const struct asked *asked)
{
	drop_present(service);
	service->figures.requests++;
	service->present_id = asked->message.id;
	service->last.request_id = 0;
	service->asked = *asked;
	service->has_request = true;
	pthread_cond_signal(&service->wake);
}

void planner_service_refuse(struct planner_service *service, const billiard_plan_request_t *request, const char *reason)
{
	pthread_mutex_lock(&service->lock);
	answer_refused(service, request, reason);
	pthread_mutex_unlock(&service->lock);
}

bool planner_service_request(struct planner_service *service, const billiard_plan_request_t *request)
{
	bool accepted = true;
	struct asked asked = {.message = *request, .time = clock_seconds()};
	char reason[sizeof service->draft.reason];
	int r = plan_request_from_message(&asked.request, request, &service->config->table, reason, sizeof reason);
	pthread_mutex_lock(&service->lock);
	bool idle = !service->busy && !service->has_request;
	bool recent = clock_seconds() - service->last_time < OUTDATED;
	if (r < 0) {
		/* A request that cannot be searched does not end one that can. */
		answer_refused(service, request, reason);
	} else if (request->id > service->present_id) {
		take(service, &asked);
	} else if (request->id == service->present_id) {
		/* Asked again: it runs, or its last answer was lost. */
		if (service->last.request_id == request->id && service->last.is_final)
			post(service, &service->last);
	} else if (idle && !recent) {
		/* Not late: the asker's clock was set back, or a recording is replayed. */
		take(service, &asked);
	} else {
		snprintf(reason, sizeof reason, "outdated: request %lld came after it", (long long)service->present_id);
		answer_without_search(service, request, PLAN_MESSAGE_CANCELLED, reason);
		service->figures.outdated++;
		accepted = false;
	}
	pthread_mutex_unlock(&service->lock);
	return accepted;
}

void planner_service_cancel(struct planner_service *service, int64_t id)
{
	pthread_mutex_lock(&service->lock);
	if (id == service->present_id)
		drop_present(service);
	pthread_mutex_unlock(&service->lock);
}

bool planner_service_answer(struct planner_service *service, billiard_plan_t *out)
{
	uint64_t drop;
	pthread_mutex_lock(&service->lock);
	bool any = service->answer_count > 0;
	if (any) {
		*out = service->answer[0];
		service->answer_count--;
		memmove(&service->answer[0], &service->answer[1],
			(size_t)service->answer_count * sizeof service->answer[0]);
	} else if (read(service->descriptor, &drop, sizeof drop) < 0) {
		any = false; /* nothing to reset */
	}
	pthread_mutex_unlock(&service->lock);
	return any;
}

void planner_service_figures(struct planner_service *service, struct planner_service_figures *out)
{
	pthread_mutex_lock(&service->lock);
	*out = service->figures;
	out->busy = service->busy;
	pthread_mutex_unlock(&service->lock);
	planner_figures(service->planner, &out->search);
	out->nodes = (int64_t)out->search.nodes;
	out->sims = (int64_t)out->search.sims;
}
