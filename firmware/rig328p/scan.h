// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// LEDs in turn and conversions at their times, by timer 1.
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "board.h"

// What is run: ticks of 0.5 us.
typedef struct {
  uint8_t leds;         // 1 to 8
  uint8_t dark;         // 1: one more slot without light
  uint8_t trigger;      // 1: begins when D11 rises
  uint32_t period;      // of a frame
  uint16_t settle;      // from an LED's start to its first conversion
  uint16_t conversion;  // from one to the next
  uint16_t off;         // from the end of the last to the next LED
  uint8_t level[MOST_LEDS];
} Plan;

#define MOST_SLOTS (MOST_LEDS + 1)

// One frame as it was converted.
typedef struct {
  uint32_t sequence;  // from 0
  uint16_t counts[MOST_SLOTS * CHANNELS];
} Frame;

// Ticks of all slots: the shortest period of the plan.
uint32_t scan_slots(const Plan* plan);
// Begin with frame 0.
void scan_start(const Plan* plan);
// End at once, LEDs dark. How many frames were begun and ended.
uint32_t scan_stop(void);
bool scan_runs(void);
// The frame that was completed, or 0; scan_release() gives its memory back. A frame that finds both in use is
// counted lost.
const Frame* scan_frame(void);
void scan_release(void);
uint32_t scan_lost(void);
