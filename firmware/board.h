/* What a board provides: nine functions, called by main.c alone and from one thread. None but hydro_board_wait() blocks. */
#ifndef HYDRO_FIRMWARE_BOARD_H
#define HYDRO_FIRMWARE_BOARD_H

#include "firmware/sensors.h"

/* Puts the output to 0 V, then sets up clock, converters and link, and says what the board is. Returns 0 to go on, or the
 * program's exit code where there is such a thing. */
int hydro_board_start(int argc, char** argv, struct hydro_board_facts* facts);

/* Waits for the next tick and sets `elapsed_ticks` and `overrun`. False: the end, on boards that have one. */
bool hydro_board_wait(struct hydro_readings* readings);

/* Reads all converters, at one time as nearly as the board can. */
void hydro_board_read(struct hydro_readings* readings);

/* Holds the output's terminal at so many volts from now on. The first act after the law: nothing delays it. */
void hydro_board_write(float volts);

/* Bytes that have arrived on the link, up to `capacity`; of a link with datagrams the next datagram. 0: none. */
size_t hydro_board_receive(uint8_t* bytes, size_t capacity);

/* The sender of the bytes last received is the computer: answers go there. Nothing to do on a serial line. */
void hydro_board_computer_is_here(void);

/* Sends a frame, or drops it where there is no room: never waits. `to_asker`: to the sender of the bytes last received,
 * whether it is the computer or not. */
void hydro_board_send(const uint8_t* bytes, size_t count, bool to_asker);

/* Restarts the hardware watchdog, which resets a processor whose program hangs. Called once in each tick. */
void hydro_board_alive(void);

/* True once after the reset button of a board that has one in software: the device begins anew, with another boot. */
bool hydro_board_was_reset(struct hydro_board_facts* facts);

#endif
