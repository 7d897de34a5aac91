// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The queue to the host. What is in it is sent by interrupts.
#pragma once

#include <avr/pgmspace.h>
#include <stdbool.h>
#include <stdint.h>

void transmit_begin(void);
// Room for so many bytes.
bool transmit_fits(uint16_t bytes);
// Put one byte into the queue; waits for room.
void transmit(uint8_t byte);
// The check of docs/formats/serial-rig.md: CRC-16, polynomial 0x1021, most significant bit first, begun with
// 0xFFFF.
void transmit_check_begin(void);
void transmit_checked(uint8_t byte);
uint16_t transmit_check(void);
// Text of an answer, checked: from flash, and numbers in decimals.
void transmit_text(PGM_P text);
void transmit_number(PGM_P name, uint32_t value);
