/* Numeric addresses, and sockets that listen at them. */
#define _XOPEN_SOURCE 700

#include "serve/address.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { BACKLOG = 1024 };

typedef union any_address {
    struct sockaddr any;
    struct sockaddr_in four;
    struct sockaddr_in6 six;
} any_address;

static bool parse_port(const char *text, in_port_t *port) {
    const size_t digits = strspn(text, "0123456789");
    const long number = digits >= 1 && digits <= 5 && !text[digits] ? strtol(text, NULL, 10) : -1;
    if (number < 0 || number > 65535)
        return false;
    *port = htons((uint16_t)number);
    return true;
}

static bool parse(const char *text, any_address *address, socklen_t *size) {
    char host[CAMBER_ADDRESS_SIZE];
    const char *colon = strrchr(text, ':');
    in_port_t port;
    if (!colon || (size_t)(colon - text) >= sizeof host || !parse_port(colon + 1, &port))
        return false;
    memcpy(host, text, (size_t)(colon - text));
    host[colon - text] = 0;
    const size_t length = strlen(host);
    memset(address, 0, sizeof *address);
    if (length > 2 && host[0] == '[' && host[length - 1] == ']') {
        host[length - 1] = 0;
        address->six.sin6_family = AF_INET6;
        address->six.sin6_port = port;
        *size = sizeof address->six;
        return inet_pton(AF_INET6, host + 1, &address->six.sin6_addr) == 1;
    }
    address->four.sin_family = AF_INET;
    address->four.sin_port = port;
    *size = sizeof address->four;
    return inet_pton(AF_INET, strcmp(host, "localhost") == 0 ? "127.0.0.1" : host, &address->four.sin_addr) == 1;
}

bool camber_address_is_valid(const char *text) {
    any_address address;
    socklen_t size;
    return parse(text, &address, &size);
}

static void write_address(const any_address *address, char text[CAMBER_ADDRESS_SIZE]) {
    char host[INET6_ADDRSTRLEN] = "";
    const bool six = address->any.sa_family == AF_INET6;
    const void *from = six ? (const void *)&address->six.sin6_addr : (const void *)&address->four.sin_addr;
    (void)inet_ntop(address->any.sa_family, from, host, sizeof host);
    snprintf(text, CAMBER_ADDRESS_SIZE, six ? "[%s]:%u" : "%s:%u", host,
             (unsigned)ntohs(six ? address->six.sin6_port : address->four.sin_port));
}

int camber_address_listen(const char *text, char address[CAMBER_ADDRESS_SIZE]) {
    any_address wanted;
    socklen_t size;
    const int on = 1;
    if (!parse(text, &wanted, &size))
        return -EINVAL;
    const int made = socket(wanted.any.sa_family, SOCK_STREAM, 0);
    if (made < 0)
        return -errno;
    (void)setsockopt(made, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (fcntl(made, F_SETFD, FD_CLOEXEC) != 0 || bind(made, &wanted.any, size) != 0 || listen(made, BACKLOG) != 0 ||
        getsockname(made, &wanted.any, &size) != 0) {
        const int cause = errno;
        close(made);
        return -cause;
    }
    write_address(&wanted, address);
    return made;
}
