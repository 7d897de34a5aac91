// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/segment_graph.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "kinemark/core/check.h"
#include "kinemark/core/nearest_name.h"
#include "kinemark/stages/analysis/segments/internal/functions.h"

namespace kinemark::analysis {
namespace {

// What a definition may ask of stack and memory; that of a whole body takes 15 and 500.
constexpr std::size_t kMostInARow = 200;
constexpr std::size_t kMostSteps = 20'000;
constexpr int kDeepest = 1200;  // levels of formulas; one of 2000 letters may have half as many

std::string_view word_of(StepType type) {
  return type == StepType::number   ? "a number"
         : type == StepType::vector ? "a point or direction"
                                    : "a segment";
}

bool counts(InTrial trial, bool in_static) {
  return trial == InTrial::any || (trial == InTrial::fixed) == in_static;
}

/// What a formula became: a step, or the names without which there is none.
struct Made {
  int step = -1;
  StepType type = StepType::number;
  std::set<std::string> lacks;
};

class Builder {
 public:
  Builder(const SegmentDefinition& definition, const GraphNames& names)
      : d_(definition), names_(names), levels_(names.levels != nullptr ? *names.levels : own_levels_) {}

  Result<Made> output(const GraphOutput& wanted) {
    if (wanted.angle == nullptr) {
      auto made = formula(*wanted.formula);
      if (made && made->type != wanted.type)
        return fail(Code::bad_input, fmt::format("the formula gives {}; expected {}", word_of(made->type),
                                                 word_of(wanted.type)));
      return made;
    }
    auto parent = segment(wanted.angle->parent), child = segment(wanted.angle->child);
    for (const auto& [made, name] :
         {std::pair{&parent, wanted.angle->parent}, {&child, wanted.angle->child}}) {
      if (!*made) return *made;
      if ((*made)->type != StepType::frame)
        return fail(Code::bad_input, fmt::format("no segment is called '{}'", name));
    }
    return step(StepType::vector, {*parent, *child}, internal::angle_function(*wanted.angle));
  }

  /// The graph, with inputs first; `outputs` are what output() gave.
  SegmentGraph graph(const std::vector<Made>& outputs) && {
    SegmentGraph out;
    std::vector<int> order;  // of the steps made so far, in the graph
    const auto inputs_of = [&](const std::map<std::string, int>& of, std::vector<std::string>& list) {
      for (const auto& [name, index] : of) {
        order.push_back(index);
        list.push_back(name);
      }
    };
    inputs_of(marker_steps_, out.markers);
    inputs_of(parameter_steps_, out.parameters);
    const auto inputs = order.size();
    std::vector<int> number(steps_.size(), -1);
    for (std::size_t i = 0; i < inputs; ++i) number[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      if (number[i] >= 0) continue;
      number[i] = static_cast<int>(order.size());
      order.push_back(static_cast<int>(i));
    }
    out.followers.resize(inputs);
    for (std::size_t i = 0; i < order.size(); ++i) {
      Step step = std::move(steps_[static_cast<std::size_t>(order[i])]);
      for (int& from : step.from) from = number[static_cast<std::size_t>(from)];
      if (i < inputs) step.inputs = {static_cast<int>(i)};
      std::set<int> depends(step.inputs.begin(), step.inputs.end());
      for (const int from : step.from) {
        const auto& more = out.steps[static_cast<std::size_t>(from)].inputs;
        depends.insert(more.begin(), more.end());
      }
      step.inputs.assign(depends.begin(), depends.end());
      if (i >= inputs)
        for (const int input : step.inputs)
          out.followers[static_cast<std::size_t>(input)].push_back(static_cast<int>(i));
      out.steps.push_back(std::move(step));
    }
    for (const auto& made : outputs) {
      out.outputs.push_back(made.lacks.empty() ? number[static_cast<std::size_t>(made.step)] : -1);
      out.lacks.push_back(made.lacks);
    }
    return out;
  }

 private:
  Made step(StepType type, const std::vector<Made>& from, internal::StepFunction evaluate) {
    Made out{.type = type};
    for (const auto& one : from) out.lacks.insert(one.lacks.begin(), one.lacks.end());
    if (!out.lacks.empty()) return out;
    Step made{.type = type, .evaluate = std::move(evaluate)};
    for (const auto& one : from) made.from.push_back(one.step);
    out.step = static_cast<int>(steps_.size());
    steps_.push_back(std::move(made));
    return out;
  }
  Made input(std::map<std::string, int>& list, const std::string& name, StepType type) {
    auto at = list.find(name);
    if (at == list.end()) {
      at = list.emplace(name, static_cast<int>(steps_.size())).first;
      steps_.push_back({.type = type});
    }
    return {.step = at->second, .type = type};
  }
  Made constant(StepType type, const StepValue& value) {
    return step(type, {}, [value](std::span<const StepValue* const>, StepValue& out) { out = value; });
  }

  Result<Made> formula(const Formula& f) {
    if (levels_ >= kDeepest)
      return fail(Code::bad_input,
                  fmt::format("formulas stand more than {} levels deep within each other", kDeepest));
    ++levels_;
    auto made = made_of(f);
    --levels_;
    return made;
  }
  Result<Made> made_of(const Formula& f) {
    switch (f.kind) {
      case Formula::Kind::number:
        return constant(StepType::number, {f.value});
      case Formula::Kind::name:
        return named(f);
      case Formula::Kind::call:
        break;
    }
    return f.name == "any" ? first_there(f) : called(f);
  }
  // The first argument that lacks nothing.
  Result<Made> first_there(const Formula& f) {
    if (f.arguments.empty()) return fail(Code::bad_input, "any() needs arguments");
    auto first = formula(f.arguments.front());
    for (std::size_t k = 1; first && !first->lacks.empty() && k < f.arguments.size(); ++k) {
      auto next = formula(f.arguments[k]);
      if (!next) return next;
      if (next->type != first->type) return fail(Code::bad_input, "any() needs arguments of one kind");
      if (next->lacks.empty()) first = std::move(next);
    }
    return first;
  }
  Result<Made> called(const Formula& f) {
    std::vector<Made> arguments;
    std::vector<std::string_view> words;
    for (const auto& one : f.arguments) {
      auto made = formula(one);
      if (!made) return made;
      words.push_back(word_of(made->type));
      arguments.push_back(std::move(*made));
    }
    std::vector<std::string> known;
    bool found = false;
    for (const auto& form : internal::function_forms()) {
      known.emplace_back(form.name);
      if (form.name != f.name) continue;
      found = true;
      if (fits(form, arguments)) return step(form.result, arguments, form.evaluate);
    }
    if (found)
      return fail(Code::bad_input, fmt::format("{}() does not take ({})", f.name, fmt::join(words, ", ")));
    const auto near = nearest_names(f.name, known, 1);
    return fail(Code::bad_input, fmt::format("no function is called '{}'{}", f.name,
                                             near.empty() ? "" : fmt::format("; did you mean {}?", near[0])));
  }
  static bool fits(const internal::FunctionForm& form, const std::vector<Made>& arguments) {
    const auto n = form.arguments.size();
    if (form.many ? arguments.size() < n : arguments.size() != n) return false;
    for (std::size_t k = 0; k < arguments.size(); ++k)
      if (arguments[k].type != form.arguments[std::min(k, n - 1)]) return false;
    return true;
  }

  Result<Made> named(const Formula& f) {
    if (f.part.empty()) return entry(f.name);
    auto frame = segment(f.name);
    if (!frame) return frame;
    if (frame->type != StepType::frame)
      return fail(Code::bad_input, fmt::format("'{}.{}': no segment is called '{}'", f.name, f.part, f.name));
    const int part = f.part == "o" ? 3 : f.part[0] - 'x';
    return step(StepType::vector, {*frame}, internal::part_function(part));
  }
  Result<Made> segment(const std::string& name) { return entry(name); }

  Result<Made> entry(const std::string& name) {
    if (const auto at = made_.find(name); at != made_.end()) return at->second;
    if (!open_.insert(name).second) return fail(Code::bad_input, fmt::format("'{}' needs itself", name));
    if (open_.size() > kMostInARow || steps_.size() > kMostSteps)
      return fail(Code::bad_input, fmt::format("'{}' needs more than {} entries in a row, or {} steps", name,
                                               kMostInARow, kMostSteps));
    auto made = make(name);
    open_.erase(name);
    if (made) made_.emplace(name, *made);
    return made;
  }
  Result<Made> make(const std::string& name) {
    if (name == "pi") return constant(StepType::number, {3.14159265358979323846});
    if (name == "up") return constant(StepType::vector, {names_.up.x(), names_.up.y(), names_.up.z()});
    if (name == "lab") return constant(StepType::frame, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    if (name == "progression") return progression();
    for (const auto& p : d_.parameters)
      if (p.name == name) return parameter(name);
    for (const auto& p : d_.points)
      if (p.name == name && counts(p.trial, names_.static_trial)) return at(name, vector_of(p.formula));
    for (const auto& l : d_.landmarks)
      if (l.name == name) return landmark(l);
    for (const auto& s : d_.segments)
      if (s.name == name && counts(s.trial, names_.static_trial)) return at(name, frame(s));
    if (names_.has_marker(name)) return input(marker_steps_, name, StepType::vector);
    return Made{.type = StepType::vector, .lacks = {name}};
  }
  static Result<Made> at(const std::string& name, Result<Made> made) {
    if (!made && made.error().message.find(": ") == std::string::npos) return fail_at(name, made.error());
    return made;
  }
  Made parameter(const std::string& name) {
    if (names_.has_parameter(name)) return input(parameter_steps_, name, StepType::number);
    return Made{.type = StepType::number, .lacks = {name}};
  }
  Result<Made> landmark(const SegmentDefinition::Landmark& l) {
    auto carrier = segment(l.segment);
    if (!carrier) return carrier;
    std::vector<Made> from{*carrier};
    for (const char* axis : {"@x", "@y", "@z"})
      from.push_back(names_.has_parameter(l.name + axis)
                         ? input(parameter_steps_, l.name + axis, StepType::number)
                         : Made{.type = StepType::number, .lacks = {l.name}});
    for (const auto& form : internal::function_forms())
      if (form.name == "at") return step(StepType::vector, from, form.evaluate);
    return fail(Code::bad_input, "no function is called 'at'");
  }
  Made progression() {
    if (!names_.progression) return Made{.type = StepType::frame, .lacks = {"progression"}};
    StepValue value{};
    Eigen::Map<Eigen::Matrix3d>(value.data()) = *names_.progression;
    return constant(StepType::frame, value);
  }
  Result<Made> vector_of(const Formula& f) {
    auto made = formula(f);
    if (made && made->type != StepType::vector)
      return fail(Code::bad_input, fmt::format("the formula gives {}; expected {}", word_of(made->type),
                                               word_of(StepType::vector)));
    return made;
  }
  Result<Made> frame(const SegmentDefinition::Segment& s) {
    std::vector<Made> from;
    for (const Formula* f : {&s.origin, &s.first_along, &s.second_along}) {
      auto made = vector_of(*f);
      if (!made) return made;
      from.push_back(std::move(*made));
    }
    Made out = step(StepType::frame, from, internal::frame_function(s.first, s.second));
    for (const auto& [axis, by] : s.turns) {
      auto angle = formula(by);
      if (!angle) return angle;
      if (angle->type != StepType::number)
        return fail(Code::bad_input, fmt::format("a turn is {}; expected a number", word_of(angle->type)));
      out = step(StepType::frame, {out, *angle}, internal::turn_function(axis));
    }
    return out;
  }

  const SegmentDefinition& d_;
  const GraphNames& names_;
  std::vector<Step> steps_;
  std::map<std::string, Made> made_;
  std::set<std::string> open_;
  std::map<std::string, int> marker_steps_, parameter_steps_;
  int own_levels_ = 0;
  int& levels_;
};

}  // namespace

void SegmentGraph::evaluate(std::vector<StepValue>& values) const {
  std::vector<const StepValue*> arguments;
  for (auto i = static_cast<std::size_t>(inputs()); i < steps.size(); ++i) {
    arguments.clear();
    for (const int from : steps[i].from) arguments.push_back(&values[static_cast<std::size_t>(from)]);
    steps[i].evaluate(arguments, values[i]);
  }
}

void SegmentGraph::evaluate_followers(int input, std::vector<StepValue>& values) const {
  std::vector<const StepValue*> arguments;
  for (const int follower : followers[static_cast<std::size_t>(input)]) {
    const auto i = static_cast<std::size_t>(follower);
    arguments.clear();
    for (const int from : steps[i].from) arguments.push_back(&values[static_cast<std::size_t>(from)]);
    steps[i].evaluate(arguments, values[i]);
  }
}

Result<SegmentGraph> build_graph(const SegmentDefinition& definition, const GraphNames& names,
                                 std::span<const GraphOutput> outputs) {
  Builder builder(definition, names);
  std::vector<Made> made;
  for (const auto& output : outputs) {
    auto one = builder.output(output);
    if (!one) return fail_at(output.what, one.error());
    made.push_back(std::move(*one));
  }
  return std::move(builder).graph(made);
}

}  // namespace kinemark::analysis
