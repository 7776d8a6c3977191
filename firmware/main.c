/* The program of every board: in each tick it receives, reads, judges, writes and sends. */
#include "firmware/board.h"
#include "firmware/device.h"

enum { CHUNK_BYTES = 512, CHUNKS_A_TICK = 8 };

static struct hydro_device device;

/* Takes a bounded amount of what has arrived, so that a flood delays no tick. The rest waits for the next
 * tick. */
static void receive(void) {
  static uint8_t bytes[CHUNK_BYTES];
  for (size_t chunk = 0; chunk < CHUNKS_A_TICK; ++chunk) {
    const size_t count = hydro_board_receive(bytes, sizeof bytes);
    if (count == 0) return;
    bool computer = false;
    for (size_t i = 0; i < count; ++i) computer = hydro_device_receive(&device, bytes[i]) || computer;
    if (computer) hydro_board_computer_is_here();
    if (device.facts.datagrams) hydro_receive_anew(&device.receiver);
    if (device.owes_identity) {
      uint8_t wire[HYDRO_WIRE_MAX];
      hydro_board_send(wire, hydro_device_send(&device, wire), true);
    }
  }
}

static void send(void) {
  static uint8_t wire[HYDRO_WIRE_MAX];
  for (size_t frame = 0; frame < 3; ++frame) {
    const size_t count = hydro_device_send(&device, wire);
    if (count == 0) return;
    hydro_board_send(wire, count, false);
  }
}

int main(int argc, char** argv) {
  struct hydro_board_facts facts = {0};
  const int code = hydro_board_start(argc, argv, &facts);
  if (code != 0) return code;
  hydro_device_begin(&device, &facts);
  struct hydro_readings readings = {0};
  while (hydro_board_wait(&readings)) { /* the only loop without a bound: the program itself */
    if (hydro_board_was_reset(&facts)) hydro_device_begin(&device, &facts);
    receive();
    hydro_board_read(&readings);
    hydro_board_write(hydro_device_tick(&device, &readings));
    send();
    hydro_board_alive();
  }
  hydro_board_write(device.zero_volts);
  return 0;
}
