// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "transmit.h"

#include <avr/interrupt.h>
#include <stdlib.h>
#include <util/atomic.h>
#include <util/crc16.h>

#include "board.h"

#define QUEUE 512  // a power of 2: five of the longest frames
static uint8_t queue_[QUEUE];
static volatile uint16_t in_, out_;  // count up; the difference waits
static uint16_t check_;

void transmit_begin(void) {
  UCSR0A = 1 << U2X0;
  UBRR0 = F_CPU / 8 / BAUD_RATE - 1;
  UCSR0B = 1 << TXEN0 | 1 << RXEN0 | 1 << RXCIE0;
  UCSR0C = 1 << UCSZ01 | 1 << UCSZ00;
}

ISR(USART_UDRE_vect) {
  const uint16_t out = out_;
  UDR0 = queue_[out % QUEUE];
  out_ = out + 1;
  if (out + 1 == in_) UCSR0B &= (uint8_t)~(1 << UDRIE0);
}

static uint16_t waiting(void) {
  uint16_t out;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { out = in_ - out_; }
  return out;
}

bool transmit_fits(uint16_t bytes) { return waiting() + bytes <= QUEUE; }

void transmit(uint8_t byte) {
  while (!transmit_fits(1)) {
  }
  queue_[in_ % QUEUE] = byte;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    ++in_;
    UCSR0B |= 1 << UDRIE0;
  }
}

void transmit_check_begin(void) { check_ = 0xFFFF; }

void transmit_checked(uint8_t byte) {
  check_ = _crc_xmodem_update(check_, byte);
  transmit(byte);
}

uint16_t transmit_check(void) { return check_; }

void transmit_text(PGM_P text) {
  for (char c; (c = (char)pgm_read_byte(text)) != 0; ++text) transmit_checked((uint8_t)c);
}

void transmit_number(PGM_P name, uint32_t value) {
  char digits[11];
  transmit_text(name);
  ultoa(value, digits, 10);
  for (const char* d = digits; *d; ++d) transmit_checked((uint8_t)*d);
}
