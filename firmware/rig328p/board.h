// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The board: which pin is what, and what its timer and converter can do.
#pragma once

#include <avr/io.h>
#include <stdint.h>

#define BAUD_RATE 500000UL  // exact with 16 MHz
#define MOST_LEDS 8
#define CHANNELS 8  // A0 to A7: camera 1 +x, -x, +y, -y, camera 2 likewise
#define CAMERAS 2
#define BITS 10
#define LEVELS 255  // of an LED's light

// Timer 1 counts eighths of the clock: ticks of 0.5 us.
#define TICKS_PER_SECOND 2000000UL
#define LEAST_SETTLE 40        // ticks from an LED's start to its first conversion
#define LEAST_CONVERSION 128   // ticks; the converter needs 112, its interrupt the rest
#define LEAST_OFF 60           // ticks between two LEDs
#define MOST_TICKS 60000       // of each of the three
#define MOST_PERIOD 2000000UL  // ticks of a frame: 1 s
#define HOLD 16                // ticks from the start of a conversion to its sample

// LED 1 to 8 are D2, D3, D4, D5, D7 (port D) and D8, D9, D10 (port B), high: lit.
#define LEDS_D (1 << PD2 | 1 << PD3 | 1 << PD4 | 1 << PD5 | 1 << PD7)
#define LEDS_B (1 << PB0 | 1 << PB1 | 1 << PB2)
// D6 carries a pulse width of 62.5 kHz, filtered by the LED driver into the current of all LEDs.
#define LEVEL_PIN (1 << PD6)
#define LEVEL OCR0A
// D11 starts a recording when it rises; D12 and D13 are outputs 0 and 1.
#define TRIGGER_PIN (1 << PB3)
#define OUTPUT_0 (1 << PB4)
#define OUTPUT_1 (1 << PB5)

// Make pins outputs, LEDs dark, the converter ready at 250 kHz.
void board_begin(void);
// Light one LED (0 to 7) and no other.
void board_light(uint8_t led);
void board_dark(void);
