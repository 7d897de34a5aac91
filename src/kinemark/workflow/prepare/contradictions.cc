// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/contradictions.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "kinemark/model/model.h"
#include "kinemark/stages/analysis/consistency/model_facts.h"
#include "kinemark/stages/analysis/gait/gait.h"
#include "kinemark/stages/motion/dynamics/masses.h"
#include "kinemark/stages/motion/foundations/body_size.h"
#include "kinemark/stages/motion/foundations/judge.h"
#include "kinemark/stages/motion/foundations/standing_body.h"
#include "kinemark/workflow/foundations/foundation_gate.h"
#include "kinemark/workflow/prepare/stated_mass.h"

namespace kinemark::workflow {
namespace {

constexpr const char* kRecording = "the recording";
constexpr std::string_view kBegin = "What this rests on is contradicted: ";

void append(std::vector<std::string>&& from, std::vector<std::string>& to) {
  std::ranges::move(from, std::back_inserter(to));
}

Status hold_body(const data::Trajectories& markers, const HeldFacts& facts, std::vector<std::string>& out) {
  const auto body = motion::body_of_names(markers.names);
  if (const auto size = motion::size_of_body(body, markers); facts.size && size && size->is_nobodys())
    return out.push_back(size->sentence()), Status();  // of such a body nothing else can be said
  if (facts.sides) note_mirrored(kRecording, body, markers, out);
  if (!facts.pairs) return {};
  const auto pairs = find_exchanged_pairs(kRecording, markers);
  if (!pairs) return std::unexpected(pairs.error());
  for (const auto& pair : *pairs) out.push_back(motion::describe(pair, kRecording));
  return {};
}

void hold_walk(const data::Recording& recording, const HeldFacts& facts, std::vector<std::string>& out) {
  const bool plates = facts.plates && recording.plates, events = facts.events && recording.rate_known;
  if (!plates && !events) return;
  auto found =
      analysis::contradictions_of(recording.trial.markers, {.plates = plates ? &*recording.plates : nullptr,
                                                            .events = recording.trial.events,
                                                            .mass_kg = stated_mass_kg(recording.trial)});
  if (facts.sides) append(std::move(found.names), out);
  if (events) append(std::move(found.labels), out);
  append(std::move(found.plates), out);
}

}  // namespace

Result<std::vector<std::string>> find_contradictions(const data::Recording& recording,
                                                     const HeldFacts& facts) {
  std::vector<std::string> out;
  if (facts.size || facts.sides || facts.pairs)
    if (auto s = hold_body(recording.trial.markers, facts, out); !s) return std::unexpected(s.error());
  hold_walk(recording, facts, out);
  // Spans of one exchange are described alike: said once.
  std::vector<std::string> once;
  for (auto& sentence : out)
    if (std::ranges::find(once, sentence) == once.end()) once.push_back(std::move(sentence));
  return once;
}

std::vector<std::string> contradicted_model(const data::ModelDescription& model,
                                            std::vector<std::string>* small) {
  auto out = analysis::contradicted_joints(model);
  const auto compiled = model::Model::compile(model);
  if (!compiled) return out;
  for (const auto& fault : motion::find_mass_faults(*compiled))
    if (fault.matters)
      out.push_back(fault.sentence());
    else if (small != nullptr)
      small->push_back(fault.sentence());
  return out;
}

void add_contradictions(const std::vector<std::string>& contradicted, std::vector<data::Gate>& gates) {
  if (contradicted.empty()) return;
  auto gate = std::ranges::find(gates, "contradictions", &data::Gate::name);
  if (gate == gates.end())
    gate = gates.insert(gates.end(), {.name = "contradictions",
                                      .passed = false,
                                      .value = 0.0,
                                      .bound = 0.0,
                                      .unit = "findings",
                                      .sentence = std::string(kBegin) + "."});
  for (const auto& one : contradicted) {
    if (gate->sentence.find(one) != std::string::npos) continue;
    gate->sentence.pop_back();
    gate->sentence += fmt::format("{}{}.", gate->value > 0.0 ? "; " : "", one);
    gate->value += 1.0;
  }
}

}  // namespace kinemark::workflow
