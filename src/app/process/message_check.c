#include "app/process/message_check.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Where in a message, for the reason: "entries[0].shots[1].". */
struct message_place {
	char path[64];
	char *reason;
	size_t reason_size;
};

static double value_at(enum member_kind kind, const void *at)
{
	switch (kind) {
	case MEMBER_INT8:
		return *(const int8_t *)at;
	case MEMBER_INT16:
		return *(const int16_t *)at;
	case MEMBER_INT32:
		return *(const int32_t *)at;
	case MEMBER_INT64:
		return (double)*(const int64_t *)at;
	case MEMBER_DOUBLE:
		return *(const double *)at;
	case MEMBER_MESSAGE:
		break;
	}
	return NAN;
}

static const struct message_member *find(const struct message_table *table, const char *name)
{
	const struct message_member *member = table->member;
	while (strcmp(member->name, name) != 0)
		member++;
	return member;
}

/* Elements that hold. The member that counts them stands before, so it is in range. */
static int held(const struct message_table *table, const struct message_member *member, const uint8_t *message)
{
	if (!member->counted)
		return member->count;
	const struct message_member *counter = find(table, member->counted);
	return (int)value_at(counter->kind, message + counter->offset);
}

static void name_element(const struct message_member *member, int i, char *out, size_t size)
{
	if (member->count > 1)
		snprintf(out, size, "%s[%d]", member->name, i);
	else
		snprintf(out, size, "%s", member->name);
}

static bool refuse(const struct message_member *member, int i, double value, const struct message_place *place)
{
	char name[48], allowed[64];
	name_element(member, i, name, sizeof name);
	if (isinf(member->low))
		snprintf(allowed, sizeof allowed, "any finite number");
	else if (isinf(member->high))
		snprintf(allowed, sizeof allowed, "%.16g and more", member->low);
	else
		snprintf(allowed, sizeof allowed, "%.16g..%.16g", member->low, member->high);
	snprintf(place->reason, place->reason_size, "%s%s: found %.16g, allowed %s", place->path, name, value, allowed);
	return false;
}

static bool check(const struct message_table *table, const uint8_t *message, struct message_place *place);

static bool check_part(const struct message_member *member, int i, const uint8_t *at, const struct message_place *place)
{
	struct message_place within = {.reason = place->reason, .reason_size = place->reason_size};
	char name[48];
	name_element(member, i, name, sizeof name);
	snprintf(within.path, sizeof within.path, "%.15s%s.", place->path, name);
	return check(member->table, at, &within);
}

static bool check_member(const struct message_table *table, const struct message_member *member, const uint8_t *message,
			 const struct message_place *place)
{
	int count = held(table, member, message);
	for (int i = 0; i < count; i++) {
		const uint8_t *at = message + member->offset + (size_t)i * member->size;
		if (member->kind == MEMBER_MESSAGE) {
			if (!check_part(member, i, at, place))
				return false;
			continue;
		}
		double value = value_at(member->kind, at);
		if (!(isfinite(value) && value >= member->low && value <= member->high))
			return refuse(member, i, value, place);
	}
	return true;
}

static bool check(const struct message_table *table, const uint8_t *message, struct message_place *place)
{
	for (int i = 0; i < table->count; i++)
		if (!check_member(table, &table->member[i], message, place))
			return false;
	return true;
}

bool message_check(const struct message_table *table, const void *message, char *reason, size_t reason_size)
{
	struct message_place place = {.reason = reason, .reason_size = reason_size};
	return check(table, message, &place);
}
