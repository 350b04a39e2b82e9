#pragma once

#include <fmt/format.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/kinds/study_file.h"
#include "engine/kinds/study_run.h"
#include "engine/model/model.h"
#include "engine/run/checkpoints.h"
#include "engine/run/run_options.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"
#include "tests/support/fake_model.h"
#include "tests/support/states.h"

namespace poesy::test {

/// A study of the fake mechanism that takes milliseconds.
struct SmallStudy {
  std::string name;
  Study study;
  std::unique_ptr<Model> model;
  PoseSet poses;
};

namespace detail {

struct SmallAnalysis {
  const char* name;
  const char* keys;                ///< text of [analysis]
  const char* fidelity = "exact";  ///< in [mechanism]
};

inline constexpr SmallAnalysis kSmallAnalyses[] = {
    {"sensitivity", R"(kind = "sensitivity"
samples = 1300)"},
    {"sensitivity_adaptive", R"(kind = "sensitivity"
samples = { min = 500, max = 2300, relative_error = 0.02 })"},
    {"sensitivity_fidelities", R"(kind = "sensitivity"
samples = 1300)",
     "both"},
    {"monte_carlo", R"(kind = "monte-carlo"
draws = "per pose"
samples = 1300
quantiles = [0.1, 0.9])"},
    {"monte_carlo_adaptive", R"(kind = "monte-carlo"
draws = "per pose"
samples = { min = 500, max = 2300, relative_error = 0.02 })"},
    {"machines", R"(kind = "monte-carlo"
draws = "per machine"
samples = 1300
limits = { linear_deformation = "0.4 mm" }
yield = 0.9)"},
    {"machines_adaptive", R"(kind = "monte-carlo"
draws = "per machine"
samples = { min = 500, max = 2300, relative_error = 0.02 })"},
    {"sobol", R"(kind = "sobol"
samples = 1300
second_order = true
shapley = true)"},
    {"sobol_adaptive", R"(kind = "sobol"
samples = { min = 500, max = 2300, relative_error = 0.05 })"},
    {"allocation", R"(kind = "allocation"
samples = 300
limits = { linear_deformation = "0.4 mm" }
yield = 0.9
sigmas = 3
parts = [{ factors = ["delta_1"], cost = { law = "reciprocal", b = 1, unit = "mm" } },
         { factors = ["epsilon_1"], cost = { law = "reciprocal", b = 1, unit = "deg" } }])"},
    {"identification", R"(kind = "identification"
groups = [{ name = "group", linear = "1 mm", angular = "1 deg" }])"},
    {"coupling", R"(kind = "coupling"
sources = [{ name = "L", factors = ["delta_1"] }, { name = "A", factors = ["epsilon_1"] }]
linear = ["0.1 mm", "0.2 mm"]
angular = ["0.1 deg", "0.2 deg"])"},
    {"evaluate", R"(kind = "evaluate"
cases = [{ name = "case", errors = { linear = "1 mm" } }])"},
};

inline constexpr const char* kSmallStudy = R"(format = "poesy-study"
version = 1
[mechanism]
model = "fake"
fidelity = "{}"
[poses]
count = 2
[errors]
linear = {{ distribution = "uniform", half_width = "1 mm" }}
angular = {{ distribution = "uniform", half_width = "1 mrad" }}
[analysis]
{}
)";

inline SmallStudy small_study(const SmallAnalysis& analysis) {
  static const Catalog catalog = [] {
    Catalog fake = fake_catalog();
    fake.front().description.fidelities = {"exact", "first-order"};
    return fake;
  }();
  SmallStudy small;
  small.name = analysis.name;
  const std::string text = fmt::format(kSmallStudy, analysis.fidelity, analysis.keys);
  small.study = study_of_text(text, small.name, catalog, StudyUse::run);
  small.model = build_model(small.study.mechanism);
  small.poses = select_poses(small.study.poses, *small.model).poses;
  return small;
}

}  // namespace detail

/// One study for each way in which studies store states: each kind, adaptive samples, two fidelities and so on. If
/// samples are drawn, the last unit is smaller than the others.
inline std::span<const SmallStudy> small_studies() {
  static const std::vector<SmallStudy> all = [] {
    std::vector<SmallStudy> list;
    for (const auto& analysis : detail::kSmallAnalyses) list.push_back(detail::small_study(analysis));
    return list;
  }();
  return all;
}

/// The states of all stages after each merge of the study's run, from which the run can be resumed.
inline std::vector<std::vector<Bytes>> states_of(const SmallStudy& small) {
  std::vector<std::vector<Bytes>> states;
  Checkpoints checkpoints([] { return true; },
                          [&](std::span<const ByteSource> stages) { states.push_back(bytes_of_each(stages)); });
  run_study(small.study, *small.model, small.poses, {.threads = 1, .checkpoints = &checkpoints});
  checkpoints.save();
  return states;
}

}  // namespace poesy::test
