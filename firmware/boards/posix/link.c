#include "firmware/boards/posix/link.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <termios.h>
#include <unistd.h>

enum { MOST_EMPTY = 64 };

static bool fails(const char* name, const char* url, const char* what) {
  fprintf(stderr, "hydro-front-end: %s: found %s: %s (%s)\n", name, url, what, strerror(errno));
  return false;
}

/* What lstat() tells one file from another by. */
static bool is_own(const struct link* link) {
  struct stat found;
  return lstat(link->path, &found) == 0 && found.st_dev == link->device && found.st_ino == link->inode;
}

static void remember(struct link* link, const char* path) {
  struct stat made;
  if (lstat(path, &made) != 0) return;
  strcpy(link->path, path);
  link->device = made.st_dev;
  link->inode = made.st_ino;
}

/* Removes the link to a terminal that a killed board has left. A terminal that is there may be another
 * board's, and a link to anything else is the user's. */
static void remove_stale_link(const char* path) {
  char target[16] = "";
  struct stat found;
  if (readlink(path, target, sizeof target - 1) < 0 || strncmp(target, "/dev/pts/", 9) != 0) return;
  if (stat(path, &found) != 0 && errno == ENOENT) unlink(path);
}

/* Removes the socket that a killed board has left: nobody listens there. */
static void remove_stale_socket(const struct sockaddr_un* address) {
  struct stat found;
  if (lstat(address->sun_path, &found) != 0 || !S_ISSOCK(found.st_mode)) return;
  const int probe = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (probe < 0) return;
  if (connect(probe, (const struct sockaddr*)address, sizeof *address) != 0 && errno == ECONNREFUSED)
    unlink(address->sun_path);
  close(probe);
}

static bool open_pty(struct link* link, const char* name, const char* url) {
  if (url[3] == ':') remove_stale_link(url + 4); /* before a terminal of the same number is opened */
  link->fd = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (link->fd < 0 || grantpt(link->fd) != 0 || unlockpt(link->fd) != 0) {
    return fails(name, url, "no pseudo terminal to be had");
  }
  const char* terminal = ptsname(link->fd);
  /* The board itself keeps the terminal open, so that the line persists while no other process has it
   * open, as a cable does. */
  const int held = open(terminal, O_RDWR | O_NOCTTY | O_CLOEXEC);
  struct termios mode;
  if (held < 0 || tcgetattr(held, &mode) != 0)
    return fails(name, url, "the pseudo terminal cannot be opened");
  cfmakeraw(&mode);
  tcsetattr(held, TCSANOW, &mode);
  if (url[3] == ':') {
    const char* path = url + 4;
    if (strlen(path) >= sizeof link->path) return fails(name, url, "the path is too long");
    if (symlink(terminal, path) != 0)
      return fails(
          name, url,
          "the symbolic link cannot be made; allowed is a path where nothing is, in a folder that is there");
    remember(link, path);
    terminal = path;
  }
  printf("%s %s\n", name, terminal);
  return true;
}

static bool open_unix(struct link* link, const char* name, const char* url) {
  struct sockaddr_un address = {.sun_family = AF_UNIX};
  const char* path = url + 5;
  if (path[0] == '\0' || strlen(path) >= sizeof address.sun_path) {
    errno = EINVAL;
    return fails(name, url, "a path of 1 to 107 characters is allowed");
  }
  strcpy(address.sun_path, path);
  remove_stale_socket(&address);
  link->fd = -1;
  link->listening = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (link->listening < 0 || bind(link->listening, (struct sockaddr*)&address, sizeof address) != 0 ||
      listen(link->listening, 1) != 0) {
    return fails(name, url,
                 "the socket cannot be made; allowed is a path where nothing is and no board listens");
  }
  remember(link, path);
  printf("%s %s\n", name, path);
  return true;
}

static bool open_udp(struct link* link, const char* name, const char* url) {
  char host[64] = "127.0.0.1";
  const char* port_text = strrchr(url, ':') + 1;
  const size_t host_length = port_text > url + 4 ? (size_t)(port_text - 1 - (url + 4)) : 0;
  struct sockaddr_in address = {.sin_family = AF_INET};
  char* end = NULL;
  const unsigned long port = strtoul(port_text, &end, 10);
  errno = EINVAL;
  if (host_length >= sizeof host || port_text[0] < '0' || port_text[0] > '9' || *end != '\0' ||
      port > 65535) {
    return fails(name, url, "allowed are udp:PORT and udp:ADDRESS:PORT, ports 0 (a free one) to 65535");
  }
  if (host_length > 0) {
    memcpy(host, url + 4, host_length);
    host[host_length] = '\0';
  }
  if (inet_pton(AF_INET, host, &address.sin_addr) != 1)
    return fails(name, url, "no IPv4 address; allowed are udp:PORT and udp:ADDRESS:PORT");
  address.sin_port = htons((uint16_t)port);
  link->fd = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  socklen_t size = sizeof address;
  if (link->fd < 0 || bind(link->fd, (struct sockaddr*)&address, sizeof address) != 0 ||
      getsockname(link->fd, (struct sockaddr*)&address, &size) != 0) {
    return fails(name, url,
                 "the port cannot be opened; allowed is an address of this computer with a port that nobody "
                 "has (0: any)");
  }
  printf("%s udp:%s:%d\n", name, host, ntohs(address.sin_port));
  return true;
}

bool link_open(struct link* link, const char* name, const char* url) {
  *link = (struct link){.fd = -1, .listening = -1};
  if (strcmp(url, "pty") == 0 || strncmp(url, "pty:", 4) == 0) {
    link->kind = LINK_PTY;
    return open_pty(link, name, url);
  }
  if (strncmp(url, "unix:", 5) == 0) {
    link->kind = LINK_UNIX;
    return open_unix(link, name, url);
  }
  if (strncmp(url, "udp:", 4) == 0) {
    link->kind = LINK_UDP;
    return open_udp(link, name, url);
  }
  errno = EINVAL;
  return fails(name, url, "allowed are pty, pty:PATH, unix:PATH, udp:PORT and udp:ADDRESS:PORT");
}

/* Empty datagrams hide none that wait behind them, and no flood of them holds a tick. */
static size_t receive_datagram(struct link* link, uint8_t* bytes, size_t capacity) {
  for (size_t tries = 0; tries < MOST_EMPTY; ++tries) {
    socklen_t size = sizeof link->asker;
    const ssize_t count = recvfrom(link->fd, bytes, capacity, 0, (struct sockaddr*)&link->asker, &size);
    if (count != 0) return count > 0 ? (size_t)count : 0;
  }
  return 0;
}

size_t link_receive(struct link* link, uint8_t* bytes, size_t capacity) {
  if (link->kind == LINK_NONE) return 0;
  if (link->kind == LINK_UNIX && link->fd < 0) {
    link->fd = accept4(link->listening, NULL, NULL, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (link->fd < 0) return 0;
  }
  if (link->kind == LINK_UDP) return receive_datagram(link, bytes, capacity);
  const ssize_t count = read(link->fd, bytes, capacity);
  const bool ended = count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR);
  if (link->kind == LINK_UNIX && ended) {
    close(link->fd);
    link->fd = -1;
  }
  return count > 0 ? (size_t)count : 0;
}

void link_send(struct link* link, const uint8_t* bytes, size_t count, const struct sockaddr_in* to) {
  if (link->kind == LINK_NONE || link->fd < 0) return;
  ssize_t sent = 0;
  if (link->kind == LINK_PTY) sent = write(link->fd, bytes, count);
  if (link->kind == LINK_UNIX) sent = send(link->fd, bytes, count, MSG_NOSIGNAL);
  if (link->kind == LINK_UDP && to->sin_port != 0) {
    sent = sendto(link->fd, bytes, count, 0, (const struct sockaddr*)to, sizeof *to);
  }
  (void)sent; /* bytes without room are lost, as on any wire; the frame's number shows it */
}

void link_close(struct link* link) {
  if (link->kind == LINK_NONE) return;
  if (link->path[0] != '\0' && is_own(link)) unlink(link->path);
  if (link->fd >= 0) close(link->fd);
  if (link->listening >= 0) close(link->listening);
}
