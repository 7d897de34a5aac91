// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/scale/scale_job.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "kinemark/io/file.h"
#include "kinemark/io/input/file_hash.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/osim/osim_writer.h"
#include "kinemark/io/osim/scale_setup.h"
#include "kinemark/pipeline/simulate/simulate_subject_job.h"
#include "kinemark/pipeline/testing/shared_folder.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::pipeline {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

/// A simulated recording, and a model that is 7 % too small for it.
class RunScale : public testing::SharedFolder<RunScale> {
 public:
  static void make_files() {
    SimulateSubjectJob subject;
    subject.folder = at("in");
    subject.options.duration_s = 3.0;
    subject.options.rate_hz = 60.0;
    run_simulate_subject(subject).value();
    auto model = io::read_osim(at("in/model.osim")).value();
    const std::vector<Eigen::Vector3d> factors(model.bodies.size(), Eigen::Vector3d::Constant(0.93));
    motion::apply_factors(model, factors, true);
    io::write_osim(at("small.osim"), model).value();
  }

 protected:
  static ScaleJob job(const std::string& output) {
    ScaleJob j;
    j.model = at("small.osim");
    j.markers = at("in/markers.c3d");
    j.output = at(output);
    return j;
  }
  static std::string message(const ScaleJob& job) {
    const auto outcome = run_scale(job);
    return outcome ? "it ran" : outcome.error().message;
  }
};

/// What scaling changes, after a model was written and read.
void expect_same_geometry(const data::ModelDescription& ours, const data::ModelDescription& read) {
  ASSERT_EQ(read.joints.size(), ours.joints.size());
  for (std::size_t j = 0; j < ours.joints.size(); ++j) {
    const auto &a = ours.joints[j], &b = read.joints[j];
    EXPECT_LT((a.parent_from_joint.translation - b.parent_from_joint.translation).norm(), 1e-9) << a.name;
    EXPECT_LT((a.child_from_joint.translation - b.child_from_joint.translation).norm(), 1e-9) << a.name;
    ASSERT_EQ(a.axes.size(), b.axes.size()) << a.name;
    for (std::size_t k = 0; k < a.axes.size(); ++k)
      for (const double angle : {-0.7, 0.4})
        EXPECT_NEAR(a.axes[k].function(angle).f, b.axes[k].function(angle).f, 1e-9) << a.name;
  }
  ASSERT_EQ(read.bodies.size(), ours.bodies.size());
  for (std::size_t i = 0; i < ours.bodies.size(); ++i) {
    EXPECT_NEAR(read.bodies[i].mass, ours.bodies[i].mass, 1e-9) << ours.bodies[i].name;
    EXPECT_LT((read.bodies[i].com_in_body - ours.bodies[i].com_in_body).norm(), 1e-9) << ours.bodies[i].name;
    EXPECT_LT((read.bodies[i].inertia_about_com - ours.bodies[i].inertia_about_com).norm(), 1e-9);
  }
  ASSERT_EQ(read.markers.size(), ours.markers.size());
  for (std::size_t m = 0; m < ours.markers.size(); ++m)
    EXPECT_LT((read.markers[m].x_in_body - ours.markers[m].x_in_body).norm(), 1e-9) << ours.markers[m].name;
}

TEST_F(RunScale, finds_the_size_from_motion_and_writes_model_and_report) {
  ScaleJob j = job("M.osim");
  j.mass_kg = 60.0;
  const auto outcome = run_scale(j);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 0);
  ASSERT_TRUE(outcome->from_motion);
  EXPECT_LT(outcome->from_motion->rms_after_m, 0.003);
  for (std::size_t b = 0; b < outcome->model.bodies.size(); ++b) {
    const auto& factor = outcome->factors[b];
    if (factor.body.starts_with("femur") || factor.body.starts_with("tibia")) {
      EXPECT_NEAR(factor.factors.y(), 1.0 / 0.93, 0.03) << factor.body;
    }
  }
  const auto written = io::read_osim(at("M.osim"));
  ASSERT_TRUE(written) << written.error().message;
  double mass = 0.0;
  for (const auto& body : written->bodies) mass += body.mass;
  EXPECT_NEAR(mass, 60.0, 1e-6);
  expect_same_geometry(outcome->model, *written);
  const auto report = nlohmann::json::parse(io::read_text(at("M_report.json")).value());
  EXPECT_EQ(report["format"], "kinemark-scale");
  EXPECT_NEAR(report["mass_kg"].get<double>(), 60.0, 1e-6);
  EXPECT_GT(report["motion"]["lengths"].size(), 10U);
  std::vector<std::string> open = report["motion"]["not_determined"];
  EXPECT_THAT(open, Contains("head"));
  for (const auto& p : report["motion"]["parameters"]) EXPECT_GT(p["sd"].get<double>(), 0.0);
}

TEST_F(RunScale, moves_clavicles_and_distributes_a_mass_when_asked) {
  ScaleJob j = job("clavicles.osim");
  j.markers.clear();
  j.static_trial = at("in/markers.c3d");
  j.clavicles = true;
  j.dempster = true;
  j.mass_kg = 80.0;
  const auto outcome = run_scale(j);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_GE(outcome->model.find_coordinate("clav_elevation_l"), 0);
  EXPECT_TRUE(outcome->placed);
  EXPECT_TRUE(outcome->from_static);
  const auto& thigh = outcome->model.bodies[static_cast<std::size_t>(outcome->model.find_body("femur_r"))];
  EXPECT_NEAR(thigh.mass, 8.0, 1e-9);
}

/// The hips of a model among the markers of its pelvis, as `joints` writes them.
std::string hips_of(const data::ModelDescription& model, double sd_m, const std::string& hash) {
  const auto numbers = [](const Eigen::Vector3d& x) { return nlohmann::json{x.x(), x.y(), x.z()}; };
  nlohmann::json json{{"schema", "kinemark.skeleton"}, {"input", {{"path", "star.c3d"}, {"xxh3_64", hash}}}};
  for (const char* body : {"pelvis", "femur_r", "femur_l"}) {
    nlohmann::json markers = nlohmann::json::array();
    for (const auto& marker : model.markers)
      if (marker.body_idx == model.find_body(body))
        markers.push_back({{"name", marker.name}, {"x_in_segment_m", numbers(marker.x_in_body)}});
    json["segments"].push_back({{"name", body}, {"kind", "solid"}, {"markers", std::move(markers)}});
  }
  const double v = sd_m * sd_m;
  const nlohmann::json C{{v, 0, 0}, {0, v, 0}, {0, 0, v}};
  for (const std::string side : {"r", "l"})
    for (const auto& joint : model.joints)
      if (joint.name == "hip_" + side)
        json["joints"].push_back({{"name", "hip " + side},
                                  {"kind", "ball"},
                                  {"parent", "pelvis"},
                                  {"child", "femur_" + side},
                                  {"centre_in_parent_m", numbers(joint.parent_from_joint.translation)},
                                  {"covariance_in_parent_m2", C}});
  return json.dump();
}

/// The distance between the hips of a model.
double between_hips(const data::ModelDescription& model) {
  std::vector<Eigen::Vector3d> hips;
  for (const auto& joint : model.joints)
    if (joint.name.starts_with("hip_")) hips.push_back(joint.parent_from_joint.translation);
  return hips.size() == 2 ? (hips[0] - hips[1]).norm() : 0.0;
}

// A static trial does not tell how far apart the hips of a subject are.
TEST_F(RunScale, functional_joints_place_those_of_the_model) {
  auto subject = io::read_osim(at("in/model.osim")).value();
  for (auto& joint : subject.joints)
    if (joint.name.starts_with("hip_")) joint.parent_from_joint.translation.z() *= 1.25;
  io::write_text(at("skeleton.json"), hips_of(subject, 0.001, "0123456789abcdef"), true).value();
  SimulateSubjectJob standing;
  standing.folder = at("standing");
  standing.options.duration_s = 0.05;
  run_simulate_subject(standing).value();
  ScaleJob j = job("without.osim");
  j.markers.clear();
  j.static_trial = at("standing/markers.c3d");
  const auto without = run_scale(j);
  ASSERT_TRUE(without) << without.error().message;
  j.output = at("with.osim");
  j.joints = at("skeleton.json");
  const auto with = run_scale(j);
  ASSERT_TRUE(with) << with.error().message;
  EXPECT_THAT(with->joints, ::testing::UnorderedElementsAre("hip_r", "hip_l"));
  EXPECT_THAT(with->warnings, Not(Contains(HasSubstr("none of its joints is one of the model; sizes"))));
  const double asked = between_hips(subject);
  EXPECT_NEAR(between_hips(with->model), asked, 0.004);
  EXPECT_GT(std::abs(between_hips(without->model) - asked), 0.02);
  EXPECT_GT(
      std::ranges::count_if(with->from_static->parameters,
                            [](const auto& p) { return p.kind == motion::ParameterKind::joint_offset; }),
      5);
  const auto report = nlohmann::json::parse(io::read_text(at("with_report.json")).value());
  EXPECT_EQ(report["joints"].size(), 2U);
}

TEST_F(RunScale, joints_of_the_very_motion_do_not_count_twice) {
  auto subject = io::read_osim(at("in/model.osim")).value();
  for (auto& joint : subject.joints)
    if (joint.name.starts_with("hip_")) joint.parent_from_joint.translation.z() *= 1.25;
  io::write_text(at("skeleton.json"), hips_of(subject, 1e-4, io::hash_file(at("in/markers.c3d"))->hex), true)
      .value();
  ScaleJob j = job("once.osim");
  j.joints = at("skeleton.json");
  const auto outcome = run_scale(j);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->joints.size(), 2U);
  // The false centres change nothing; the motion tells the true ones.
  EXPECT_NEAR(between_hips(outcome->model), between_hips(io::read_osim(at("in/model.osim")).value()), 0.008);
}

TEST_F(RunScale, joints_that_the_model_does_not_have_are_said) {
  auto subject = io::read_osim(at("in/model.osim")).value();
  for (auto& marker : subject.markers) marker.name += "_of_another";
  io::write_text(at("skeleton.json"), hips_of(subject, 1e-3, ""), true).value();
  ScaleJob j = job("none.osim");
  j.joints = at("skeleton.json");
  const auto outcome = run_scale(j);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_TRUE(outcome->joints.empty());
  EXPECT_THAT(outcome->warnings, Contains(HasSubstr("none of its joints is one of the model; sizes alone")));
  EXPECT_THAT(outcome->warnings, Contains(HasSubstr("segment 'pelvis' has fewer than two markers")));
  j = job("unread.osim");
  j.joints = at("in/model.osim");
  EXPECT_THAT(message(j), HasSubstr("not JSON"));
}

TEST_F(RunScale, follows_an_opensim_setup_to_its_answer) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const fs::path folder = data / "opensim-gait2354";
  ScaleJob j;
  j.setup = folder / "subject01_Setup_Scale.xml";
  j.output = at("gait.osim");
  const auto outcome = run_scale(j);
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_TRUE(outcome->scaled);
  ASSERT_TRUE(outcome->placed);
  const auto scales = io::read_scale_set(folder / "subject01_scaleSet_applied.xml").value();
  int compared = 0;
  for (const auto& scale : scales)
    for (const auto& factor : outcome->factors) {
      if (factor.body != scale.body) continue;
      EXPECT_LT((factor.factors - scale.factors).norm(), 2e-4) << scale.body;
      ++compared;
    }
  EXPECT_EQ(compared, 12);
  double mass = 0.0;
  for (const auto& body : outcome->model.bodies) mass += body.mass;
  EXPECT_NEAR(mass, 72.6, 1e-9);
}

/// The first frame of the simulated recording as a static trial; `first` and `second` exchanged.
void write_static(const fs::path& from, const fs::path& to, const std::string& first,
                  const std::string& second) {
  const auto moving = io::read_markers(from).value().markers;
  data::Trial out;
  out.markers = data::Trajectories::all_missing(moving.names, {.rate_hz = 100.0, .frames = 5});
  for (std::int64_t f = 0; f < 5; ++f)
    for (std::int64_t m = 0; m < moving.markers(); ++m) {
      const auto& name = moving.names[static_cast<std::size_t>(m)];
      const auto source = name == first ? moving.find(second) : name == second ? moving.find(first) : m;
      if (!moving.present(0, source)) continue;
      out.markers.x(f, m) = moving.x(0, source);
      out.markers.state[out.markers.index(f, m)] = data::SampleState::measured;
    }
  ASSERT_TRUE(io::write_markers(to, out, false));
}

TEST_F(RunScale, a_static_trial_with_two_markers_exchanged_is_named_before_it_is_built_on) {
  write_static(at("in/markers.c3d"), at("standing.trc"), "", "");
  write_static(at("in/markers.c3d"), at("exchanged.trc"), "LTOE", "LHEE");
  ScaleJob j = job("standing.osim");
  j.markers.clear();
  j.static_trial = at("standing.trc");
  const auto good = run_scale(j);
  ASSERT_TRUE(good) << good.error().message;
  EXPECT_EQ(good->exit_status(), 0) << good->warnings.back();
  ASSERT_EQ(good->static_trials.size(), 1U);
  EXPECT_TRUE(good->static_trials[0].judgement.findings.empty());
  EXPECT_EQ(good->from_static->tissue_sd_m, 0.0);  // one posture: not asked
  j.output = at("exchanged.osim");
  j.static_trial = at("exchanged.trc");
  const auto bad = run_scale(j);
  ASSERT_TRUE(bad) << bad.error().message;
  EXPECT_EQ(bad->exit_status(), 1);
  EXPECT_THAT(bad->warnings, Contains(HasSubstr("LHEE and LTOE are exchanged in exchanged.trc")));
  const auto report = nlohmann::json::parse(io::read_text(at("exchanged_report.json")).value());
  EXPECT_EQ(report["exit_status"], 1);
  EXPECT_EQ(report["static_trials"][0]["findings"][0]["marker"], "LHEE");
  EXPECT_TRUE(report["static"]["soft_tissue_sd_m"].is_null());
}

TEST_F(RunScale, a_poor_fit_is_written_and_said) {
  ScaleJob j = job("poor.osim");
  j.max_rms_m = 1e-5;
  const auto outcome = run_scale(j);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 1);
  ASSERT_EQ(outcome->warnings.size(), 1U);
  EXPECT_THAT(outcome->warnings[0], HasSubstr("The RMS distance between measured and model markers is"));
  EXPECT_THAT(outcome->warnings[0], HasSubstr("at most 0.0 mm is accepted"));
}

/// A setup that scales a thigh by hand, and a model for it with `muscles`.
ScaleJob by_hand(const fs::path& folder, const std::string& name, const std::string& muscles) {
  auto model = io::read_text(folder / "in/model.osim").value();
  model.insert(model.find("</Model>"), "<ForceSet><objects>" + muscles + "</objects></ForceSet>");
  EXPECT_TRUE(io::write_text(folder / (name + "_plain.osim"), model, true));
  EXPECT_TRUE(io::write_text(
      folder / (name + ".xml"),
      "<OpenSimDocument Version=\"40000\"><ScaleTool name=\"s\"><ModelScaler><apply>true</apply>"
      "<scaling_order>manualScale</scaling_order><ScaleSet><objects><Scale><scales>1.1 1.1 1.1</scales>"
      "<segment>femur_r</segment><apply>true</apply></Scale></objects></ScaleSet></ModelScaler>"
      "<MarkerPlacer><apply>false</apply></MarkerPlacer></ScaleTool></OpenSimDocument>",
      true));
  ScaleJob j;
  j.setup = folder / (name + ".xml");
  j.model = folder / (name + "_plain.osim");
  j.output = folder / (name + ".osim");
  return j;
}

TEST_F(RunScale, WhereNoMarkerWasPlacedNoDistanceIsGiven) {
  const auto outcome = run_scale(by_hand(at(""), "hand", ""));
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 0);
  std::string said;
  for (const auto& gate : outcome->gates) said += gate.sentence;
  EXPECT_THAT(said, Not(HasSubstr("The RMS distance between measured and model markers is")));
}

std::string muscle(const std::string& name, const std::string& first_point, const std::string& wraps) {
  return "<Thelen2003Muscle name=\"" + name +
         "\"><optimal_fiber_length>0.1</optimal_fiber_length><tendon_slack_length>0.2</tendon_slack_length>"
         "<GeometryPath name=\"path\"><PathPointSet><objects>" +
         first_point +
         "<PathPoint name=\"b\"><socket_parent_frame>/bodyset/tibia_r</socket_parent_frame>"
         "<location>0.05 -0.1 0</location></PathPoint></objects></PathPointSet><PathWrapSet><objects>" +
         wraps + "</objects></PathWrapSet></GeometryPath></Thelen2003Muscle>";
}

TEST_F(RunScale, what_is_not_exact_of_muscles_is_said_and_nothing_of_those_that_are) {
  const std::string point =
      "<PathPoint name=\"a\"><socket_parent_frame>/bodyset/femur_r</socket_parent_frame>"
      "<location>0.05 0 0</location></PathPoint>";
  const auto warnings = [&](const std::string& name, const std::string& muscles) {
    const auto outcome = run_scale(by_hand(at(""), name, muscles));
    EXPECT_TRUE(outcome) << outcome.error().message;
    return outcome ? outcome->warnings : std::vector<std::string>();
  };
  const auto straight = muscle("straight", point, "");
  const auto exact = warnings("exact", straight);
  EXPECT_THAT(exact, Not(Contains(HasSubstr("The lengths of muscles at rest stay as they are, because"))));
  EXPECT_THAT(exact, Not(Contains(HasSubstr("follow paths that bend around cylinders only; these may"))));
  const auto bent = warnings(
      "bent", straight + muscle("bent", point, "<PathWrap><wrap_object>knee</wrap_object></PathWrap>"));
  EXPECT_THAT(bent,
              Contains("Lengths at rest follow paths that bend around cylinders only; these may also meet "
                       "other surfaces: bent"));
  const auto unread =
      warnings("unread",
               muscle("odd",
                      "<ConditionalPathPoint name=\"P2\"><socket_parent_frame>/bodyset/femur_r"
                      "</socket_parent_frame><location>0 0 0</location><socket_coordinate>/jointset/none/none"
                      "</socket_coordinate><range>0 1</range></ConditionalPathPoint>",
                      ""));
  EXPECT_THAT(unread,
              Contains(HasSubstr("The lengths of muscles at rest stay as they are, because their paths "
                                 "cannot be read: ")));
}

TEST_F(RunScale, says_what_is_missing_or_wrong) {
  ScaleJob j = job("no.osim");
  j.markers.clear();
  EXPECT_THAT(message(j), HasSubstr("nothing to scale by"));
  j = job("no.osim");
  j.model.clear();
  EXPECT_THAT(message(j), HasSubstr("no model"));
  j = job("no.osim");
  j.output.clear();
  EXPECT_THAT(message(j), HasSubstr("no output"));
  j = job("no.osim");
  j.dempster = true;
  EXPECT_THAT(message(j), HasSubstr("give --mass"));
  j = job("no.osim");
  j.size_prior_sd = 0.0;
  EXPECT_THAT(message(j), HasSubstr("a prior of 0"));
  j = job("no.osim");
  j.markers = at("absent.c3d");
  EXPECT_THAT(message(j), HasSubstr("absent.c3d"));
  j = job("no.osim");
  j.setup = at("in/model.osim");
  EXPECT_THAT(message(j), HasSubstr("has no <ScaleTool>"));
  EXPECT_FALSE(fs::exists(at("no.osim")));
}

TEST_F(RunScale, replaces_nothing_unless_asked) {
  io::write_text(at("there.osim"), "mine", false).value();
  EXPECT_THAT(message(job("there.osim")), HasSubstr("there.osim"));
  EXPECT_EQ(io::read_text(at("there.osim")).value(), "mine");
}

}  // namespace
}  // namespace kinemark::pipeline
