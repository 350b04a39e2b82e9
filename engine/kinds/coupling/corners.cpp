#include "engine/kinds/coupling/corners.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy::coupling {
namespace {

/// The largest number of samples that are solved together.
constexpr std::size_t kBlock = 256;

/// The search also tries sums and differences of responses (CornerSearch::directions). No further response is combined
/// once there are this many sums. The three components of a vector have 13: 3 of one component, 6 of two, 4 of three.
constexpr std::size_t kMostSums = 13;

Signs opposite(Signs signs) {
  for (char& sign : signs) sign = sign == '+' ? '-' : '+';
  return signs;
}

Signs flipped(Signs signs, std::size_t block) {
  signs[block] = signs[block] == '+' ? '-' : '+';
  return signs;
}

}  // namespace

CornerTable::CornerTable(const Options& study, const ModelDescription& model)
    : factors(coupling_factors(study, model)) {
  std::vector<std::vector<std::size_t>> of_source;
  for (const ErrorSource& source : study.sources) {
    std::vector<std::size_t>& own = of_source.emplace_back();
    for (const ErrorBlock& errors : error_blocks(source, study.pattern, model)) {
      own.push_back(blocks.size());
      std::vector<std::size_t>& block = blocks.emplace_back();
      for (const FactorIndex error : errors) {
        block.push_back(static_cast<std::size_t>(std::ranges::find(factors, error) - factors.begin()));
      }
    }
  }
  for (const std::vector<std::size_t>& sources : source_subsets(study.sources.size())) {
    std::vector<std::size_t>& subset = subsets.emplace_back();
    for (const std::size_t s : sources) subset.insert(subset.end(), of_source[s].begin(), of_source[s].end());
  }
  for (std::size_t z = 0; z < study.sizes(); ++z) {
    std::vector<double>& size = size_of_error.emplace_back();
    for (const FactorIndex error : factors) size.push_back(study.sizes_of(model.factors[error.value].dimension)[z]);
  }
}

std::vector<double> CornerTable::signs_of_errors(std::size_t subset, const Signs& signs) const {
  std::vector<double> list(factors.size(), 0.0);
  for (std::size_t b = 0; b < signs.size(); ++b) {
    for (const std::size_t error : blocks[subsets[subset][b]]) list[error] = signs[b] == '+' ? 1.0 : -1.0;
  }
  return list;
}

std::size_t CornerSearch::Tried::worst(std::size_t response, double rounding) const {
  std::size_t worst = 0;
  const auto at = [&](std::size_t corner) { return magnitude[corner][response]; };
  for (std::size_t corner = 1; corner < magnitude.size(); ++corner) {
    if (at(corner) > at(worst) + rounding || (std::isnan(at(worst)) && !std::isnan(at(corner)))) worst = corner;
  }
  return worst;
}

CornerSearch::CornerSearch(const Model& model, const SolverOptions& solver, const PoseSet& poses,
                           const CornerTable& table, const Array<double, axis::Response, axis::Size>& rounding)
    : poses_(&poses),
      table_(&table),
      rounding_(&rounding),
      responses_(model.description().responses.size()),
      directions_(directions(model.description())),
      evaluator_(model.evaluator(solver)),
      zeros_(model.description().factors.size(), 0.0),
      at_size_(responses_),
      values_(table.factors.size() * kBlock),
      outcomes_(responses_ * kBlock),
      status_(kBlock),
      counts_(kBlock) {}

CornersAtPose CornerSearch::operator()(std::size_t pose, std::size_t size) {
  for (std::size_t r = 0; r < responses_; ++r) at_size_[r] = (*rounding_)(r, size);
  tried_.assign(table_->subsets.size(), {});
  const BlocksAlone alone = blocks_alone(pose, size);
  for (std::size_t k = 0; k < tried_.size(); ++k) want_first(k, alone);
  CornersAtPose corners;
  while (!wanted_.empty()) {
    solve_wanted(pose, size, corners.solves);
    for (std::size_t k = 0; k < tried_.size(); ++k) want_neighbours(k);
  }
  for (std::size_t k = 0; k < tried_.size(); ++k) corners.subsets.push_back(found(k));
  return corners;
}

std::vector<CornerSearch::Direction> CornerSearch::directions(const ModelDescription& model) {
  std::vector<Direction> list;
  for (std::size_t r = 0; r < model.responses.size(); ++r) list.push_back({{r, 1.0}});
  for (const Dimension dimension : all_dimensions()) {
    std::vector<Direction> sums{{}};
    for (const std::size_t r : model.signed_headline) {
      if (model.responses[r].dimension != dimension || sums.size() > kMostSums) continue;
      const std::size_t before = sums.size();
      for (std::size_t n = 0; n < before; ++n) {
        for (const double weight : {1.0, -1.0}) {
          // A sum that begins with weight -1 is not needed, because the opposite signs are tried for each sum.
          if (weight < 0.0 && sums[n].empty()) continue;
          Direction more = sums[n];
          more.emplace_back(r, weight);
          sums.push_back(std::move(more));
        }
      }
    }
    std::ranges::copy_if(sums, std::back_inserter(list), [](const Direction& sum) { return sum.size() > 1; });
  }
  return list;
}

ArrayView<double, axis::Factor, axis::Sample> CornerSearch::next_samples(std::size_t count) {
  std::ranges::fill(values_, 0.0);
  return {std::span(values_).first(table_->factors.size() * count), {table_->factors.size(), count}};
}

ArrayView<const double, axis::Response, axis::Sample> CornerSearch::solve(std::size_t pose, std::size_t count) {
  evaluator_->evaluate({(*poses_)[PoseIndex(pose)], zeros_, table_->factors,
                        std::span(values_).first(table_->factors.size() * count), count},
                       {std::span(outcomes_).first(responses_ * count),
                        std::span(status_).first(count),
                        std::span(counts_).first(count),
                        {}});
  return {std::span(outcomes_).first(responses_ * count), {responses_, count}};
}

CornerSearch::BlocksAlone CornerSearch::blocks_alone(std::size_t pose, std::size_t size) {
  const std::size_t blocks = table_->blocks.size();
  BlocksAlone alone({blocks, responses_}, kNaN);
  for (std::size_t first = 0; first < blocks; first += kBlock) {
    const std::size_t count = std::min(kBlock, blocks - first);
    const auto values = next_samples(count);
    for (std::size_t b = 0; b < count; ++b) {
      for (const std::size_t error : table_->blocks[first + b]) values(error, b) = table_->size_of_error[size][error];
    }
    const auto outcomes = solve(pose, count);
    for (std::size_t b = 0; b < count; ++b) {
      if (!solved(status_[b])) continue;
      for (std::size_t r = 0; r < responses_; ++r) alone(first + b, r) = outcomes(r, b);
    }
  }
  return alone;
}

void CornerSearch::want(std::size_t subset, Signs signs) {
  Tried& tried = tried_[subset];
  if (!tried.known.emplace(signs, tried.signs.size()).second) return;
  wanted_.push_back({subset, tried.signs.size()});
  tried.signs.push_back(std::move(signs));
}

void CornerSearch::want_first(std::size_t subset, const BlocksAlone& alone) {
  const std::vector<std::size_t>& blocks = table_->subsets[subset];
  want(subset, Signs(blocks.size(), '+'));
  for (const Direction& direction : directions_) {
    Signs signs;
    for (const std::size_t block : blocks) {
      double sum = 0.0;
      for (const auto& [r, weight] : direction) sum += weight * alone(block, r);
      signs += sum < 0.0 ? '-' : '+';
    }
    want(subset, signs);
    want(subset, opposite(std::move(signs)));
  }
}

void CornerSearch::want_neighbours(std::size_t subset) {
  for (std::size_t r = 0; r < responses_; ++r) {
    const Tried& tried = tried_[subset];
    const std::size_t worst = tried.worst(r, at_size_[r]);
    if (tried.magnitude[worst][r] <= at_size_[r]) continue;
    const Signs signs = tried.signs[worst];
    for (std::size_t b = 0; b < signs.size(); ++b) want(subset, flipped(signs, b));
  }
}

void CornerSearch::solve_wanted(std::size_t pose, std::size_t size, SolveCounts& solves) {
  const std::vector<Wanted> all = std::exchange(wanted_, {});
  for (Tried& tried : tried_) tried.magnitude.resize(tried.signs.size(), std::vector<double>(responses_, kNaN));
  for (std::size_t first = 0; first < all.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, all.size() - first);
    const auto values = next_samples(count);
    for (std::size_t n = 0; n < count; ++n) {
      const auto [subset, corner] = all[first + n];
      const Signs& signs = tried_[subset].signs[corner];
      for (std::size_t b = 0; b < signs.size(); ++b) {
        for (const std::size_t error : table_->blocks[table_->subsets[subset][b]]) {
          const double value = table_->size_of_error[size][error];
          values(error, n) = signs[b] == '+' ? value : -value;
        }
      }
    }
    const auto outcomes = solve(pose, count);
    for (std::size_t n = 0; n < count; ++n) {
      solves.add(status_[n], counts_[n]);
      if (!solved(status_[n])) continue;
      const auto [subset, corner] = all[first + n];
      for (std::size_t r = 0; r < responses_; ++r) {
        tried_[subset].magnitude[corner][r] = std::abs(outcomes(r, n));
      }
    }
  }
}

WorstCorners CornerSearch::found(std::size_t subset) const {
  const Tried& tried = tried_[subset];
  WorstCorners corners;
  corners.tried = tried.signs.size();
  for (std::size_t r = 0; r < responses_; ++r) {
    const std::size_t worst = tried.worst(r, at_size_[r]);
    corners.value.push_back(tried.magnitude[worst][r]);
    corners.signs.push_back(std::isnan(corners.value.back()) ? Signs() : tried.signs[worst]);
  }
  for (std::size_t corner = 0; corner < tried.signs.size(); ++corner) {
    if (!std::isnan(tried.magnitude[corner].front())) continue;
    if (corners.unsolved++ == 0) corners.first_unsolved = tried.signs[corner];
  }
  return corners;
}

double expected_corners(const CornerTable& table, std::size_t responses) {
  double sum = 0.0;
  for (const std::vector<std::size_t>& blocks : table.subsets) {
    const auto count = static_cast<double>(blocks.size());
    sum += std::min(std::exp2(count), static_cast<double>(responses) * (count + 2.0) + 1.0);
  }
  return sum;
}

}  // namespace poesy::coupling
