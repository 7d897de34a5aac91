// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/task.h"

namespace kinemark::motion {

void TaskRows::resize(int rows, int speeds) {
  for (auto* column : {&error, &goal_velocity, &goal_acceleration, &velocity, &bias, &sd})
    column->setZero(rows);
  jacobian.setZero(rows, speeds);
  weight.setOnes(rows);
}

}  // namespace kinemark::motion
