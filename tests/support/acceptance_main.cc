// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "support/acceptance.h"

int main(int argc, char** argv) { return kinemark::testing_support::run_acceptance(argc, argv); }
