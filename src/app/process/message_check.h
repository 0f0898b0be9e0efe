/* What the numbers of a message may be: one table a type, in which each count, array and number has a line. The bus checks every message
 * by its table before anybody sees it, so that what comes after takes checked things. Pure. */
#ifndef BILLIARD_APP_MESSAGE_CHECK_H
#define BILLIARD_APP_MESSAGE_CHECK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum member_kind { MEMBER_INT8, MEMBER_INT16, MEMBER_INT32, MEMBER_INT64, MEMBER_DOUBLE, MEMBER_MESSAGE };

/* One member: a number, an array of them, or messages within the message. */
struct message_member {
	const char *name;
	enum member_kind kind;
	size_t offset, size; /* bytes; size: of one element */
	int count;	     /* elements; 1: no array */
	const char *counted; /* member before this one that says how many elements hold; NULL: all */
	double low, high; /* both allowed; NaN never is. An end of -INFINITY or INFINITY allows every finite number */
	const struct message_table *table; /* of MEMBER_MESSAGE */
};

struct message_table {
	const struct message_member *member;
	int count;
};

/* True when all members are in range; else the first that is not is named: "balls[3].x: found nan, allowed -10..10". */
bool message_check(const struct message_table *table, const void *message, char *reason, size_t reason_size);

#endif
