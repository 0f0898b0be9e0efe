#include "search/scheme.h"

#include <string.h>

static const char *const names[SCHEME_COUNT] = {"batch", "windows", "queue", "steal"};

const char *scheme_name(enum plan_scheme scheme)
{
	return names[scheme];
}

bool scheme_from_name(const char *name, enum plan_scheme *out)
{
	for (int i = 0; i < SCHEME_COUNT; i++)
		if (strcmp(name, names[i]) == 0) {
			*out = (enum plan_scheme)i;
			return true;
		}
	return false;
}
