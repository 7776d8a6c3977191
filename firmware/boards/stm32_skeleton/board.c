/* NOT TRIED: no STM32, Teensy or other microcontroller was ever connected. This is the outline of a board
 * with real converters, to be copied and filled in. It compiles; nothing else is known of it.
 *
 * It suits, for example, an STM32G4 or F4 made with CubeMX: an ADC whose sequence of conversions a timer
 * starts, with DMA into adc_codes; a DAC behind an amplifier that makes +/-10 V of its 0 to 3.3 V; two
 * timers in encoder mode; a UART or USB with rings that interrupts or DMA fill and empty; the independent
 * watchdog. The calls to HAL are declared below as yours_...(): write those.
 *
 * Before you connect the motor, check that the output is at 0 V from power-up on, with a reset held, and
 * with the processor halted in the debugger. A DAC that floats or holds its last value then needs a
 * pull-down, or an enable that the watchdog's pin gates. */
#include "firmware/board.h"

enum {
  TICK_RATE_HZ = 5000,
  ADC_INPUTS = 4,
  ADC_CODES = 4096, /* 12 bits */
  DAC_CODES = 4096
};
static const float kAdcMinimum_V = -10.0f,
                   kAdcMaximum_V = 10.0f; /* at the terminals, in front of the dividers */
static const float kDacMinimum_V = -10.0f, kDacMaximum_V = 10.0f;

/* Write these functions yourself. Only yours_wait_for_interrupt() may wait. */
void yours_clocks_and_pins(void);
void yours_dac_write(uint16_t code);
bool yours_adc_finished(void); /* the sequence that this tick started has ended, with ADC_INPUTS codes in: */
extern volatile uint16_t adc_codes[ADC_INPUTS]; /* filled by DMA */
bool yours_adc_failed(void);                    /* overrun or DMA error since the last call */
uint16_t yours_adc_read_back(void);      /* an input wired to the output's terminal, scaled as the others */
uint32_t yours_encoder(size_t timer);    /* the timer's count, 16 or 32 bits */
bool yours_enable_input_is_closed(void); /* emergency stop and amplifier's ready line */
size_t yours_link_read(uint8_t* bytes, size_t capacity);
bool yours_link_write(const uint8_t* bytes, size_t count); /* all of it or nothing */
void yours_independent_watchdog_start(uint32_t milliseconds);
void yours_independent_watchdog_refresh(void);
uint32_t yours_random_number(void);         /* or a counter in backup memory */
uint32_t yours_ticks_since_last_call(void); /* counted by the timer's interrupt */
void yours_wait_for_interrupt(void);

static float volts_of(uint16_t code) {
  return kAdcMinimum_V + (kAdcMaximum_V - kAdcMinimum_V) * (float)code / (float)(ADC_CODES - 1);
}

int hydro_board_start(int argc, char** argv, struct hydro_board_facts* facts) {
  (void)argc;
  (void)argv;
  yours_clocks_and_pins();
  hydro_board_write(0.0f);
  yours_independent_watchdog_start(10);
  *facts = (struct hydro_board_facts){.name = "stm32",
                                      .tick_rate_hz = TICK_RATE_HZ,
                                      .boot = yours_random_number(),
                                      .analog_inputs = ADC_INPUTS,
                                      .counters = HYDRO_COUNTERS,
                                      .analog_min_V = kAdcMinimum_V,
                                      .analog_max_V = kAdcMaximum_V,
                                      .output_min_V = kDacMinimum_V,
                                      .output_max_V = kDacMaximum_V};
  return 0;
}

bool hydro_board_wait(struct hydro_readings* readings) {
  uint32_t ticks = yours_ticks_since_last_call();
  readings->overrun = ticks > 0; /* this tick was due before the last one was finished */
  /* This loop needs no bound: if the timer has stopped, the independent watchdog resets the processor. */
  while (ticks == 0) {
    yours_wait_for_interrupt();
    ticks = yours_ticks_since_last_call();
  }
  readings->elapsed_ticks = ticks;
  return true;
}

void hydro_board_read(struct hydro_readings* readings) {
  /* The timer starts the conversions a little before the tick, so that they have ended by now. */
  readings->answered = yours_adc_finished() && !yours_adc_failed();
  for (size_t i = 0; i < ADC_INPUTS; ++i) readings->analog_V[i] = volts_of(adc_codes[i]);
  for (size_t i = 0; i < HYDRO_COUNTERS; ++i) readings->counter[i] = yours_encoder(i);
  readings->read_back_V = volts_of(yours_adc_read_back());
  readings->interlock_closed = yours_enable_input_is_closed();
}

void hydro_board_write(float volts) {
  float share = (volts - kDacMinimum_V) / (kDacMaximum_V - kDacMinimum_V);
  if (!(share >= 0.0f)) share = 0.0f; /* the device never requests such a voltage, and never NaN */
  if (share > 1.0f) share = 1.0f;
  yours_dac_write((uint16_t)(share * (float)(DAC_CODES - 1) + 0.5f));
}

size_t hydro_board_receive(uint8_t* bytes, size_t capacity) { return yours_link_read(bytes, capacity); }

void hydro_board_computer_is_here(void) {}

void hydro_board_send(const uint8_t* bytes, size_t count, bool to_asker) {
  (void)to_asker;
  (void)yours_link_write(bytes, count); /* no room: the frame is lost, and its number shows it */
}

void hydro_board_alive(void) { yours_independent_watchdog_refresh(); }

bool hydro_board_was_reset(struct hydro_board_facts* facts) {
  (void)facts;
  return false;
}
