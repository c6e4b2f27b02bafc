/* Addresses that the server listens at, as the command line gives them. */
#ifndef CAMBER_SERVE_ADDRESS_H
#define CAMBER_SERVE_ADDRESS_H

#include <stdbool.h>
#include <stddef.h>

enum { CAMBER_ADDRESS_SIZE = 80 };

/* Whether a text is ADDRESS:PORT, where the address is of IPv4, of IPv6 in brackets, or "localhost". Names are not
 * looked up. */
bool camber_address_is_valid(const char *text);
/* Listens there and writes the address, with the port that the system gave where 0 was asked for. Returns the socket;
 * negative: an errno, negated. */
int camber_address_listen(const char *text, char address[CAMBER_ADDRESS_SIZE]);

#endif
