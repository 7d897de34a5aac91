// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdbool.h>

// Obey one line of the host and answer it.
void command(char* line);
// The scan waits for D11 to rise: look, and start it when it has.
void command_look_for_trigger(void);
bool command_waits_for_trigger(void);
