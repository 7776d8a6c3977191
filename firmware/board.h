/* What a board provides: nine functions, which main.c alone calls, from one thread. Only
 * hydro_board_wait() blocks. */
#ifndef HYDRO_FIRMWARE_BOARD_H
#define HYDRO_FIRMWARE_BOARD_H

#include "firmware/sensors.h"

/* Puts the output to 0 V, then sets up clock, converters and link, and fills in the facts about the board.
 * Returns 0 to go on, or the program's exit code on boards that have one. */
int hydro_board_start(int argc, char** argv, struct hydro_board_facts* facts);

/* Waits for the next tick and sets `elapsed_ticks` and `overrun`. Returns false at the end, on boards that
 * have one. */
bool hydro_board_wait(struct hydro_readings* readings);

/* Reads all converters, as nearly at one time as the board can. */
void hydro_board_read(struct hydro_readings* readings);

/* Holds the output's terminal at this voltage from now on. Called first after the law, so that nothing
 * delays it. */
void hydro_board_write(float volts);

/* Takes bytes that have arrived on the link, up to `capacity`; on a link with datagrams, the next
 * datagram. Returns their number, 0: none. */
size_t hydro_board_receive(uint8_t* bytes, size_t capacity);

/* Marks the sender of the bytes last received as the computer: answers go there. Does nothing on a serial
 * line. */
void hydro_board_computer_is_here(void);

/* Sends a frame, or drops it when there is no room: never waits. With `to_asker`, sends it to the sender
 * of the bytes last received, whether that is the computer or not. */
void hydro_board_send(const uint8_t* bytes, size_t count, bool to_asker);

/* Restarts the hardware watchdog, which resets a processor whose program hangs. Called once in each tick. */
void hydro_board_alive(void);

/* Returns true once after the reset button of a board that has one in software: the device restarts, with
 * another boot number. */
bool hydro_board_was_reset(struct hydro_board_facts* facts);

#endif
