/* A link of the posix board: a pseudo terminal, a Unix socket or a UDP port that others connect to. */
#ifndef HYDRO_FIRMWARE_BOARDS_POSIX_LINK_H
#define HYDRO_FIRMWARE_BOARDS_POSIX_LINK_H

#include <netinet/in.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum link_kind { LINK_NONE, LINK_PTY, LINK_UNIX, LINK_UDP };

struct link {
  enum link_kind kind;
  int fd;                   /* pseudo terminal, connected Unix socket (-1: nobody is), UDP socket */
  int listening;            /* of a Unix socket */
  char path[108];           /* to remove at the end; "": nothing */
  struct sockaddr_in peer;  /* UDP: where answers go; port 0: nowhere yet */
  struct sockaddr_in asker; /* UDP: where the last datagram came from */
};

/* Opens "pty", "pty:PATH" (PATH becomes a symbolic link to the terminal), "unix:PATH" or "udp:PORT" (of 127.0.0.1; with
 * "udp:ADDRESS:PORT" of that address). Prints where it is found after `name`. False: one line on stderr says why not. */
bool link_open(struct link* link, const char* name, const char* url);

/* What has arrived, without waiting; 0: nothing. Takes the next connection of a Unix socket whose last one has ended. */
size_t link_receive(struct link* link, uint8_t* bytes, size_t capacity);

/* Drops what has no room. */
void link_send(struct link* link, const uint8_t* bytes, size_t count, const struct sockaddr_in* to);

void link_close(struct link* link);

#endif
