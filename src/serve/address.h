/* Addresses at which the server listens, as given on the command line. */
#ifndef CAMBER_SERVE_ADDRESS_H
#define CAMBER_SERVE_ADDRESS_H

#include <stdbool.h>
#include <stddef.h>

enum { CAMBER_ADDRESS_SIZE = 80 };

/* Whether a text is ADDRESS:PORT. ADDRESS is an IPv4 address, an IPv6 address in brackets, or "localhost". Names are
 * not resolved. */
bool camber_address_is_valid(const char *text);
/* Listens at an address, and writes the address with the actual port, which the system chooses if the text has port 0.
 * Returns the socket, or a negated errno. */
int camber_address_listen(const char *text, char address[CAMBER_ADDRESS_SIZE]);

#endif
