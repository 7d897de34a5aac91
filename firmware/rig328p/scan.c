// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "scan.h"

#include <avr/interrupt.h>
#include <util/atomic.h>

#define LONGEST_WAIT 32768UL  // ticks between two interrupts

static Plan plan_;
static Frame frames_[2];
static volatile uint8_t full_;  // frames that wait to be sent: 0 or 1
static uint8_t filling_;        // index of the frame that is filled
static uint32_t lost_, sequence_;
static volatile uint8_t runs_;
// Within a frame: the slot, its next event (0: light, 1 to 8: start of a conversion, 9: end), ticks that
// remain until it.
static uint8_t slot_, event_, slots_;
static uint32_t wait_, idle_;
static uint16_t* next_;

uint32_t scan_slots(const Plan* plan) {
  const uint32_t slot = (uint32_t)plan->settle + CHANNELS * (uint32_t)plan->conversion + plan->off;
  return slot * (plan->leds + plan->dark);
}

static void begin_frame(void) {
  slot_ = 0;
  event_ = 0;
  next_ = frames_[filling_].counts;
}

static void end_frame(void) {
  if (full_) {
    ++lost_;  // the other one still waits: this one is filled again
  } else {
    frames_[filling_].sequence = sequence_;
    filling_ ^= 1;
    full_ = 1;
  }
  ++sequence_;
  begin_frame();
}

// Light, or leave dark, and set the multiplexer early. Returns ticks to the next event.
static uint16_t begin_slot(void) {
  if (slot_ < plan_.leds) board_light(slot_);
  event_ = 1;
  return plan_.settle;
}

static uint16_t convert(void) {
  if (event_ > 1) *next_++ = ADC;
  ADMUX = 1 << REFS0 | (event_ - 1);
  ADCSRA |= 1 << ADSC;
  ++event_;
  return plan_.conversion;
}

static uint32_t end_slot(void) {
  *next_++ = ADC;
  board_dark();
  ++slot_;
  const uint8_t last = slot_ == slots_;
  if (last) end_frame();
  LEVEL = plan_.level[slot_ < plan_.leds ? slot_ : 0];
  event_ = 0;
  return last ? idle_ : plan_.off;
}

ISR(TIMER1_COMPA_vect) {
  if (wait_ == 0) {
    if (event_ == 0)
      wait_ = begin_slot();
    else if (event_ <= CHANNELS)
      wait_ = convert();
    else
      wait_ = end_slot();
  }
  const uint16_t step = wait_ > LONGEST_WAIT ? LONGEST_WAIT : (uint16_t)wait_;
  OCR1A += step;
  wait_ -= step;
}

void scan_start(const Plan* plan) {
  plan_ = *plan;
  slots_ = plan_.leds + plan_.dark;
  idle_ = plan_.off + (plan_.period - scan_slots(&plan_));
  full_ = filling_ = 0;
  lost_ = sequence_ = 0;
  wait_ = 0;
  LEVEL = plan_.level[0];
  begin_frame();
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    TCCR1A = 0;
    TCCR1B = 1 << CS11;
    OCR1A = TCNT1 + 1000;  // the level settles for 0.5 ms
    TIFR1 = 1 << OCF1A;
    TIMSK1 = 1 << OCIE1A;
    runs_ = 1;
  }
}

uint32_t scan_stop(void) {
  TIMSK1 = 0;
  board_dark();
  runs_ = 0;
  return sequence_;
}

bool scan_runs(void) { return runs_; }

const Frame* scan_frame(void) { return full_ ? &frames_[filling_ ^ 1] : 0; }

void scan_release(void) { full_ = 0; }

uint32_t scan_lost(void) {
  uint32_t out;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { out = lost_; }
  return out;
}
