/* A bus that nobody else hears: for tools that start services of their own. */
#ifndef BILLIARD_APP_PRIVATE_BUS_H
#define BILLIARD_APP_PRIVATE_BUS_H

#include <stddef.h>

enum { PRIVATE_BUS_URL_SIZE = 96 };

/* Takes this process (which must have no threads yet) and its later children into a network of their own with nothing but
 * a loopback device; where that is not allowed, picks another port on the host's. url: the bus to open then. */
void private_bus(char *url, size_t size);

#endif
