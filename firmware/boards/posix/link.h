/* A link of the posix board: a pseudo terminal, a Unix socket or a UDP port to which others connect. */
#ifndef HYDRO_FIRMWARE_BOARDS_POSIX_LINK_H
#define HYDRO_FIRMWARE_BOARDS_POSIX_LINK_H

#include <netinet/in.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

enum link_kind { LINK_NONE, LINK_PTY, LINK_UNIX, LINK_UDP };

struct link {
  enum link_kind kind;
  int fd;         /* pseudo terminal, connected Unix socket (-1: none is connected), UDP socket */
  int listening;  /* of a Unix socket */
  char path[108]; /* to remove at the end, if it is still what was made; "": nothing */
  dev_t device;
  ino_t inode;
  struct sockaddr_in peer;  /* UDP: the address to which answers go; port 0: none yet */
  struct sockaddr_in asker; /* UDP: the sender of the last datagram */
};

/* Opens "pty", "pty:PATH" (PATH becomes a symbolic link to the terminal), "unix:PATH" or "udp:PORT" (of
 * 127.0.0.1; with "udp:ADDRESS:PORT" of that address). Prints the link's address after `name`. When it
 * returns false, one line on stderr gives the reason. */
bool link_open(struct link* link, const char* name, const char* url);

/* Takes what has arrived, without waiting; returns 0 when there is nothing. When the connection of a Unix
 * socket has ended, takes the next one. */
size_t link_receive(struct link* link, uint8_t* bytes, size_t capacity);

/* Sends the bytes; drops those without room. */
void link_send(struct link* link, const uint8_t* bytes, size_t count, const struct sockaddr_in* to);

void link_close(struct link* link);

#endif
