// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The front of the library: the verbs and nouns that most programs need, by their short names. All of it goes
// from memory to memory but reading and writing. A program that needs more includes the header of its part.
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/data/counts.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/measure.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/recording.h"
#include "kinemark/data/rig.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/data/trial.h"
#include "kinemark/data/wrenches.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/osim/osim_writer.h"
#include "kinemark/io/plates/plate_forces.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/segments/definition_file.h"
#include "kinemark/stages/analysis/emg/emg_measures.h"
#include "kinemark/stages/analysis/forces/force_measures.h"
#include "kinemark/stages/analysis/gait/gait.h"
#include "kinemark/stages/analysis/path/path_measures.h"
#include "kinemark/stages/analysis/segments/segment_motion.h"
#include "kinemark/stages/motion/dynamics/inverse_dynamics.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/scaling/scale.h"
#include "kinemark/stages/skeleton/articulated/articulated.h"
#include "kinemark/stages/trajectory/gaps/fill_gaps.h"
#include "kinemark/stages/trajectory/screening/screen.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"
#include "kinemark/workflow/clean/clean.h"
#include "kinemark/workflow/joints/joints.h"
#include "kinemark/workflow/live/live.h"
#include "kinemark/workflow/measures/measure.h"
#include "kinemark/workflow/motion/dynamics.h"
#include "kinemark/workflow/motion/ik.h"
#include "kinemark/workflow/motion/track.h"
#include "kinemark/workflow/prepare/prepare.h"
#include "kinemark/workflow/rig/calibrate.h"
#include "kinemark/workflow/rig/reconstruct.h"
#include "kinemark/workflow/scale/scale.h"
#include "kinemark/workflow/segments/segments.h"

namespace kinemark {

// Nouns.
using data::Counts;            // of detectors, a time for each pulse
using data::Event;             // as a file has it
using data::Finding;           // what is wrong with samples
using data::ForcePlate;        // as a file has it
using data::JointMotion;       // coordinates with standard deviations
using data::Measure;           // a number with its interval
using data::ModelDescription;  // a body model as a file says it
using data::Recording;         // a trial with its forces, edits and vertical
using data::Rig;               // cameras and detectors
using data::SampleState;       // measured, interpolated, filled, missing, rejected
using data::SegmentLayout;     // which markers ride on which segment
using data::Skeleton;          // joint centres with covariances
using data::Trajectories;      // markers, frame by frame
using data::Trial;             // a recording: markers, channels, plates, events
using data::Wrenches;          // forces on the body
using model::Model;            // a body model that computes: Model::compile()

// Files.
using io::plate_forces;  // forces from the channels of a recording's plates
using io::read_markers;  // any format of markers, by its content
using io::read_osim;
using io::write_markers;  // the ending names the format
using io::write_osim;
using pipeline::find_definition;  // "pig", "isb-shoulder", or a .toml

// As the commands do it: from a recording to what is found, with what there is to say of it.
using workflow::calibrate;
using workflow::clean;
using workflow::dynamics;
using workflow::emg;
using workflow::gait;
using workflow::ik;
using workflow::joints;
using workflow::live;  // frame by frame, as they come
using workflow::measure;
using workflow::measure_motion;
using workflow::prepare;
using workflow::reconstruct;
using workflow::scale;
using workflow::segments;
using workflow::track;

// Cleaning.
using trajectory::fill_gaps;
using trajectory::reject_defects;
using trajectory::screen;
using trajectory::smooth;

// From counts to positions, from markers to joints.
using motion::inverse_dynamics;
using motion::scale_model;
using motion::solve_ik;
using skeleton::fit_articulated;

// What a movement was.
using analysis::analyze_gait;
using analysis::compute_segments;
using analysis::measure_emg;
using analysis::measure_forces;
using analysis::measure_paths;

}  // namespace kinemark
