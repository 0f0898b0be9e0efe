/* What goes wrong between the virtual camera's lens and the bus: which faults hold in a frame. Pure; same seed and frames, same faults. */
#ifndef BILLIARD_APP_SENSOR_FAULTS_H
#define BILLIARD_APP_SENSOR_FAULTS_H

#include "app/config/config.h"

enum sensor_fault {
	FAULT_DROP,    /* frames are lost */
	FAULT_LATE,    /* frames come when the fault ends, all but the last lost */
	FAULT_REPEAT,  /* each frame comes twice */
	FAULT_FREEZE,  /* the same picture with new times */
	FAULT_DARK,    /* underexposed to an eighth */
	FAULT_BRIGHT,  /* overexposed threefold */
	FAULT_FLASH,   /* nothing but white */
	FAULT_GHOST,   /* a ball is seen where there is none */
	FAULT_MISSING, /* a ball is not seen */
	FAULT_KNOCK,   /* the camera is turned by a few pixels; back when the fault ends */
	FAULT_BITS,    /* bits of the JPEG are flipped */
	SENSOR_FAULT_COUNT
};

struct sensor_faults {
	double rate[SENSOR_FAULT_COUNT], length[SENSOR_FAULT_COUNT]; /* 1/s, s */
	double until[SENSOR_FAULT_COUNT];			     /* s, caller's clock */
	uint64_t number[SENSOR_FAULT_COUNT];			     /* how often each came so far */
	uint64_t seed;
	double last; /* s, of the frame before */
};

void sensor_faults_init(struct sensor_faults *faults, const struct config_virtual *def, double now);
/* Decides which begin with this frame. now: s, never backwards. */
void sensor_faults_frame(struct sensor_faults *faults, uint64_t frame, double now);
/* Whether it holds at now. */
bool sensor_faults_hold(const struct sensor_faults *faults, enum sensor_fault fault, double now);
/* A number that belongs to the present one of its kind: which ball, how far. */
uint64_t sensor_faults_random(const struct sensor_faults *faults, enum sensor_fault fault);
/* "drop 0.5": begins one now, for so many seconds. False: no such fault, or no such time. */
bool sensor_faults_command(struct sensor_faults *faults, const char *text, double now);

#endif
