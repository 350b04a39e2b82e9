#include "tests/comparison/pairs.h"

#include "engine/random/distribution.h"
#include "engine/random/stream.h"

namespace poesy::comparison {
namespace {

constexpr double kMillimetre = 1e-3;
constexpr double kDegree = 3.14159265358979323846 / 180.0;

double unit_of(const Model& model, FactorIndex factor) {
  return model.description().factors[factor.value].dimension == Dimension::length ? kMillimetre : kDegree;
}

}  // namespace

std::vector<double> Group::errors_of(std::size_t sample) const {
  std::vector<double> all = errors;
  for (std::size_t v = 0; v < varied.size(); ++v) all[varied[v].value] = values[v * kGroup + sample];
  return all;
}

PairSource::PairSource(const Model& model, std::uint64_t seed)
    : model_(&model),
      seed_(seed),
      deforming_(model.description().find_set("deforming")->factors),
      all_(model.description().find_set("all")->factors),
      background_(all_.size(), 0.0) {
  for (const FactorIndex factor : model.description().find_set("benign")->factors) {
    background_[factor.value] = unit_of(model, factor);
  }
}

Group PairSource::group(std::size_t number) const {
  Group group{Kind::combined, pose(number), std::vector<double>(all_.size(), 0.0), all_, {}, 0.0};
  const std::size_t turn = number % 4;
  if (turn == 3) {
    fill(group, number, 0.5);
    return group;
  }
  const FactorIndex factor = deforming_[(number / 4 * 3 + turn) % deforming_.size()];
  group.kind = Kind::single;
  group.errors = background_;
  group.varied = {factor};
  group.range = 4.0 * unit_of(*model_, factor);
  fill(group, number, 1.0);
  return group;
}

std::array<double, 3> PairSource::pose(std::size_t number) const {
  std::array<double, 3> draws;
  for (std::uint64_t first = 0;; first += 3) {
    fill_uniforms({seed_, Purpose::sampling_design, FactorIndex(0), PoseIndex(number)}, SampleIndex(first), draws);
    const std::array<double, 3> pose{-0.30 + 0.12 * draws[0], 1.2 * draws[1] - 0.6, 2.0 * draws[2] - 1.0};
    if (!model_->unreachable(pose)) return pose;
  }
}

void PairSource::fill(Group& group, std::size_t number, double size) const {
  group.values.resize(group.varied.size() * kGroup);
  for (std::size_t v = 0; v < group.varied.size(); ++v) {
    const std::span draws = std::span(group.values).subspan(v * kGroup, kGroup);
    fill_uniforms({seed_, Purpose::error_samples, group.varied[v], PoseIndex(number)}, SampleIndex(0), draws);
    Distribution::normal(size * unit_of(*model_, group.varied[v])).transform(draws);
  }
}

}  // namespace poesy::comparison
