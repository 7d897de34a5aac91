// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/data/trial.h"
#include "kinemark/io/c3d/parameters.h"

namespace kinemark::io {

/// Name of kinemark's own parameter group. C3D itself distinguishes only measured, not measured and missing.
inline constexpr const char* kProvenanceGroup = "KINEMARK";

/// Add the group that stores states, methods and standard deviations, marker by marker in runs of equal
/// samples: FRAMES (two words), METHODS, and RUNS of five bytes each (length, low byte first, state, method,
/// deviation). A deviation is the root mean square of the three axes in steps of 5 % from 1 um; 0: not known.
/// Nothing is added where the fourth words of C3D suffice. A recording with more runs than a parameter
/// section can hold loses deviations first, then the whole group: it reads as `interpolated`.
void add_provenance(const data::Trajectories& markers, C3dParameters& parameters);

/// Apply that group to samples as C3D itself stores them: a sample that is `interpolated` may become filled
/// or upsampled, one that is missing may become rejected, one that is measured stays so. A group that does
/// not fit the file (another program cut it) is left alone with a warning.
void apply_provenance(const C3dParameters& parameters, data::Trial& trial);

/// Add the error that a calibration leaves, where it is known: a text in lines of 240 letters.
void add_calibration_error(const data::CalibrationError& error, C3dParameters& parameters);
/// Read it back; a text that holds none is left alone with a warning.
void take_calibration_error(const C3dParameters& parameters, data::Trial& trial);

}  // namespace kinemark::io
