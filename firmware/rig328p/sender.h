// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Frames as bytes: docs/formats/serial-rig.md.
#pragma once

#include "scan.h"

// Length of a frame of so many slots.
uint16_t sender_bytes(uint8_t slots);
void sender_begin(const Plan* plan);
// Send a completed frame where there is one; one that does not fit into the queue is counted.
void sender_look(void);
// Frames that were converted and never sent.
uint32_t sender_dropped(void);
