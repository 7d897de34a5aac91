// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "sender.h"

#include "transmit.h"

#define START_1 0xA5
#define START_2 0x5A
#define HEAD 12
#define TAIL 2

static uint8_t slots_;
static uint32_t unsent_;

uint16_t sender_bytes(uint8_t slots) { return HEAD + slots * (CHANNELS * BITS / 8) + TAIL; }

void sender_begin(const Plan* plan) {
  slots_ = plan->leds + plan->dark;
  unsent_ = 0;
}

uint32_t sender_dropped(void) { return unsent_ + scan_lost(); }

static void send_u32(uint32_t value) {
  for (uint8_t i = 0; i < 4; ++i, value >>= 8) transmit_checked((uint8_t)value);
}

// Four electrodes of 10 bits: 5 bytes, low bits first.
static void send_four(const uint16_t* counts) {
  transmit_checked((uint8_t)counts[0]);
  transmit_checked((uint8_t)(counts[0] >> 8 | counts[1] << 2));
  transmit_checked((uint8_t)(counts[1] >> 6 | counts[2] << 4));
  transmit_checked((uint8_t)(counts[2] >> 4 | counts[3] << 6));
  transmit_checked((uint8_t)(counts[3] >> 2));
}

static void send(const Frame* frame) {
  transmit(START_1);
  transmit(START_2);
  transmit_check_begin();
  transmit_checked(slots_);
  transmit_checked(CAMERAS);
  send_u32(frame->sequence);
  send_u32(sender_dropped());
  const uint8_t cells = slots_ * CAMERAS;
  for (uint8_t i = 0; i < cells; ++i) send_four(frame->counts + 4 * i);
  const uint16_t check = transmit_check();
  transmit((uint8_t)check);
  transmit((uint8_t)(check >> 8));
}

void sender_look(void) {
  const Frame* frame = scan_frame();
  if (!frame) return;
  if (transmit_fits(sender_bytes(slots_)))
    send(frame);
  else
    ++unsent_;
  scan_release();
}
