#include "engine/python/solver/request.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "engine/schema/given_key.h"
#include "engine/schema/keys.h"
#include "engine/study/study_file.h"
#include "engine/study/study_kind.h"
#include "models/registry.h"

namespace poesy::python {
namespace {

constexpr std::array<std::string_view, 2> kEvaluatorKeys{"factors", "calibrated"};

/// The only kind of study in this module. Its [analysis] states which errors vary, and whether the actuators correct
/// them. With this kind the module needs neither the registry of kinds nor the code that runs and stores studies.
const StudyKind kEvaluator{.name = "evaluator",
                           .asks = "what given errors do",
                           .keys = kEvaluatorKeys,
                           .varies = Varies::together,
                           .at_pose = [](const Study&) {
                             return AtPose{1.0, "errors", 1.0, "errors"};
                           }};

Study study_of_text(const std::string& text, std::span<const GivenKey> given = {}) {
  static const StudyKinds kinds = study_kinds_of({&kEvaluator}, kEvaluatorKeys);
  return poesy::study_of_text(text, "", registry(), StudyUse::evaluate, kinds, nullptr, given);
}

/// The geometry parameters of the request as keys of a study. usual: a study of the same mechanism without these
/// changes, from which the dimensions of the parameters are taken.
std::vector<GivenKey> geometry_keys(const Request& request, const Study& usual) {
  std::vector<GivenKey> keys;
  for (const auto& [name, value] : request.geometry) {
    const auto* text = std::get_if<std::string>(&value);
    const auto parameter = std::ranges::find(usual.model().geometry, name, &GeometryParameter::name);
    const Dimension dimension = parameter == usual.model().geometry.end()
                                    ? Dimension::length
                                    // An unknown name is refused later, when the study is read.
                                    : parameter->dimension;
    keys.push_back(
        {"mechanism.geometry." + name, text != nullptr ? *text : exact_value(std::get<double>(value), dimension)});
  }
  return keys;
}

std::string header_and_mechanism(const std::string& mechanism) {
  const bool is_path = mechanism.ends_with(".toml") || mechanism.find('/') != std::string::npos;
  const bool is_file = is_path && find(registry(), mechanism) == nullptr;
  return fmt::format("format = \"poesy-study\"\nversion = 1\n[mechanism]\n{} = {}\n", is_file ? "file" : "model",
                     in_quotes(mechanism));
}

std::string factors_text(const Request& request) {
  if (const auto* set = std::get_if<std::string>(&request.factors)) return in_quotes(*set);
  std::vector<std::string> quoted;
  for (const std::string& name : std::get<std::vector<std::string>>(request.factors)) quoted.push_back(in_quotes(name));
  return fmt::format("[\n{}]", fmt::join(quoted, ",\n"));  // on separate lines, because the length of a line is limited
}

}  // namespace

Study study_of(const Request& request) {
  const std::string begin = header_and_mechanism(request.mechanism);
  const Study usual = study_of_text(begin);
  const Request defaults;
  std::string text = begin;
  if (!usual.model().fidelities.empty() || request.fidelity != defaults.fidelity) {
    text += fmt::format("fidelity = {}\n", in_quotes(request.fidelity));
  }
  text += fmt::format("[analysis]\nfactors = {}\ncalibrated = {}\n", factors_text(request), request.calibrated);
  if (!usual.model().metric.empty() || request.metric != defaults.metric) {
    text += fmt::format("[solver]\nmetric = {}\n", in_quotes(request.metric));
  }
  Study study = study_of_text(text, geometry_keys(request, usual));
  if (study.mechanism.compared) {
    throw InputError(
        {}, fmt::format("mechanism.fidelity is {}, but an evaluator solves at one", in_quotes(kBothFidelities)),
        fmt::format("write \"{}\"", fmt::join(study.model().fidelities, "\" or \"")));
  }
  return study;
}

}  // namespace poesy::python
