/* ARM's MPS2 board with the image AN386: a Cortex-M4 with FPU at 25 MHz. It is meant for qemu-system-arm:
 * UART 0 is the link to the computer, UART 1 carries the converters' values to and from a simulator
 * (docs/front_end.md). */
#include "firmware/board.h"

#include "firmware/boards/converter_link.h"

#ifndef HYDRO_TICK_RATE_HZ
#define HYDRO_TICK_RATE_HZ 100 /* the byte rate of the emulator's UARTs allows no more */
#endif

enum { CLOCK_HZ = 25000000, RING_BYTES = 2048 }; /* a power of two */

/* CMSDK's UART, with one byte in each direction. */
struct uart {
  volatile uint32_t data;
  volatile uint32_t state;      /* bit 0: the byte to send is still there, bit 1: a byte was received */
  volatile uint32_t control;    /* bits 0, 1: send, receive; bits 2, 3: their interrupts */
  volatile uint32_t interrupts; /* bits 0, 1; writing a one clears */
  volatile uint32_t divider;    /* divides the clock, 16 or more */
};
enum { SENDING = 1, RECEIVED = 2, ENABLE_ALL = 15, SENT_INTERRUPT = 1, RECEIVED_INTERRUPT = 2 };

/* Bytes between an interrupt and the program: one side advances `put`, the other `taken`, and both count
 * on for ever. */
struct ring {
  volatile uint32_t put;
  volatile uint32_t taken;
  uint8_t bytes[RING_BYTES];
};

struct line {
  struct uart* uart;
  struct ring in;
  struct ring out;
};

static struct line computer = {.uart = (struct uart*)0x40004000};
static struct line machine = {.uart = (struct uart*)0x40005000};
static struct hydro_converter_link converters;
static volatile uint32_t ticks_due;
__attribute__((section(".noinit"))) static uint32_t boot;

static volatile uint32_t* const kSysTick = (volatile uint32_t*)0xE000E010; /* control, reload, value */
static volatile uint32_t* const kInterruptEnable = (volatile uint32_t*)0xE000E100;

static void received(struct line* line) {
  line->uart->interrupts = RECEIVED_INTERRUPT;
  if ((line->uart->state & RECEIVED) == 0) return;
  const uint8_t byte = (uint8_t)line->uart->data;
  if (line->in.put - line->in.taken == RING_BYTES) return; /* lost; the frame's checksum reveals it */
  line->in.bytes[line->in.put % RING_BYTES] = byte;
  line->in.put = line->in.put + 1;
}

static void send_next(struct line* line) {
  line->uart->interrupts = SENT_INTERRUPT;
  if (line->out.taken == line->out.put || (line->uart->state & SENDING) != 0) return;
  const uint8_t byte = line->out.bytes[line->out.taken % RING_BYTES];
  line->out.taken = line->out.taken + 1;
  line->uart->data = byte;
}

void board_link_received(void) { received(&computer); }
void board_link_sent(void) { send_next(&computer); }
void board_converters_received(void) { received(&machine); }
void board_converters_sent(void) { send_next(&machine); }
void board_tick(void) { ticks_due = ticks_due + 1; }

/* Sends all of a frame or nothing. This function sends the first byte, and each interrupt sends the next
 * one. */
static void send(struct line* line, const uint8_t* bytes, size_t count) {
  if (RING_BYTES - (line->out.put - line->out.taken) < count) return;
  for (size_t i = 0; i < count; ++i) line->out.bytes[(line->out.put + i) % RING_BYTES] = bytes[i];
  __asm volatile("cpsid i" ::: "memory");
  line->out.put = line->out.put + (uint32_t)count;
  send_next(line);
  __asm volatile("cpsie i" ::: "memory");
}

static size_t receive(struct line* line, uint8_t* bytes, size_t capacity) {
  const uint32_t there = line->in.put - line->in.taken;
  const size_t count = there < capacity ? there : capacity;
  for (size_t i = 0; i < count; ++i) bytes[i] = line->in.bytes[(line->in.taken + i) % RING_BYTES];
  line->in.taken = line->in.taken + (uint32_t)count;
  return count;
}

int hydro_board_start(int argc, char** argv, struct hydro_board_facts* facts) {
  (void)argc;
  (void)argv;
  hydro_converter_link_begin(&converters, HYDRO_TICK_RATE_HZ / 4);
  computer.uart->divider = machine.uart->divider = 16;
  computer.uart->control = machine.uart->control = ENABLE_ALL;
  *kInterruptEnable = 15;
  kSysTick[1] = CLOCK_HZ / HYDRO_TICK_RATE_HZ - 1;
  kSysTick[2] = 0;
  kSysTick[0] = 7; /* the processor's clock, with interrupt, on */
  hydro_board_write(0);
  *facts = (struct hydro_board_facts){.name = "mps2-an386",
                                      .tick_rate_hz = HYDRO_TICK_RATE_HZ,
                                      .boot = ++boot,
                                      .analog_inputs = HYDRO_ANALOG_INPUTS,
                                      .counters = HYDRO_COUNTERS,
                                      .analog_min_V = -10,
                                      .analog_max_V = 10,
                                      .output_min_V = -10,
                                      .output_max_V = 10};
  return 0;
}

bool hydro_board_wait(struct hydro_readings* readings) {
  __asm volatile("cpsid i" ::: "memory");
  readings->overrun = false; /* a late emulator is not the program's fault; real hardware: ticks_due > 0 */
  /* A pending interrupt ends the sleep although it is masked, so none is missed between the check and the
   * sleep. */
  while (ticks_due == 0) __asm volatile("wfi\n cpsie i\n isb\n cpsid i" ::: "memory");
  readings->elapsed_ticks = ticks_due;
  ticks_due = 0;
  __asm volatile("cpsie i" ::: "memory");
  return true;
}

void hydro_board_read(struct hydro_readings* readings) {
  static uint8_t bytes[RING_BYTES];
  const size_t count = receive(&machine, bytes, sizeof bytes);
  for (size_t i = 0; i < count; ++i) hydro_converter_link_take(&converters, bytes[i]);
  hydro_converter_link_read(&converters, readings);
}

void hydro_board_write(float volts) {
  uint8_t wire[HYDRO_WIRE_MAX];
  send(&machine, wire, hydro_converter_link_output(&converters, volts, wire));
}

size_t hydro_board_receive(uint8_t* bytes, size_t capacity) { return receive(&computer, bytes, capacity); }

void hydro_board_computer_is_here(void) {}

void hydro_board_send(const uint8_t* bytes, size_t count, bool to_asker) {
  (void)to_asker;
  send(&computer, bytes, count);
}

void hydro_board_alive(void) {} /* the emulated board has a watchdog too; an emulated motor needs none */

bool hydro_board_was_reset(struct hydro_board_facts* facts) {
  (void)facts;
  return false; /* the button restarts the program */
}
