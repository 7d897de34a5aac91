// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <util/atomic.h>

#include "scan.h"
#include "sender.h"
#include "transmit.h"

#define BYTES_PER_SECOND (BAUD_RATE / 10)

static Plan plan_;
static bool planned_, armed_, was_low_;

static void answer(PGM_P kind) {
  transmit('#');
  transmit_check_begin();
  transmit_text(kind);
}

static void end_answer(void) {
  const uint16_t check = transmit_check();
  transmit('*');
  for (int8_t shift = 12; shift >= 0; shift -= 4) transmit("0123456789ABCDEF"[check >> shift & 15]);
  transmit('\n');
}

static void say_what_it_is(void) {
  answer(PSTR("rig name=rig328p version=1.0 protocol=1"));
  transmit_number(PSTR(" leds="), MOST_LEDS);
  transmit_number(PSTR(" cameras="), CAMERAS);
  transmit_number(PSTR(" bits="), BITS);
  transmit_number(PSTR(" clock="), TICKS_PER_SECOND);
  transmit_number(PSTR(" settle="), LEAST_SETTLE);
  transmit_number(PSTR(" conversion="), LEAST_CONVERSION);
  transmit_number(PSTR(" off="), LEAST_OFF);
  transmit_number(PSTR(" longest="), MOST_TICKS);
  transmit_number(PSTR(" period="), MOST_PERIOD);
  transmit_number(PSTR(" hold="), HOLD);
  transmit_number(PSTR(" levels="), LEVELS);
  transmit_number(PSTR(" dark="), 1);
  transmit_number(PSTR(" outputs="), 2);
  transmit_number(PSTR(" trigger="), 1);
  transmit_number(PSTR(" millivolts="), 5000);
  end_answer();
}

static void refuse(PGM_P why) {
  answer(PSTR("no why="));
  transmit_text(why);
  end_answer();
}

static void say_plan(void) {
  answer(PSTR("plan"));
  transmit_number(PSTR(" leds="), plan_.leds);
  transmit_number(PSTR(" dark="), plan_.dark);
  transmit_number(PSTR(" period="), plan_.period);
  transmit_number(PSTR(" settle="), plan_.settle);
  transmit_number(PSTR(" conversion="), plan_.conversion);
  transmit_number(PSTR(" off="), plan_.off);
  transmit_number(PSTR(" trigger="), plan_.trigger);
  transmit_text(PSTR(" level="));
  for (uint8_t l = 0; l < plan_.leds; ++l) transmit_number(l ? PSTR(",") : PSTR(""), plan_.level[l]);
  end_answer();
}

// The next number of a line, or `absent`; no number: `absent` too.
static uint32_t next_number(char** at, uint32_t absent) {
  char* end;
  const uint32_t value = strtoul(*at, &end, 10);
  if (end == *at) return absent;
  *at = end;
  return value;
}

static uint16_t within(uint32_t value, uint16_t least) {
  if (value < least) return least;
  return value > MOST_TICKS ? MOST_TICKS : (uint16_t)value;
}

// The shortest period that both the slots and the line can hold; the line is filled to 19/20 at most.
static uint32_t shortest_period(const Plan* plan) {
  const uint32_t bytes = sender_bytes(plan->leds + plan->dark);
  const uint32_t line = bytes * (TICKS_PER_SECOND / 1000) * 20 / 19 / (BYTES_PER_SECOND / 1000) + 1;
  const uint32_t slots = scan_slots(plan);
  return slots > line ? slots : line;
}

static void set_plan(char* at) {
  Plan wanted;
  wanted.leds = (uint8_t)next_number(&at, 0);
  wanted.dark = next_number(&at, 0) != 0;
  wanted.period = next_number(&at, 0);
  wanted.settle = within(next_number(&at, 0), LEAST_SETTLE);
  wanted.conversion = within(next_number(&at, 0), LEAST_CONVERSION);
  wanted.off = within(next_number(&at, 0), LEAST_OFF);
  wanted.trigger = next_number(&at, 0) != 0;
  for (uint8_t l = 0; l < MOST_LEDS; ++l) wanted.level[l] = (uint8_t)next_number(&at, LEVELS);
  if (wanted.leds < 1 || wanted.leds > MOST_LEDS) return refuse(PSTR("leds"));
  const uint32_t shortest = shortest_period(&wanted);
  if (wanted.period == 0) wanted.period = shortest;
  if (wanted.period < shortest || wanted.period > MOST_PERIOD) {
    answer(PSTR("no why=period"));
    transmit_number(PSTR(" least="), shortest);
    transmit_number(PSTR(" most="), MOST_PERIOD);
    return end_answer();
  }
  plan_ = wanted;
  planned_ = true;
  say_plan();
}

static void start(void) {
  if (!planned_) return refuse(PSTR("noplan"));
  sender_begin(&plan_);
  answer(PSTR("start"));
  end_answer();
  armed_ = plan_.trigger;
  was_low_ = false;
  if (!armed_) scan_start(&plan_);
}

static void stop(void) {
  armed_ = false;
  const uint32_t frames = scan_stop();
  answer(PSTR("stop"));
  transmit_number(PSTR(" frames="), frames);
  transmit_number(PSTR(" dropped="), sender_dropped());
  end_answer();
}

static void set_output(char* at) {
  const uint32_t line = next_number(&at, 2), high = next_number(&at, 2);
  if (line > 1 || high > 1) return refuse(PSTR("output"));
  const uint8_t pin = line ? OUTPUT_1 : OUTPUT_0;
  // The scan's interrupts light LEDs of the same port.
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    if (high)
      PORTB |= pin;
    else
      PORTB &= (uint8_t)~pin;
  }
  answer(PSTR("out"));
  transmit_number(PSTR(" line="), line);
  transmit_number(PSTR(" high="), high);
  end_answer();
}

void command(char* line) {
  if (!strcmp_P(line, PSTR("stop"))) return stop();
  if (!strncmp_P(line, PSTR("out "), 4)) return set_output(line + 4);
  if (armed_ || scan_runs()) return refuse(PSTR("runs"));
  if (!strcmp_P(line, PSTR("?"))) return say_what_it_is();
  if (!strncmp_P(line, PSTR("plan "), 5)) return set_plan(line + 5);
  if (!strcmp_P(line, PSTR("start"))) return start();
  refuse(PSTR("command"));
}

void command_look_for_trigger(void) {
  if (!armed_) return;
  const bool high = (PINB & TRIGGER_PIN) != 0;
  if (!high) was_low_ = true;
  if (!high || !was_low_) return;
  armed_ = false;
  scan_start(&plan_);
}

bool command_waits_for_trigger(void) { return armed_; }
