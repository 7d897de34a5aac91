// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/plates/plate_forces.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <functional>
#include <tuple>

#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"
#include "kinemark/io/c3d/reader.h"
#include "kinemark/io/c3d/writer.h"
#include "kinemark/io/file.h"
#include "kinemark/io/matlab/mat.h"
#include "kinemark/io/text/table_file.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

Vector3d of_frame(const Array<double>& values, std::int64_t f) {
  return Eigen::Map<const Vector3d>(values.data() + 3 * f);
}

/// A plate somewhere in a laboratory whose z points up, and the expected result of one sample. Independent
/// physics: forces of four sensors, or one force at a point, give the channels.
struct Setting {
  int type = 2;
  Vector3d centre{0.4, -1.2, 0.03};
  Matrix3d world_from_plate =
      (Eigen::AngleAxisd(0.7, Vector3d::UnitZ()) * Eigen::AngleAxisd(3.14159265358979, Vector3d::UnitX()))
          .toRotationMatrix();
  Vector3d origin{0.002, -0.003, -0.04};  ///< from the plate's origin to the middle of its surface
  double a = 0.12, b = 0.2;               ///< of the four sensors of types 3 and 6
  std::int64_t samples_per_frame = 4;
  bool markers_below = false;

  // What acts on the body, in the plate's axes.
  Vector3d force{30.0, -50.0, -700.0}, position{0.05, -0.11, 0.0};
  double twist = 4.0;

  std::vector<std::string> units = {"N", "N", "N", "Nmm", "Nmm", "Nmm"};
  Eigen::MatrixXd calibration;  ///< of types 4 and 6
  bool origin_flipped = false;

  [[nodiscard]] Vector3d moment_about_origin(const Vector3d& f) const {
    return (position + origin).cross(f) + Vector3d(0.0, 0.0, twist * f.z() / force.z());
  }

  [[nodiscard]] bool has_sensors() const { return type == 3 || type == 6; }

  /// Three components of each of four sensors that have this sum and moment, of the many that do.
  [[nodiscard]] Eigen::VectorXd of_sensors(const Vector3d& f, const Vector3d& m) const {
    const Vector3d at[4] = {{a, b, 0.0}, {-a, b, 0.0}, {-a, -b, 0.0}, {a, -b, 0.0}};
    Eigen::MatrixXd equations(6, 12);
    for (int c = 0; c < 12; ++c)
      equations.col(c) << Vector3d::Unit(c % 3), at[c / 3].cross(Vector3d::Unit(c % 3));
    const auto solver = equations.completeOrthogonalDecomposition();
    Eigen::VectorXd wanted(6);
    wanted << f, m;
    const Eigen::VectorXd any = Eigen::VectorXd::LinSpaced(12, -20.0, 35.0);
    return any + solver.solve(wanted - equations * any);
  }

  [[nodiscard]] std::vector<double> channels(double scale) const {
    const Vector3d f = scale * force;
    if (type == 1) {
      const Vector3d point = 1e3 * (position + origin);
      return {f.x(), f.y(), f.z(), point.x(), point.y(), 1e3 * scale * twist};
    }
    const Vector3d m = moment_about_origin(f);
    if (type == 3) {
      // Sensors 1 to 4 at (+a +b), (-a +b), (-a -b), (+a -b): any four forces with this sum and moment.
      const double mx = m.x(), my = m.y(), mz = m.z();
      const double fx12 = 0.5 * f.x() - 0.25 * mz / b, fx34 = 0.5 * f.x() + 0.25 * mz / b;
      const double fy14 = 0.5 * f.y() + 0.25 * mz / a, fy23 = 0.5 * f.y() - 0.25 * mz / a;
      const double s = 0.25 * f.z(), u = 0.25 * mx / b, v = 0.25 * my / a, odd = 17.0;
      return {fx12, fx34, fy14, fy23, s + u - v + odd, s + u + v - odd, s - u + v + odd, s - u - v - odd};
    }
    Eigen::VectorXd out(6);
    out << f, 1e3 * m;
    if (type == 6) out = of_sensors(f, m);
    if (type == 4 || type == 6) out = calibration.inverse() * out;
    return {out.data(), out.data() + out.size()};
  }

  /// A recording whose force follows `course` (1: as above), by analog sample.
  [[nodiscard]] data::Trial trial(std::int64_t frames, const std::function<double(double)>& course) const {
    data::Trial t;
    t.markers = data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .frames = frames});
    for (std::int64_t f = 0; f < frames; ++f) {
      t.markers.x(f, 0) = centre + Vector3d(0.3, 0.1, markers_below ? -1.0 : 1.0);
      t.markers.state[t.markers.index(f, 0)] = data::SampleState::measured;
    }
    const std::size_t channel_count = type == 3 ? 8 : type == 6 ? 12 : 6;
    data::ForcePlate plate{.type = type, .origin_in_plate = origin_flipped ? Vector3d(-origin) : origin};
    if (has_sensors()) plate.origin_in_plate = {a, b, origin_flipped ? -origin.z() : origin.z()};
    const double corners[4][2] = {{0.25, 0.3}, {-0.25, 0.3}, {-0.25, -0.3}, {0.25, -0.3}};
    for (std::size_t c = 0; c < 4; ++c)
      plate.corners_in_world[c] = centre + world_from_plate * Vector3d(corners[c][0], corners[c][1], 0.0);
    plate.calibration.assign(calibration.data(), calibration.data() + calibration.size());
    plate.calibration_rows = static_cast<int>(calibration.rows());
    t.analog.names = {"other"};  // the plate does not begin at the first channel
    t.analog.units = {"V"};
    for (std::size_t c = 0; c < channel_count; ++c) {
      plate.channel_idx.push_back(static_cast<int>(c) + 1);
      t.analog.names.push_back("ch" + std::to_string(c));
      t.analog.units.push_back(!has_sensors() && c < units.size() ? units[c] : "N");
    }
    t.force_plates.push_back(plate);
    t.analog.samples = frames * samples_per_frame;
    t.analog.rate_hz = 100.0 * static_cast<double>(samples_per_frame);
    for (std::int64_t i = 0; i < t.analog.samples; ++i) {
      t.analog.values.push_back(-1.0);
      for (const double v : channels(course(static_cast<double>(i)))) t.analog.values.push_back(v);
    }
    return t;
  }
};

/// Written and opened again; `mend` may change the bytes between.
Result<PlateForces> through_a_file(const data::Trial& trial, const PlateOptions& options = {},
                                   const std::function<void(std::string&)>& mend = {}) {
  const testing_support::ScratchFolder scratch;
  if (auto s = write_c3d(scratch / "p.c3d", trial); !s) return std::unexpected(s.error());
  std::string bytes = read_text(scratch / "p.c3d").value();
  if (mend) mend(bytes);
  const auto span = std::as_bytes(std::span(bytes));
  const auto reader = C3dReader::open(std::make_unique<MemorySource>(span, "p.c3d"));
  if (!reader) return std::unexpected(reader.error());
  const auto read = read_trial(*reader);
  if (!read) return std::unexpected(read.error());
  auto forces = plate_forces(*read, options);
  EXPECT_TRUE(!forces || forces->wrenches.validate());
  return forces;
}

/// Forces of a file.
Result<PlateForces> forces_of(const std::filesystem::path& path, const PlateOptions& options = {}) {
  const auto trial = read_c3d(path);
  if (!trial) return std::unexpected(trial.error());
  return plate_forces(*trial, options);
}

/// Set FORCE_PLATFORM:ZERO, which is (0, 0) where the trial names no frames.
auto set_zero(std::int16_t first, std::int16_t last) {
  return [=](std::string& bytes) {
    const auto at = bytes.find("ZERO");
    ASSERT_NE(at, std::string::npos);
    std::memcpy(bytes.data() + at + 9, &first, 2);
    std::memcpy(bytes.data() + at + 11, &last, 2);
  };
}

void expect_truth(const Setting& setting, const data::Wrench& wrench, std::int64_t f,
                  double tolerance = 1e-3) {
  const Matrix3d& R = setting.world_from_plate;
  EXPECT_LT((of_frame(wrench.force, f) - R * setting.force).norm(), tolerance * 700.0);
  EXPECT_LT((of_frame(wrench.point, f) - setting.centre - R * setting.position).norm(), tolerance);
  EXPECT_LT((of_frame(wrench.moment, f) - R * Vector3d(0.0, 0.0, setting.twist)).norm(), 20.0 * tolerance);
}

TEST(PlateForces, AForceAtAPointIsFoundForEveryType) {
  Random random(5, 0);
  for (const int type : {1, 2, 3, 4, 6}) {
    SCOPED_TRACE(type);
    Setting setting;
    setting.type = type;
    if (setting.has_sensors()) setting.origin.head<2>().setZero();  // sensors lie evenly about the middle
    if (type == 1) setting.units = {"N", "N", "N", "mm", "mm", "Nmm"};
    if (type == 4) {
      setting.units.assign(6, "V");
      setting.calibration = Eigen::MatrixXd::Zero(6, 6);
      for (double& v : setting.calibration.reshaped()) v = random.uniform(-0.05, 0.05);
      setting.calibration.diagonal() << 1.5, 1.6, 6.0, 740.0, 741.0, 390.0;
    }
    if (type == 6) {
      setting.calibration = 12.0 * Eigen::MatrixXd::Identity(12, 12);
      for (double& v : setting.calibration.reshaped()) v += random.uniform(-0.2, 0.2);
    }
    const auto forces = through_a_file(setting.trial(9, [](double) { return 1.0; })).value();
    ASSERT_EQ(forces.wrenches.items.size(), 1u);
    EXPECT_EQ(forces.wrenches.items[0].name, "plate 1");
    EXPECT_EQ(forces.wrenches.items[0].body, "");
    EXPECT_EQ(forces.wrenches.frames(), 9);
    EXPECT_EQ(forces.wrenches.time.rate_hz, 100.0);
    EXPECT_THAT(forces.warnings, IsEmpty());
    for (const std::int64_t f : {0, 4, 8}) expect_truth(setting, forces.wrenches.items[0], f);
  }
}

TEST(PlateForces, AnOriginAboveTheSurfaceIsTurned) {
  for (const int type : {1, 2, 3}) {
    SCOPED_TRACE(type);
    Setting setting;
    setting.type = type;
    setting.origin_flipped = true;
    if (type == 3) setting.origin.head<2>().setZero();
    if (type == 1) setting.units = {"N", "N", "N", "mm", "mm", "Nmm"};
    const auto forces = through_a_file(setting.trial(3, [](double) { return 1.0; })).value();
    expect_truth(setting, forces.wrenches.items.at(0), 1);
    EXPECT_THAT(forces.warnings, ElementsAre(HasSubstr("plate 1 has an ORIGIN above its surface")));
  }
}

TEST(PlateForces, TheUnitOfMomentsIsTheChannelsOrTheFiles) {
  for (const auto& unit : {"Nm", "N.m", "Nt m", "newton-metre"}) {
    Setting setting;
    setting.units = {"N", "N", "N", unit, unit, unit};
    auto trial = setting.trial(3, [](double) { return 1.0; });
    for (std::size_t i = 0; i < trial.analog.values.size(); ++i)
      if (i % 7 >= 4) trial.analog.values[i] *= 1e-3;
    expect_truth(setting, through_a_file(trial).value().wrenches.items.at(0), 1);
  }
  Setting setting;
  setting.units = {"kN", "kN", "kN", "", "", ""};
  auto trial = setting.trial(3, [](double) { return 1.0; });
  for (std::size_t i = 0; i < trial.analog.values.size(); ++i)
    if (i % 7 >= 1 && i % 7 < 4) trial.analog.values[i] *= 1e-3;
  expect_truth(setting, through_a_file(trial).value().wrenches.items.at(0), 1);
}

TEST(PlateForces, UnitsOfOtherLanguagesAndScalesAreOnes) {
  const auto forces_of_units = [](const char* force, double force_scale, const char* moment,
                                  double moment_scale) {
    Setting setting;
    setting.units = {force, force, force, moment, moment, moment};
    auto trial = setting.trial(3, [](double) { return 1.0; });
    for (std::size_t i = 0; i < trial.analog.values.size(); ++i) {
      if (i % 7 >= 1 && i % 7 < 4) trial.analog.values[i] /= force_scale;
      if (i % 7 >= 4) trial.analog.values[i] *= 1e-3 / moment_scale;
    }
    return through_a_file(trial).value();
  };
  for (const auto& [force, force_scale, moment, moment_scale] :
       {std::tuple{"kN", 1e3, "kN.m", 1e3},
        {"N", 1.0, "Nxm", 1.0},
        {"N", 1.0, "Joule", 1.0},
        {"kgf", 9.80665, "kgf.m", 9.80665},
        {"lbf", 4.4482216152605, "lbf.in", 4.4482216152605 * 0.0254},
        {"dN", 0.1, "N.cm", 1e-2}}) {
    const auto forces = forces_of_units(force, force_scale, moment, moment_scale);
    expect_truth(Setting{}, forces.wrenches.items.at(0), 1);
    EXPECT_THAT(forces.warnings, Not(Contains(HasSubstr("no unit of what")))) << moment;
  }
  EXPECT_THAT(forces_of_units("furlong", 1.0, "Nmm", 1e-3).warnings,
              Contains(HasSubstr(
                  "force plate 1 has channel 1 in 'furlong', channel 2 in 'furlong', channel 3 in 'furlong', "
                  "which is no unit of what these measure; forces are taken as N, moments as N times")));
}

TEST(PlateForces, ThePolynomialOfAKistlerPlateMovesItsCentreOfPressure) {
  Setting setting;
  setting.type = 3;
  setting.origin.head<2>().setZero();
  setting.force = {0.0, 0.0, -700.0};
  setting.position = {0.06, -0.05, 0.0};
  auto trial = setting.trial(3, [](double) { return 1.0; });
  const auto local = [&](const data::Trial& of) {
    const auto forces = plate_forces(of).value();
    return std::pair{Vector3d(setting.world_from_plate.transpose() *
                              (of_frame(forces.wrenches.items.at(0).point, 1) - setting.centre)),
                     forces.warnings};
  };
  EXPECT_LT((local(trial).first - setting.position).norm(), 1e-6);
  EXPECT_THAT(local(trial).second, Not(Contains(HasSubstr("FPCOPPOLY"))));
  // Of a real plate; ezc3d 1.7.2 finds (61.5, -45.8) mm.
  trial.force_plates[0].pressure_correction = {
      7.92062965e-15,  8.82868963e-15,  -5.82099979e-10, -2.48554011e-10, -2.77102004e-6, -1.76282003e-6,
      -1.76082995e-10, -4.22186008e-10, 1.29694999e-5,   1.20909999e-5,   -4.13978994e-2, 5.16279005e-2};
  EXPECT_LT((local(trial).first - Vector3d(0.0615, -0.0458, 0.0)).norm(), 1e-4);
  EXPECT_THAT(local(trial).second, Contains(HasSubstr("corrected by the file's polynomial")));
  // Kept by every format that keeps plates.
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_mat(scratch / "p.mat", trial, {}));
  ASSERT_TRUE(write_c3d(scratch / "p.c3d", trial));
  EXPECT_LT((local(read_mat(scratch / "p.mat").value()).first - local(trial).first).norm(), 1e-12);
  EXPECT_LT((local(read_c3d(scratch / "p.c3d").value()).first - local(trial).first).norm(), 1e-6);
  // Of a plate whose moments are computed already it is not taken again.
  Setting six;
  auto other = six.trial(3, [](double) { return 1.0; });
  other.force_plates[0].pressure_correction = trial.force_plates[0].pressure_correction;
  const auto as_is = plate_forces(other).value();
  expect_truth(six, as_is.wrenches.items.at(0), 1);
  EXPECT_THAT(as_is.warnings, ElementsAre(HasSubstr("is not applied to one of type 2")));
}

TEST(PlateForces, FramesAreNeitherEarlyNorLate) {
  // A force that grows evenly must be found, in every frame but none at the rim, at the frame's own time.
  for (const std::int64_t S : {1, 2, 5, 8}) {
    SCOPED_TRACE(S);
    Setting setting;
    setting.samples_per_frame = S;
    const auto course = [S](double sample) { return 0.5 + 0.01 * sample / static_cast<double>(S); };
    const auto forces = through_a_file(setting.trial(40, course)).value();
    for (std::int64_t f = 0; f < 40; ++f)
      EXPECT_NEAR(of_frame(forces.wrenches.items.at(0).force, f).z(),
                  700.0 * (0.5 + 0.01 * static_cast<double>(f)), 1e-3);
  }
}

TEST(PlateForces, AMeanOverAFrameTakesNoiseAway) {
  // Alternating samples: the mean over an even number of them has none of it left.
  Setting setting;
  setting.samples_per_frame = 8;
  const auto course = [](double i) { return std::fmod(i, 2.0) == 0.0 ? 1.3 : 0.7; };
  const auto forces = through_a_file(setting.trial(20, course)).value();
  for (std::int64_t f = 1; f < 20; ++f)
    EXPECT_NEAR(of_frame(forces.wrenches.items.at(0).force, f).z(), 700.0, 1e-3);
}

TEST(PlateForces, EveryFormatThatKeepsPlatesHasTheSameForces) {
  Setting setting;
  setting.type = 4;
  setting.units.assign(6, "V");
  setting.calibration = Eigen::MatrixXd::Identity(6, 6);
  const auto course = [](double i) { return i < 40.0 ? 0.04 : 1.04; };
  auto trial = setting.trial(30, course);
  trial.force_plates[0].number = 3;
  trial.unloaded_s = {0.0, 0.08};
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_mat(scratch / "p.mat", trial, {}));
  ASSERT_TRUE(write_c3d(scratch / "p.c3d", trial));
  const auto now = plate_forces(trial).value(),
             mat = plate_forces(read_mat(scratch / "p.mat").value()).value(),
             c3d = forces_of(scratch / "p.c3d").value();
  expect_truth(setting, now.wrenches.items.at(0), 20);
  EXPECT_EQ(of_frame(now.wrenches.items[0].force, 5), Vector3d::Zero());  // less the baseline
  EXPECT_EQ(mat.wrenches.items.at(0).force, now.wrenches.items[0].force);
  EXPECT_EQ(mat.wrenches.items[0].name, "plate 3");
  EXPECT_EQ(mat.wrenches.items[0].corners_in_world, now.wrenches.items[0].corners_in_world);
  expect_truth(setting, c3d.wrenches.items.at(0), 20);
  EXPECT_EQ(of_frame(c3d.wrenches.items[0].force, 5), Vector3d::Zero());
}

TEST(PlateForces, FramesThatAreCutOffGiveNoBaseline) {
  Setting setting;
  auto trial = setting.trial(30, [](double i) { return i < 40.0 ? 0.04 : 1.04; });
  trial.unloaded_s = {-0.05, 0.08};  // not all of them are there
  EXPECT_NEAR(of_frame(plate_forces(trial).value().wrenches.items.at(0).force, 20).z(), 728.0, 1e-3);
}

TEST(PlateForces, CalibrationsOfSeveralSizesAreKept) {
  Setting setting;
  setting.type = 4;
  setting.units.assign(6, "V");
  setting.calibration = Eigen::MatrixXd::Identity(6, 6);
  setting.calibration(0, 1) = 0.01;
  auto trial = setting.trial(6, [](double) { return 1.0; });
  // Beside it one of type 7: eight channels, and a matrix of eight.
  Setting beside;
  beside.type = 3;
  beside.origin.head<2>().setZero();
  const auto other = beside.trial(6, [](double) { return 1.0; });
  const auto old = trial.analog;
  trial.analog.values.clear();
  for (std::int64_t i = 0; i < old.samples; ++i) {
    trial.analog.values.insert(trial.analog.values.end(), old.values.begin() + 7 * i,
                               old.values.begin() + 7 * i + 7);
    trial.analog.values.insert(trial.analog.values.end(), other.analog.values.begin() + 9 * i + 1,
                               other.analog.values.begin() + 9 * i + 9);
  }
  auto plate = other.force_plates[0];
  plate.number = 2;
  plate.type = 7;
  for (int& channel : plate.channel_idx) {
    channel += 6;
    trial.analog.names.push_back("beside" + std::to_string(channel));
    trial.analog.units.emplace_back("N");
  }
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(8, 8);
  plate.calibration.assign(one.data(), one.data() + 64);
  plate.calibration_rows = 8;
  trial.force_plates.push_back(plate);
  const auto forces = through_a_file(trial).value();
  ASSERT_EQ(forces.wrenches.items.size(), 2U);
  expect_truth(setting, forces.wrenches.items[0], 3);
  expect_truth(beside, forces.wrenches.items[1], 3);
}

TEST(PlateForces, TheFormulasOfTwelveChannelsAreThoseOfTheirMaker) {
  // As Visual3D writes them of FP_Type_6, from twelve numbers that nothing connects.
  Random random(11, 0);
  Setting setting;
  setting.type = 6;
  setting.calibration = Eigen::MatrixXd::Identity(12, 12);
  auto trial = setting.trial(3, [](double) { return 1.0; });
  double v[12];
  for (double& x : v) x = random.uniform(-60.0, 60.0);
  for (const int z : {2, 5, 8, 11}) v[z] = random.uniform(-300.0, -100.0);
  for (std::int64_t i = 0; i < trial.analog.samples; ++i)
    std::copy_n(v, 12, &trial.analog.values[13 * i + 1]);
  const double a = 0.12, b = 0.2, az0 = -0.04;
  const Vector3d force(v[0] + v[3] + v[6] + v[9], v[1] + v[4] + v[7] + v[10], v[2] + v[5] + v[8] + v[11]);
  const double mx = b * (v[2] + v[5] - v[8] - v[11]), my = a * (-v[2] + v[5] + v[8] - v[11]),
               mz = b * (-v[0] - v[3] + v[6] + v[9]) + a * (v[1] - v[4] - v[7] + v[10]);
  const double x = (az0 * force.x() - my) / force.z(), y = (mx + az0 * force.y()) / force.z();
  const auto wrench = plate_forces(trial).value().wrenches.items.at(0);
  const Matrix3d& R = setting.world_from_plate;
  EXPECT_LT((of_frame(wrench.force, 1) - R * force).norm(), 1e-9);
  EXPECT_LT((of_frame(wrench.point, 1) - setting.centre - R * Vector3d(x, y, 0.0)).norm(), 1e-12);
  EXPECT_LT((of_frame(wrench.moment, 1) - R * Vector3d(0, 0, mz - x * force.y() + y * force.x())).norm(),
            1e-9);
}

TEST(PlateForces, AnEmptyPlateDoesNothing) {
  Setting setting;
  const auto course = [](double i) { return i < 40.0 ? 1.0 : 0.025; };  // 17.5 N
  const auto trial = setting.trial(20, course);
  const auto forces = through_a_file(trial).value();
  const auto& wrench = forces.wrenches.items.at(0);
  expect_truth(setting, wrench, 8);
  EXPECT_EQ(of_frame(wrench.force, 15), Vector3d::Zero());
  EXPECT_EQ(of_frame(wrench.moment, 15), Vector3d::Zero());
  EXPECT_TRUE(of_frame(wrench.point, 15).hasNaN());
  // Only below the given threshold.
  const auto fine = through_a_file(trial, {.contact_force_n = 10.0}).value();
  EXPECT_NEAR(of_frame(fine.wrenches.items.at(0).force, 15).z(), 17.5, 1e-3);
}

TEST(PlateForces, WithoutAThresholdANegativeForceCountsToo) {
  Setting setting;
  const auto course = [](double i) { return i < 40.0 ? 1.0 : -0.1; };
  const auto trial = setting.trial(20, course);
  EXPECT_EQ(of_frame(through_a_file(trial).value().wrenches.items.at(0).force, 15), Vector3d::Zero());
  const auto all = through_a_file(trial, {.contact_force_n = 0.0}).value().wrenches.items.at(0);
  EXPECT_LT((of_frame(all.force, 15) + 0.1 * setting.world_from_plate * setting.force).norm(), 1e-3);
  // Taken at the middle of the plate, with the whole moment: the same push and twist.
  EXPECT_LT((of_frame(all.point, 15) - setting.centre).norm(), 1e-6);
  const Vector3d moment = -0.1 * (setting.position.cross(setting.force) + Vector3d(0.0, 0.0, setting.twist));
  EXPECT_LT((of_frame(all.moment, 15) - setting.world_from_plate * moment).norm(), 1e-3);
}

TEST(PlateForces, WhatTheBodyDoesToThePlateIsTurnedRound) {
  Setting setting;
  auto trial = setting.trial(5, [](double) { return 1.0; });
  for (std::size_t i = 0; i < trial.analog.values.size(); ++i)
    if (i % 7 >= 1) trial.analog.values[i] *= -1.0;
  const auto forces = through_a_file(trial).value();
  expect_truth(setting, forces.wrenches.items.at(0), 2);
  EXPECT_THAT(forces.warnings, ElementsAre(HasSubstr("plate 1 stores the force of the body")));
}

TEST(PlateForces, CornersTheWrongWayRoundAreReported) {
  Setting setting;
  setting.markers_below = true;  // all that is certain: the body is where the markers are
  const auto forces = through_a_file(setting.trial(5, [](double) { return 1.0; })).value();
  EXPECT_THAT(forces.warnings, Contains(HasSubstr("corners in the opposite order")));
  EXPECT_GT(-of_frame(forces.wrenches.items.at(0).force, 2).z(), 600.0);  // towards the markers
}

TEST(PlateForces, WithoutMarkersAnAxisOfTheLaboratoryPointsUp) {
  Setting down, up;
  up.world_from_plate = Eigen::AngleAxisd(0.7, Vector3d::UnitZ()).toRotationMatrix();
  up.force.z() = 700.0;
  for (const Setting& setting : {down, up}) {
    auto trial = setting.trial(5, [](double) { return 1.0; });
    for (std::int64_t f = 0; f < 5; ++f) trial.markers.set_missing(f, 0);
    const auto forces = through_a_file(trial).value();
    expect_truth(setting, forces.wrenches.items.at(0), 2);
    EXPECT_NEAR(of_frame(forces.wrenches.items.at(0).force, 2).z(), 700.0, 1e-3);
    EXPECT_THAT(
        forces.warnings,
        Contains(HasSubstr("no marker tells on which side of plate 1 the body is; z is taken as up")));
  }
  // With a marker nothing is said of it.
  EXPECT_THAT(through_a_file(down.trial(5, [](double) { return 1.0; })).value().warnings,
              Not(Contains(HasSubstr("no marker tells"))));
}

TEST(PlateForces, BaselineOfTheFramesThatZeroNames) {
  Setting setting;
  // 28 N of drift all the time, and a step from frame 10.
  const auto course = [](double i) { return i < 40.0 ? 0.04 : 1.04; };
  const auto trial = setting.trial(30, course);
  const auto forces = through_a_file(trial, {}, set_zero(1, 9)).value();
  expect_truth(setting, forces.wrenches.items.at(0), 20);
  EXPECT_EQ(of_frame(forces.wrenches.items.at(0).force, 5), Vector3d::Zero());
  const auto raw = through_a_file(trial, {.baseline = false}, set_zero(1, 9)).value();
  EXPECT_NEAR(of_frame(raw.wrenches.items.at(0).force, 20).z(), 728.0, 1e-3);
  // The manual reads a range from 0 as one from 1.
  expect_truth(setting, through_a_file(trial, {}, set_zero(0, 9)).value().wrenches.items.at(0), 20);
  // Ranges that name nothing.
  for (const auto& [first, last] : {std::pair{0, 0}, {1, 0}, {1, 31}, {-3, 2}}) {
    const auto as_is =
        through_a_file(trial, {}, set_zero(static_cast<std::int16_t>(first), static_cast<std::int16_t>(last)))
            .value();
    EXPECT_NEAR(of_frame(as_is.wrenches.items.at(0).force, 20).z(), 728.0, 1e-3);
  }
  // Somebody stands on it: that is no baseline.
  const auto loaded = through_a_file(trial, {}, set_zero(15, 20)).value();
  EXPECT_NEAR(of_frame(loaded.wrenches.items.at(0).force, 20).z(), 728.0, 1e-3);
  EXPECT_THAT(loaded.warnings,
              Contains(HasSubstr("carries 728 N in the frames 15 to 20 that FORCE_PLATFORM:ZERO")));
}

TEST(PlateForces, ASampleThatIsNoNumberIsNotKnown) {
  Setting setting;
  auto trial = setting.trial(10, [](double) { return 1.0; });
  trial.analog.values[7 * (4 * 5) + 4] = kNaN;  // frame 5
  const auto forces = through_a_file(trial).value();
  EXPECT_TRUE(of_frame(forces.wrenches.items.at(0).force, 5).hasNaN());
  expect_truth(setting, forces.wrenches.items.at(0), 3);
  expect_truth(setting, forces.wrenches.items.at(0), 7);
}

TEST(PlateForces, AWrongUnitShowsAtTheCentreOfPressure) {
  Setting setting;
  setting.units = {"N", "N", "N", "Ncm", "Ncm", "Ncm"};  // but the numbers are N mm
  const auto forces = through_a_file(setting.trial(6, [](double) { return 1.0; })).value();
  EXPECT_THAT(forces.warnings,
              ElementsAre(HasSubstr("the centre of pressure leaves plate 1 in 6 of 6 frames")));
  EXPECT_EQ(forces.contradicted, forces.warnings);
  EXPECT_THAT(through_a_file(Setting().trial(6, [](double) { return 1.0; })).value().contradicted, IsEmpty());
}

TEST(PlateForces, MomentsAThousandTimesTooLargeOrTooSmallAreCorrected) {
  for (const int type : {2, 4})
    for (const bool large : {true, false}) {
      Setting setting{.type = type};
      setting.calibration = Eigen::MatrixXd::Identity(6, 6);
      setting.calibration(2, 2) = 1.25;
      const std::string called = large ? "Nm" : "Nmm";
      setting.units = {"N", "N", "N", called, called, called};
      auto trial = setting.trial(6, [](double) { return 1.0; });  // in N mm
      if (!large)
        for (std::size_t i = 0; i < trial.analog.values.size(); ++i)
          if (type == 2 && i % 7 > 3) trial.analog.values[i] *= 1e-3;
      if (!large && type == 4) trial.force_plates[0].calibration[21] *= 1e-3;
      if (!large && type == 4)
        for (const std::size_t k : {28U, 35U}) trial.force_plates[0].calibration[k] *= 1e-3;
      const auto forces = through_a_file(trial).value();
      expect_truth(setting, forces.wrenches.items.at(0), 3);
      EXPECT_THAT(
          forces.warnings,
          ElementsAre(HasSubstr(fmt::format(
              "plate 1 has moments that the unit '{}' makes a thousand times too {}", called,
              large ? "large: the centre of pressure would lie metres beside the plate; they are divided by "
                      "1000"
                    : "small: the centre of pressure would stay at the middle of the sensors; they are "
                      "multiplied by 1000"))))
          << type;
      EXPECT_THAT(forces.contradicted, IsEmpty());
    }
}

TEST(PlateForces, PointsOfTheForceInAnotherUnitThanTheirWordAreCorrected) {
  Setting setting{.type = 1};
  setting.units = {"N", "N", "N", "m", "m", "Nmm"};  // but the points are in mm
  const auto forces = through_a_file(setting.trial(6, [](double) { return 1.0; })).value();
  expect_truth(setting, forces.wrenches.items.at(0), 3);
  EXPECT_THAT(forces.warnings,
              ElementsAre(HasSubstr("plate 1 has points of the force that the unit 'm' makes")));
}

TEST(PlateForces, WhatCannotBeReadIsReportedInASentence) {
  const auto message = [](const data::Trial& trial) {
    const auto forces = through_a_file(trial);
    EXPECT_FALSE(forces);
    EXPECT_EQ(forces.error().code, Code::bad_input);
    return forces.error().message;
  };
  const auto flat = [](double) { return 1.0; };
  Setting setting;
  auto trial = setting.trial(3, flat);
  trial.force_plates.clear();
  EXPECT_EQ(message(trial), "p.c3d: has no force plate whose forces can be read");
  trial = setting.trial(3, flat);
  trial.force_plates[0].type = 5;
  EXPECT_THAT(
      message(trial),
      HasSubstr("plate 1 is left out: it is of type 5; forces are read from types 1, 2, 3, 4, 6 and 7"));
  for (const int type : {11, 12, 21}) {
    trial.force_plates[0].type = type;
    EXPECT_THAT(message(trial),
                HasSubstr(fmt::format("plate 1 is left out: it is of type {}; forces", type)));
  }
  trial.force_plates[0].type = 4;
  EXPECT_THAT(message(trial), HasSubstr("is of type 4 but has no CAL_MATRIX of 6 x 6 numbers"));
  trial.force_plates[0].calibration.assign(36, 0.0);
  trial.force_plates[0].calibration_rows = 6;
  EXPECT_THAT(message(trial), HasSubstr("CAL_MATRIX of zeros"));
  trial.force_plates[0].type = 3;
  EXPECT_THAT(message(trial), HasSubstr("has 6 analog channels; type 3 needs 8"));
  Setting twelve;
  twelve.type = 6;
  twelve.calibration = Eigen::MatrixXd::Identity(12, 12);
  auto six = twelve.trial(3, flat);
  six.force_plates[0].calibration.resize(36);
  six.force_plates[0].calibration_rows = 6;
  EXPECT_THAT(message(six), HasSubstr("is of type 6 but has no CAL_MATRIX of 12 x 12 numbers"));
  trial = setting.trial(3, flat);
  trial.force_plates[0].corners_in_world[0] = trial.force_plates[0].corners_in_world[2];
  trial.force_plates[0].corners_in_world[1] = trial.force_plates[0].corners_in_world[3];
  for (auto& corner : trial.force_plates[0].corners_in_world) corner.y() = 0.0;
  EXPECT_THAT(message(trial), HasSubstr("corners that span no surface"));
  trial = setting.trial(3, flat);
  trial.force_plates[0].channel_idx[5] = trial.force_plates[0].channel_idx[4];
  EXPECT_THAT(message(trial), HasSubstr("an analog channel of it is used twice"));
  const auto wrong = through_a_file(setting.trial(3, flat), {.contact_force_n = -1.0});
  EXPECT_EQ(wrong.error().code, Code::usage);
  EXPECT_THAT(wrong.error().message, HasSubstr("contact force is -1 N"));
}

TEST(PlateForces, OnlyThePlatesThatCanBeReadAreThere) {
  Setting setting;
  auto trial = setting.trial(4, [](double) { return 1.0; });
  auto bad = trial.force_plates[0];
  bad.type = 6;
  bad.channel_idx = {0};
  trial.force_plates.insert(trial.force_plates.begin(), bad);
  const auto forces = through_a_file(trial).value();
  ASSERT_EQ(forces.wrenches.items.size(), 1u);
  EXPECT_EQ(forces.wrenches.items[0].name, "plate 2");  // as the file counts
  EXPECT_THAT(forces.warnings, IsEmpty());              // the reader of the file has said what it left out
}

/// OpenSim 4 converted this recording to force and moment about the middle of each plate, every 0.05 s.
TEST(PlateForces, WalkOfTwoPlatesIsWhatOpenSimFinds) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto folder = data / "opensim-core-formats";
  const auto forces = forces_of(folder / "walking2.c3d", {.contact_force_n = 0.0, .baseline = false}).value();
  const auto table = read_table(folder / "std_walking2_grfs.sto").value();
  ASSERT_EQ(forces.wrenches.items.size(), 2u);
  const double rate = forces.wrenches.time.rate_hz;
  double worst_force = 0.0, worst_moment = 0.0;
  int compared = 0;
  for (std::int64_t row = 0; row < table.rows(); ++row) {
    const double frame = table.time_s[static_cast<std::size_t>(row)] * rate;
    const auto f = static_cast<std::int64_t>(std::floor(frame));
    if (f + 1 >= forces.wrenches.frames()) break;
    const double later = frame - static_cast<double>(f);
    ++compared;
    for (int p = 0; p < 2; ++p) {
      const auto& wrench = forces.wrenches.items[static_cast<std::size_t>(p)];
      const auto triple = [&](const char* name) {
        Vector3d v;
        for (int i = 0; i < 3; ++i) v[i] = table(row, table.find(fmt::format("{}{}_{}", name, p + 1, i + 1)));
        return v;
      };
      const Vector3d centre = 1e-3 * triple("p");
      const auto moment = [&](std::int64_t at) -> Vector3d {
        return of_frame(wrench.moment, at) +
               (of_frame(wrench.point, at) - centre).cross(of_frame(wrench.force, at));
      };
      const Vector3d force =
          (1.0 - later) * of_frame(wrench.force, f) + later * of_frame(wrench.force, f + 1);
      worst_force = std::max(worst_force, (force - triple("f")).norm());
      worst_moment = std::max(
          worst_moment, ((1.0 - later) * moment(f) + later * moment(f + 1) - 1e-3 * triple("m")).norm());
    }
  }
  EXPECT_GT(compared, 95);
  // OpenSim takes single samples, we the mean of eight (4 ms).
  EXPECT_LT(worst_force, 4.0);
  EXPECT_LT(worst_moment, 0.8);
  ::testing::Test::RecordProperty("worst_force_n", std::to_string(worst_force));
  ::testing::Test::RecordProperty("worst_moment_nm", std::to_string(worst_moment));
}

/// One standing person on a plate: 783 N, as the file says, not far from the middle of the markers.
TEST(PlateForces, StandingPersonPressesUnderTheMarkers) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto forces = forces_of(data / "pycgm-rom/Sample_Static.c3d").value();
  for (std::int64_t f = 0; f < forces.wrenches.frames(); ++f) {
    EXPECT_NEAR(of_frame(forces.wrenches.items.at(0).force, f).z(), 781.0, 6.0);
    EXPECT_LT((of_frame(forces.wrenches.items.at(0).point, f) - Vector3d(0.22, 0.26, 0.0)).norm(), 0.05);
  }
}

/// c3d.org's pair: the same recording with the whole calibration matrix and with its diagonal only.
TEST(PlateForces, TypesTwoAndFourOfOneRecordingAgree) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto two = forces_of(data / "c3d-org/sample10/TYPE-2.C3D").value();
  const auto four = forces_of(data / "c3d-org/sample10/TYPE-4.C3D").value();
  int loaded = 0;
  for (std::int64_t f = 0; f < two.wrenches.frames(); ++f) {
    const Vector3d a = of_frame(two.wrenches.items.at(0).force, f),
                   b = of_frame(four.wrenches.items.at(0).force, f);
    if (a.z() < 100.0 || b.z() < 100.0) continue;
    ++loaded;
    EXPECT_LT((a - b).norm(), 0.05 * a.norm());  // cross-talk of a few percent
    const Vector3d gap =
        of_frame(two.wrenches.items.at(0).point, f) - of_frame(four.wrenches.items.at(0).point, f);
    EXPECT_LT(gap.norm(), 0.03);
  }
  EXPECT_GT(loaded, 30);
}

}  // namespace
}  // namespace kinemark::io
