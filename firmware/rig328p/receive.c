// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "receive.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <stdbool.h>
#include <stdint.h>

#define LONGEST 95
#define QUEUE 128                                  // a power of 2; what does not fit is not heard
static volatile uint8_t queue_[QUEUE], in_, out_;  // in_ and out_ count up
static char line_[LONGEST + 1];
static uint8_t length_;
static bool complete_, too_long_;

ISR(USART_RX_vect) {
  const uint8_t byte = UDR0;
  if ((uint8_t)(in_ - out_) == QUEUE) return;
  queue_[in_ % QUEUE] = byte;
  ++in_;
}

// Whether the line ends with this byte.
static bool take(char c) {
  if (c == '\n' || c == '\r') {
    line_[too_long_ ? 0 : length_] = 0;
    const bool is_line = length_ > 0;
    length_ = 0;
    too_long_ = false;
    return is_line;
  }
  if (length_ < LONGEST)
    line_[length_++] = c;
  else
    too_long_ = true;
  return false;
}

char* receive_line(void) {
  while (!complete_ && out_ != in_) {
    complete_ = take((char)queue_[out_ % QUEUE]);
    ++out_;
  }
  return complete_ ? line_ : 0;
}

void receive_release(void) { complete_ = false; }
