// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <avr/interrupt.h>
#include <avr/sleep.h>

#include "board.h"
#include "commands.h"
#include "receive.h"
#include "sender.h"
#include "transmit.h"

// Sleep until the next interrupt, unless there is something to do.
static void rest(void) {
  cli();
  if (!scan_frame() && !receive_line() && !command_waits_for_trigger()) {
    sleep_enable();
    sei();  // takes effect after the next instruction: no interrupt comes before the sleep
    sleep_cpu();
    sleep_disable();
  }
  sei();
}

int main(void) {
  board_begin();
  transmit_begin();
  set_sleep_mode(SLEEP_MODE_IDLE);
  sei();
  for (;;) {
    sender_look();
    command_look_for_trigger();
    char* line = receive_line();
    if (line) {
      command(line);
      receive_release();
    }
    rest();
  }
}
