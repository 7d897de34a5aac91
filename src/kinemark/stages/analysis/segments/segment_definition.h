// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What segments and joint angles a laboratory means: names, formulas, sequences. docs/formats/segments.md
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/stages/analysis/segments/formula.h"
#include "kinemark/stages/analysis/segments/rotation_angles.h"

namespace kinemark::analysis {

/// What a number measures; formulas are in metres, radians and kilograms.
enum class SubjectQuantity : std::uint8_t { number, length, angle, mass };
/// "number", "length", "angle" or "mass"; none for another word.
[[nodiscard]] std::optional<SubjectQuantity> subject_quantity_of(std::string_view word);
[[nodiscard]] std::string_view to_string(SubjectQuantity quantity);  ///< the same, back

/// In which recordings an entry counts.
enum class InTrial : std::uint8_t {
  any,     ///< in all
  fixed,   ///< in the static trial only
  moving,  ///< in all but the static trial
};

/// Segments, points and joint angles as formulas of markers and of a subject's measures.
///
/// Formulas name parameters, points, segments ("pelvis.x": an axis, "pelvis.o": the origin) and, where none
/// of these has the name, markers. Each entry may name any other; two entries may share a name where they
/// count in different trials.
struct SegmentDefinition {
  /// A measure of the subject. Its value is the first there is of: one that is given; `measured`, the mean
  /// over the static trial; one that a file of the subject holds; the one that outputs of a model in the
  /// recording were made with (`shown`); `formula`.
  struct Parameter {
    std::string name;                                    ///< in formulas
    std::vector<std::string> also;                       ///< other names that files have for it
    SubjectQuantity quantity = SubjectQuantity::number;  ///< what it measures
    std::optional<Formula> measured;                     ///< of markers
    bool measured_anywhere = false;     ///< without a static trial, over the recording itself
    bool measured_here = false;         ///< over the recording itself, whether there is a static trial or not
    std::optional<Formula> formula;     ///< of other parameters
    bool zero_is_unknown = false;       ///< files write 0 for what was not measured
    std::optional<Formula> formula_sd;  ///< standard deviation of a value that is given or from a file
    bool entered_first = false;         ///< a file's value counts before `measured`
    std::optional<Formula> assumed_sd;  ///< of a value that nobody measured: of `formula` or `shown`
    std::optional<Formula> zero_sd;     ///< of a file's 0, which may stand for what nobody measured
    std::vector<Formula> shown;         ///< each gives the value by a model's outputs in the recording
    bool shown_anywhere = false;        ///< by those of static trials as well
    std::vector<double> choices;        ///< values one of which it has, the first unless `chosen_by` decides
    std::vector<std::string> chosen_by;  ///< parameters that are measured and that files hold too
  };
  /// A point, by a formula in every frame.
  struct Point {
    std::string name;                    ///< in formulas and results
    Formula formula;                     ///< where it is
    InTrial trial = InTrial::any;        ///< where it counts
    bool written = false;                ///< among the results
    std::vector<std::string> also = {};  ///< other names that files have for it
    bool regression = false;             ///< an estimate for which other models have another formula
  };
  /// A point seen in another trial and carried by a segment: a landmark under a pointer, a functional centre.
  struct Landmark {
    std::string name;      ///< in formulas and results
    std::string segment;   ///< that carries it, in both trials
    Formula formula;       ///< where it is in that trial
    std::string trial;     ///< "static", or a name that is given with a file
    bool written = false;  ///< among the results
  };
  /// Axes from two directions, the first of which is kept.
  struct Segment {
    std::string name;      ///< in formulas
    Formula origin;        ///< a point
    int first = 0;         ///< axis 0, 1, 2 along first_along
    Formula first_along;   ///< a direction
    int second = 1;        ///< axis nearest to second_along that is perpendicular to the first
    Formula second_along;  ///< a direction
    std::vector<std::pair<int, Formula>> turns;  ///< about own axes, one after the other, rad
    InTrial trial = InTrial::any;                ///< where it counts
  };
  /// One component of a joint's angles.
  struct Component {
    std::string label;        ///< "flexion"
    int index = 0;            ///< which angle of the sequence; helical: along which axis; 0, 1, 2
    double sign = 1.0;        ///< 1 or -1
    double offset_rad = 0.0;  ///< added after the sign; the sum lies in [-pi, pi]
  };
  /// How a segment lies in another.
  struct Angle {
    std::string name;                 ///< "LKneeAngles"
    std::string parent;               ///< a segment; "lab" and "progression" are there without an entry
    std::string child;                ///< a segment
    bool helical = false;             ///< components of the rotation vector instead of angles of a sequence
    AngleSequence sequence{0, 1, 2};  ///< of axes
    bool second_negative = false;     ///< of both Euler solutions that with the second angle in [-pi, 0]
    std::array<Component, 3> components{};  ///< in the order of the results
    bool cross_talk = false;                ///< a knee: does the second component follow the first?
  };
  /// A number in every frame.
  struct Value {
    std::string name;                                    ///< "LAbsAnkleAngle"
    SubjectQuantity quantity = SubjectQuantity::number;  ///< what it measures
    Formula formula;                                     ///< of anything
  };

  /// A rigid part of the body with mass, for forces and moments at joints.
  struct Body {
    std::string name;                 ///< "LTibia"; a segment may have the same
    std::string segment;              ///< whose axes are its principal axes
    Formula mass;                     ///< kg
    Formula centre;                   ///< of mass, a point
    std::array<Formula, 3> gyration;  ///< radii of gyration about its axes through the centre, m
    std::vector<Formula> floor;   ///< points with which it touches the floor: heel, toe; empty: it does not
    std::string ground_reaction;  ///< name of the ground's force on it, among the results; empty: none
  };
  /// A component of a vector in axes of a segment.
  struct AxisComponent {
    std::string label;  ///< "extension"
    int axis = 0;       ///< 0, 1, 2
    double sign = 1.0;  ///< 1 or -1
  };
  /// Where a part of the body hangs on the rest: force, moment and power, per mass.
  struct Joint {
    std::string name;                       ///< "LKnee": of LKneeForce, LKneeMoment, LKneePower
    Formula centre;                         ///< a point
    std::string parent;                     ///< segment on the side of the trunk
    std::string child;                      ///< segment beyond, in whose axes the vectors are given
    std::vector<std::string> bodies;        ///< all that are beyond
    Formula per;                            ///< mass by which the results are divided, kg
    std::array<AxisComponent, 3> moment{};  ///< of the moment on the child
    std::array<AxisComponent, 3> force{};   ///< of the force on the child
  };

  std::string title;                  ///< what it is, a line
  std::vector<Parameter> parameters;  ///< in the order of the file
  std::vector<Point> points;          ///< in the order of the file
  std::vector<Landmark> landmarks;    ///< in the order of the file
  std::vector<Segment> segments;      ///< in the order of the file
  std::vector<Angle> angles;          ///< in the order of the file
  std::vector<Value> values;          ///< in the order of the file
  std::vector<Body> bodies;           ///< in the order of the file
  std::vector<Joint> joints;          ///< in the order of the file
  /// Angular accelerations of bodies: central differences over so many frames to either side, twice. 0: of
  /// eighth order over nine frames, the most faithful ones.
  std::int64_t angular_span = 0;
  /// Whose way through the laboratory "progression" follows, a point, and the direction that counts where it
  /// covers less than half a metre.
  std::optional<std::pair<Formula, Formula>> progression;

  /// Names are there, no two entries of a trial share one, segments of angles and of bodies and bodies of
  /// joints exist, there are 2,000 entries at most. Code::bad_input.
  [[nodiscard]] Status check() const;
};

}  // namespace kinemark::analysis
