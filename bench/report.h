/* Measured numbers of a bench: printed as they come, kept in BUILD/bench.json, where the numbers of other benches stay.
 */
#ifndef BILLIARD_BENCH_REPORT_H
#define BILLIARD_BENCH_REPORT_H

struct report;

/* Opens BUILD/NAME (bench.json, eval.json); what it holds already is kept. Ends the program with a message when there
 * is no memory. */
struct report *report_open(const char *build, const char *name);
/* Prints and keeps one number. name: "area.what_unit"; a number of the same name is replaced. */
void report_number(struct report *report, const char *name, double value, const char *unit);
/* Writes the file and frees. 0, or -1 after a message on stderr. */
int report_close(struct report *report);

/* Runs run(context) again and again: as often as fills about 8 ms, that 30 times over; the least mean time of a run in
 * ns of this thread's CPU time (other load on the machine only ever adds). */
double bench_time(void (*run)(void *context), void *context);

#endif
