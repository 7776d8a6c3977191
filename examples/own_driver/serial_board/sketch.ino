// What runs on the microcontroller: a small sketch as laboratories have it, with lines of text and no frames. For
// boards whose inputs have 16 bits and whose output has 12 (Teensy 3), and an amplifier stage that makes -10 to 10 V of
// the output's range.
// It was never tried on a board; simulated_device.cc compiles it, so the same lines run in the tests.
//
//   "V1.234\n"                       in: volts for the amplifier; a V begins a command anew
//   "30000,29500,32187,36800,-1234\n"   out, the answer: inputs A0 to A3 and the encoder's count
#ifdef ARDUINO
#include <Encoder.h>
#endif

const unsigned long kWatchdogMs = 200;  // without a command for so long: zero volts
const int kOutput = DAC0;

Encoder encoder(2, 3);
char line[12];
int length = -1;  // of the command in `line`; -1: none has begun
unsigned long heard = 0;

// Code 2048 is exactly 0 V.
void drive(float volts) { analogWrite(kOutput, constrain(2048 + (int)lroundf(volts * 204.8f), 0, 4095)); }

void answer() {
  for (int pin : {A0, A1, A2, A3}) {
    Serial.print(analogRead(pin));
    Serial.print(',');
  }
  Serial.println(encoder.read());
}

void obey() {
  char* end;
  line[length] = 0;
  const float volts = strtof(line, &end);
  if (end == line || *end != 0 || !isfinite(volts)) return;
  drive(volts);
  heard = millis();
  answer();
}

void take(char c) {
  if (c == 'V') {
    length = 0;
  } else if (length >= 0 && c == '\n') {
    obey();
    length = -1;
  } else if (length >= 0) {
    if (length < (int)sizeof line - 1) line[length++] = c;
    else length = -1;  // no command is that long
  }
}

void setup() {
  Serial.begin(2000000);  // boards with USB of their own ignore the rate
  analogReadResolution(16);
  analogWriteResolution(12);
  drive(0);
}

void loop() {
  while (Serial.available() > 0) take((char)Serial.read());
  if (millis() - heard > kWatchdogMs) drive(0);
}
