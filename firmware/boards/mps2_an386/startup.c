/* From reset to main(): vectors, memory, floating point. There is no C library. */
#include <stddef.h>
#include <stdint.h>

extern uint32_t data_load[], data_start[], data_end[], bss_start[], bss_end[], stack_top[];

int main(int argc, char** argv);
void board_tick(void);
void board_link_received(void);
void board_link_sent(void);
void board_converters_received(void);
void board_converters_sent(void);

/* GCC calls these for assignments of structs. */
void* memcpy(void* to, const void* from, size_t count) {
  for (size_t i = 0; i < count; ++i) ((volatile uint8_t*)to)[i] = ((const uint8_t*)from)[i];
  return to;
}

void* memset(void* to, int value, size_t count) {
  for (size_t i = 0; i < count; ++i) ((volatile uint8_t*)to)[i] = (uint8_t)value;
  return to;
}

/* A program that has gone wrong restarts, with no settings and zero volts. */
static void start_again(void) {
  *(volatile uint32_t*)0xE000ED0C = 0x05FA0004; /* SYSRESETREQ */
  for (;;) {
  }
}

void reset_handler(void) {
  *(volatile uint32_t*)0xE000ED88 |= 0xFU << 20; /* coprocessors 10 and 11: the floating-point unit */
  __asm volatile("dsb\n isb");
  memcpy(data_start, data_load, (size_t)((uint8_t*)data_end - (uint8_t*)data_start));
  memset(bss_start, 0, (size_t)((uint8_t*)bss_end - (uint8_t*)bss_start));
  main(0, NULL);
  start_again();
}

typedef void (*handler)(void);

/* The initial stack pointer, 15 exceptions, then the UARTs' interrupts: receive and send of each. */
__attribute__((section(".vectors"), used)) static const struct {
  uint32_t* stack;
  handler exceptions[15];
  handler interrupts[4];
} vectors = {
    .stack = stack_top,
    .exceptions = {reset_handler, start_again, start_again, start_again, start_again, start_again,
                   start_again, start_again, start_again, start_again, start_again, start_again, start_again,
                   start_again, board_tick},
    .interrupts = {board_link_received, board_link_sent, board_converters_received, board_converters_sent}};
