#include "engine/kinds/what_if/machines.h"

#include <algorithm>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/run/result.h"

namespace poesy {
namespace {

constexpr double kStep = 0.5;  // step of the central differences, in standard deviations of the error

}  // namespace

WhatIfMachines::WhatIfMachines(const Plan& plan, const Model& model, const LimitedVectors& vectors,
                               std::size_t machines)
    : UnitSolver(plan, model, plan.factors().size()),
      vectors_(&vectors),
      machines_(machines),
      deviations_({plan.factors().size(), machines}) {
  POESY_EXPECTS(machines <= Plan::kUnitSamples);
  const WorkUnit unit{0, PoseIndex(0), SampleIndex(0), machines};
  for (std::size_t p = 0; p < plan.factors().size(); ++p) draw_uniforms(unit, p, deviations_.row(p));
  plan.transform(deviations_.all(), machines);
  for (std::size_t p = 0; p < plan.factors().size(); ++p) {
    for (double& error : deviations_.row(p)) error -= plan.distributions()[p].mean();
  }
}

WhatIfMachines::Rows WhatIfMachines::rows_of(PoseIndex pose, std::size_t count) {
  Array<double, axis::DetailComponent, axis::Sample> details({vectors_->details(), count});
  const UnitOutcomes outcomes = UnitSolver::solve(pose, plan_->factors(), count, 0.0, details.all());
  Rows rows({vectors_->rows(), count});
  vectors_->fill(pose, outcomes, details, {rows.all(), rows.lengths()});
  for (std::size_t b = 0; b < count; ++b) {
    if (counts(outcomes.status[b], plan_->not_converged())) continue;
    for (std::size_t k = 0; k < vectors_->rows(); ++k) rows(k, b) = kNaN;
  }
  return rows;
}

WhatIfMachines::Rows WhatIfMachines::solve(PoseIndex pose, std::span<const double> sizes) {
  for (std::size_t p = 0; p < sizes.size(); ++p) {
    const double mean = plan_->distributions()[p].mean();
    std::ranges::transform(deviations_.row(p), values_.begin() + static_cast<std::ptrdiff_t>(p * machines_),
                           [&](double deviation) { return mean + sizes[p] * deviation; });
  }
  if (!plan_->per_pose().empty()) draw_per_pose({0, pose, SampleIndex(0), machines_});
  return rows_of(pose, machines_);
}

WhatIfMachines::Slopes WhatIfMachines::slopes(PoseIndex pose) {
  const std::size_t errors = plan_->factors().size();
  Slopes slopes({vectors_->rows(), errors});
  constexpr std::size_t kMost = Plan::kUnitSamples / 2;
  for (std::size_t first = 0; first < errors; first += kMost) {
    const std::size_t some = std::min(kMost, errors - first);
    const std::span<double> columns = std::span<double>(values_).first(errors * 2 * some);
    const ArrayView<double, axis::Factor, axis::Sample> values(columns, {errors, 2 * some});
    for (std::size_t p = 0; p < errors; ++p) std::ranges::fill(values.row(p), plan_->distributions()[p].mean());
    const auto step = [&](std::size_t n) { return kStep * plan_->distributions()[first + n].standard_deviation(); };
    for (std::size_t n = 0; n < some; ++n) {
      values(first + n, 2 * n) += step(n);
      values(first + n, 2 * n + 1) -= step(n);
    }
    const Rows rows = rows_of(pose, 2 * some);
    for (std::size_t k = 0; k < vectors_->rows(); ++k) {
      for (std::size_t n = 0; n < some; ++n) {
        slopes(k, first + n) = (rows(k, 2 * n) - rows(k, 2 * n + 1)) / (2.0 * step(n));
      }
    }
  }
  return slopes;
}

}  // namespace poesy
