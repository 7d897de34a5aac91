// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Lines from the host.
#pragma once

// The line that came, without its end, until receive_release(); or 0. One that is too long comes empty.
char* receive_line(void);
void receive_release(void);
