/* A front end that is a process: for tests, and for users to try the protocol without hardware. Its
 * converters are those of a simulator behind a second link, or have constant values. It is no real-time
 * machine: a late wake-up counts as several ticks. */
#include "firmware/board.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "firmware/boards/converter_link.h"
#include "firmware/boards/posix/link.h"

static const char kHelp[] =
    "A front end as a process: the firmware of a microcontroller beside the machine, on this computer. For "
    "trying and tests.\n"
    "Usage: hydro-front-end [OPTIONS] LINK\n"
    "\n"
    "Positionals:\n"
    "  LINK TEXT REQUIRED          to the computer: pty, pty:PATH, unix:PATH, udp:PORT or udp:ADDRESS:PORT\n"
    "\n"
    "Options:\n"
    "  --version                   print the version and exit\n"
    "  -h,--help                   print this and exit\n"
    "  --converters LINK           to a simulator of the machine; without it the inputs hold 1 V and the "
    "counters 0\n"
    "  --rate HZ                   ticks a second, 1 to 20000 (default 1000)\n"
    "  --tick-by-converters        a tick for each set of values that the simulator sends, and no clock\n"
    "\n"
    "Examples:\n"
    "  hydro-front-end pty:/tmp/front_end\n"
    "  hydro-front-end udp:7700 --converters udp:7701 --rate 5000\n"
    "More: docs/front_end.md\n";

static struct link computer, machine;
static struct hydro_converter_link converters;
static float written_V;
static unsigned long rate_hz = 1000;
static bool tick_by_converters;
static int64_t next_tick_ns;
static volatile sig_atomic_t ended, reset;

static void close_links(void) {
  link_close(&computer);
  link_close(&machine);
}

static void on_end(int number) {
  (void)number;
  ended = 1;
}

static void on_reset(int number) {
  (void)number;
  reset = 1;
}

static int64_t now_ns(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static int refuse(const char* option, const char* found, const char* allowed) {
  fprintf(stderr, "hydro-front-end: %s: found %s, allowed %s; see --help\n", option, found, allowed);
  return 2;
}

// Prints what was asked for. Returns the exit code.
static int say(const char* text) {
  if (fputs(text, stdout) >= 0 && fflush(stdout) == 0) return 0;
  fprintf(stderr, "hydro-front-end: the standard output cannot be written: %s\n", strerror(errno));
  return 1;
}

static const char kRates[] = "are 1 to 20000 ticks a second, e.g. --rate 5000";

static int read_options(int argc, char** argv, const char** link, const char** converter_link) {
  for (int i = 1; i < argc; ++i) {
    const char* value = i + 1 < argc && argv[i + 1][0] != '-' ? argv[i + 1] : NULL;
    if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) {
      exit(say(kHelp));
    } else if (strcmp(argv[i], "--version") == 0) {
      exit(say("hydro-front-end " HYDRO_VERSION "\n"));
    } else if (strcmp(argv[i], "--converters") == 0) {
      if (!value) return refuse("--converters", "no LINK", "one to a simulator, e.g. --converters udp:7701");
      *converter_link = argv[++i];
    } else if (strcmp(argv[i], "--rate") == 0) {
      if (!value) return refuse("--rate", "no number", kRates);
      char* end = NULL;
      rate_hz = strtoul(argv[++i], &end, 10);
      const bool number = argv[i][0] >= '0' && argv[i][0] <= '9' && *end == '\0';
      if (!number || rate_hz < 1 || rate_hz > 20000) return refuse("--rate", argv[i], kRates);
    } else if (strcmp(argv[i], "--tick-by-converters") == 0) {
      tick_by_converters = true;
    } else if (argv[i][0] == '-' || *link) {
      return refuse("arguments", argv[i], "are one LINK, --converters, --rate, --tick-by-converters");
    } else {
      *link = argv[i];
    }
  }
  if (!*link)
    return refuse(
        "LINK", "nothing",
        "are pty, pty:PATH, unix:PATH, udp:PORT and udp:ADDRESS:PORT, e.g. hydro-front-end udp:7700");
  if (tick_by_converters && !*converter_link)
    return refuse("--tick-by-converters", "no --converters", "are both together");
  return 0;
}

/* Where descriptors 0 to 2 were closed, a link would get one of their numbers, and what is printed would be
 * sent to the computer. Each is opened for the opposite of its use, so that using it still fails. */
static bool open_standard_descriptors(void) {
  for (int standard = 0; standard <= 2; ++standard) {
    if (fcntl(standard, F_GETFD) >= 0) continue;
    if (open("/dev/null", standard == 0 ? O_WRONLY : O_RDONLY) != standard) return false;
  }
  return true;
}

int hydro_board_start(int argc, char** argv, struct hydro_board_facts* facts) {
  if (!open_standard_descriptors()) return 1;
  const char *link = NULL, *converter_link = NULL;
  const int code = read_options(argc, argv, &link, &converter_link);
  if (code != 0) return code;
  if (!link_open(&computer, "link", link)) return 2;
  atexit(close_links);
  if (converter_link && !link_open(&machine, "converters", converter_link)) return 2;
  fflush(stdout);
  const struct sigaction end = {.sa_handler = on_end}, again = {.sa_handler = on_reset};
  sigaction(SIGINT, &end, NULL);
  sigaction(SIGTERM, &end, NULL);
  sigaction(SIGHUP, &end, NULL);
  sigaction(SIGUSR1, &again, NULL);
  hydro_converter_link_begin(&converters, (uint32_t)(rate_hz + 3) / 4);
  next_tick_ns = now_ns();
  *facts = (struct hydro_board_facts){.name = "posix",
                                      .tick_rate_hz = (uint32_t)rate_hz,
                                      .boot = (uint32_t)(next_tick_ns / 1000) | 1,
                                      .analog_inputs = HYDRO_ANALOG_INPUTS,
                                      .counters = HYDRO_COUNTERS,
                                      .datagrams = computer.kind == LINK_UDP,
                                      .analog_min_V = -10,
                                      .analog_max_V = 10,
                                      .output_min_V = -10,
                                      .output_max_V = 10};
  return 0;
}

/* Takes the values that the simulator has sent; the newest ones count. */
static void receive_converters(void) {
  uint8_t bytes[512];
  for (size_t chunk = 0; chunk < 8; ++chunk) {
    const size_t count = link_receive(&machine, bytes, sizeof bytes);
    if (count == 0) return;
    machine.peer = machine.asker;
    for (size_t i = 0; i < count; ++i) hydro_converter_link_take(&converters, bytes[i]);
    if (machine.kind == LINK_UDP) hydro_receive_anew(&converters.receiver);
  }
}

/* The simulator's values set the pace. */
static bool wait_for_converters(void) {
  while (!ended && !converters.arrived) {
    struct pollfd wanted = {.fd = machine.fd >= 0 ? machine.fd : machine.listening, .events = POLLIN};
    poll(&wanted, 1, 100);
    receive_converters();
  }
  return !ended;
}

bool hydro_board_wait(struct hydro_readings* readings) {
  readings->overrun = false;
  readings->elapsed_ticks = 1;
  if (tick_by_converters) return wait_for_converters();
  const int64_t period = 1000000000 / (int64_t)rate_hz;
  next_tick_ns += period;
  const struct timespec until = {.tv_sec = next_tick_ns / 1000000000, .tv_nsec = next_tick_ns % 1000000000};
  while (!ended && clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL) == EINTR) {
  }
  const int64_t late = (now_ns() - next_tick_ns) / period;
  if (late > 0) {
    readings->elapsed_ticks += (uint32_t)late;
    next_tick_ns += late * period;
  }
  return !ended;
}

/* Without a simulator: inputs of 1 V, counters of 0, and an output that holds the written voltage. */
static void hold_still(struct hydro_readings* readings) {
  readings->answered = readings->interlock_closed = true;
  readings->read_back_V = written_V;
  for (size_t i = 0; i < HYDRO_ANALOG_INPUTS; ++i) readings->analog_V[i] = 1;
}

void hydro_board_read(struct hydro_readings* readings) {
  if (machine.kind == LINK_NONE) {
    hold_still(readings);
    return;
  }
  if (!tick_by_converters) receive_converters();
  hydro_converter_link_read(&converters, readings);
}

void hydro_board_write(float volts) {
  written_V = volts;
  uint8_t wire[HYDRO_WIRE_MAX];
  link_send(&machine, wire, hydro_converter_link_output(&converters, volts, wire), &machine.peer);
}

size_t hydro_board_receive(uint8_t* bytes, size_t capacity) {
  return link_receive(&computer, bytes, capacity);
}

void hydro_board_computer_is_here(void) { computer.peer = computer.asker; }

void hydro_board_send(const uint8_t* bytes, size_t count, bool to_asker) {
  link_send(&computer, bytes, count, to_asker ? &computer.asker : &computer.peer);
}

void hydro_board_alive(void) {} /* the user of the operating system can end a process that hangs */

bool hydro_board_was_reset(struct hydro_board_facts* facts) {
  if (!reset) return false;
  reset = 0;
  ++facts->boot;
  written_V = 0;
  return true;
}
