// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "board.h"

static const uint8_t kPortD[MOST_LEDS] = {1 << PD2, 1 << PD3, 1 << PD4, 1 << PD5, 1 << PD7, 0, 0, 0};
static const uint8_t kPortB[MOST_LEDS] = {0, 0, 0, 0, 0, 1 << PB0, 1 << PB1, 1 << PB2};

void board_begin(void) {
  DDRD = LEDS_D | LEVEL_PIN;
  DDRB = LEDS_B | OUTPUT_0 | OUTPUT_1;
  DIDR0 = 0x3F;  // A0 to A5 are analog alone
  // Timer 0: fast pulse width on D6.
  TCCR0A = 1 << COM0A1 | 1 << WGM01 | 1 << WGM00;
  TCCR0B = 1 << CS00;
  LEVEL = LEVELS;
  // The supply is the reference; clock / 64. The first conversion after switching on is longer: it is spent
  // here.
  ADMUX = 1 << REFS0;
  ADCSRA = 1 << ADEN | 1 << ADPS2 | 1 << ADPS1;
  ADCSRA |= 1 << ADSC;
  while (ADCSRA & 1 << ADSC) {
  }
}

void board_light(uint8_t led) {
  PORTD = (PORTD & (uint8_t)~LEDS_D) | kPortD[led];
  PORTB = (PORTB & (uint8_t)~LEDS_B) | kPortB[led];
}

void board_dark(void) {
  PORTD &= (uint8_t)~LEDS_D;
  PORTB &= (uint8_t)~LEDS_B;
}
