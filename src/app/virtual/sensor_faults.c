#include "app/virtual/sensor_faults.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static_assert((int)SENSOR_FAULT_COUNT == (int)VIRTUAL_FAULT_COUNT, "the configuration holds one pair for each");

static const char *const name[SENSOR_FAULT_COUNT] = {"drop",  "late",  "repeat",  "freeze", "dark", "bright",
						     "flash", "ghost", "missing", "knock",  "bits"};
static const double LENGTH_MAX = 600; /* s */

static uint64_t mix(uint64_t z)
{
	z += 0x9e3779b97f4a7c15u;
	z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
	z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
	return z ^ (z >> 31);
}

void sensor_faults_init(struct sensor_faults *faults, const struct config_virtual *def, double now)
{
	*faults = (struct sensor_faults){.seed = def->seed, .last = now};
	for (int i = 0; i < SENSOR_FAULT_COUNT; i++) {
		faults->rate[i] = def->fault[i][0] / 60;
		faults->length[i] = def->fault[i][1];
		faults->until[i] = -INFINITY;
	}
}

static void begin(struct sensor_faults *faults, int fault, double now, double length)
{
	faults->until[fault] = now + length;
	faults->number[fault]++;
}

void sensor_faults_frame(struct sensor_faults *faults, uint64_t frame, double now)
{
	double period = fmax(0, now - faults->last);
	faults->last = now;
	for (int i = 0; i < SENSOR_FAULT_COUNT; i++) {
		double chance = (double)(mix(faults->seed ^ mix(frame * 64 + (uint64_t)i)) >> 11) * 0x1p-53;
		if (chance < faults->rate[i] * period)
			begin(faults, i, now, faults->length[i]);
	}
}

bool sensor_faults_hold(const struct sensor_faults *faults, enum sensor_fault fault, double now)
{
	return now <= faults->until[fault];
}

uint64_t sensor_faults_random(const struct sensor_faults *faults, enum sensor_fault fault)
{
	return mix(faults->seed ^ mix(faults->number[fault] * 64 + (uint64_t)fault + 32));
}

bool sensor_faults_command(struct sensor_faults *faults, const char *text, double now)
{
	char word[16];
	double length;
	if (sscanf(text, "%15s %lf", word, &length) != 2 || !(length >= 0 && length <= LENGTH_MAX))
		return false;
	for (int i = 0; i < SENSOR_FAULT_COUNT; i++)
		if (strcmp(word, name[i]) == 0) {
			begin(faults, i, now, length);
			return true;
		}
	return false;
}
