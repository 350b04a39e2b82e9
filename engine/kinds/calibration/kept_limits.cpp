#include "engine/kinds/calibration/kept_limits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "engine/base/nan.h"
#include "engine/random/normal_quantile.h"
#include "engine/random/stream.h"

namespace poesy::calibration {
namespace {

using calibration::Matrix;
using calibration::Vector;

constexpr Eigen::Index kMachines = 1000;

/// Indices in kComponents of the components of the platform's displacement from which a response is computed; empty if
/// the response is not a displacement of the platform.
std::vector<std::size_t> components_of(const ModelDescription& model, std::size_t response) {
  const Response& wanted = model.responses[response];
  std::vector<std::size_t> parts = wanted.components;
  if (parts.empty()) parts.push_back(response);
  std::vector<std::size_t> list;
  for (const std::size_t part : parts) {
    const auto found = std::ranges::find(calibration::kComponents, model.responses[part].name);
    if (found == calibration::kComponents.end()) return {};
    list.push_back(static_cast<std::size_t>(found - calibration::kComponents.begin()));
  }
  return list;
}

/// [rows x machines] Random numbers of the standard normal distribution.
Matrix normal_scores(std::uint64_t seed, Eigen::Index rows) {
  Matrix scores(rows, kMachines);
  std::vector<double> uniforms(static_cast<std::size_t>(kMachines));
  for (Eigen::Index row = 0; row < rows; ++row) {
    fill_uniforms({seed, Purpose::calibration, FactorIndex(static_cast<std::size_t>(row)), PoseIndex(0)},
                  SampleIndex(0), uniforms);
    for (Eigen::Index s = 0; s < kMachines; ++s) {
      scores(row, s) = normal_quantile(1.0, uniforms[static_cast<std::size_t>(s)]);
    }
  }
  return scores;
}

/// A matrix R with R R^T = covariance. The covariance may be singular.
Matrix root_of(const Matrix& covariance) {
  const linalg::EigenDecomposition found = linalg::eigen_decomposition(covariance);
  return found.vectors * found.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace

KeptLimits::KeptLimits(const Study& study, const Model& model, const calibration::Knowledge& known) {
  std::vector<std::string> others;
  for (const ResponseLimit& limit : study.analysis.limits) {
    const std::vector<std::size_t> components = components_of(model.description(), limit.response);
    if (components.empty()) others.push_back(model.description().responses[limit.response].name);
    if (!components.empty()) {
      limits_.push_back({limit.allowed, components, std::vector<std::vector<double>>(std::size_t(kMachines))});
    }
  }
  if (!others.empty()) {
    not_judged_ = fmt::format("limits on {} are not judged, because they are not of the platform's displacement",
                              fmt::join(others, ", "));
  }
  if (limits_.empty()) return;
  const Eigen::Index k = known.theta.size();
  const Matrix deviations = root_of(known.covariance) * normal_scores(study.seed, known.covariance.rows());
  errors_ = known.directions.F * (deviations.topRows(k).colwise() + known.theta);
  phi_ = deviations.bottomRows(known.phi.size()).colwise() + known.phi;
}

Matrix KeptLimits::left_at(calibration::ExactMachine& machine, std::span<const double> pose,
                           std::span<const double> drive_at, const calibration::Corrected& corrected) const {
  if (limits_.empty()) return {};
  return calibration::left_of_machines(machine, pose, drive_at, errors_, phi_, corrected);
}

void KeptLimits::add(const Matrix& left) {
  for (Judged& limit : limits_) {
    for (Eigen::Index s = 0; s < kMachines; ++s) {
      double squares = 0.0;
      for (const std::size_t c : limit.components) squares += std::pow(left(static_cast<Eigen::Index>(c), s), 2);
      const double alone = left(static_cast<Eigen::Index>(limit.components.front()), s);
      limit.values[static_cast<std::size_t>(s)].push_back(limit.components.size() == 1 ? alone : std::sqrt(squares));
    }
  }
}

double KeptLimits::share() const {
  if (limits_.empty() || limits_.front().values.front().empty()) return kNaN;
  std::size_t kept = 0;
  for (std::size_t s = 0; s < static_cast<std::size_t>(kMachines); ++s) {
    kept += std::ranges::all_of(limits_, [&](const Judged& limit) {
      std::vector<double> values = limit.values[s];
      const bool is_solved = std::ranges::none_of(values, [](double value) { return std::isnan(value); });
      return is_solved && limit.allowed.keeps(values, values.size());
    });
  }
  return static_cast<double>(kept) / static_cast<double>(kMachines);
}

}  // namespace poesy::calibration
