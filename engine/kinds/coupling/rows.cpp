#include "engine/kinds/coupling/rows.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "engine/base/contract.h"
#include "engine/run/evaluation.h"

namespace poesy {
namespace {

using PatternChoice = ErrorPattern::Choice;

bool takes(const ErrorPattern& pattern, const Factor& factor) {
  if (pattern.limbs == PatternChoice::some && factor.limb != pattern.limb) return false;
  if (pattern.components != PatternChoice::some || factor.axis.empty()) return true;
  return std::ranges::find(pattern.axes, factor.axis) != pattern.axes.end();
}

/// What the factors of a block have in common: limb, then frame, dimension and axis.
using BlockPlace = std::tuple<std::size_t, std::size_t, Dimension, std::string>;

BlockPlace place_of(const Factor& factor, const ErrorPattern& pattern) {
  BlockPlace place{};
  if (pattern.limbs == PatternChoice::independent) std::get<0>(place) = factor.limb;
  if (pattern.components != PatternChoice::independent) return place;
  return {std::get<0>(place), factor.frame, factor.dimension, factor.axis};
}

void add_subsets(std::size_t sources, std::size_t wanted, std::vector<std::size_t>& chosen,
                 std::vector<std::vector<std::size_t>>& subsets) {
  if (chosen.size() == wanted) {
    subsets.push_back(chosen);
    return;
  }
  for (std::size_t next = chosen.empty() ? 0 : chosen.back() + 1; next < sources; ++next) {
    chosen.push_back(next);
    add_subsets(sources, wanted, chosen, subsets);
    chosen.pop_back();
  }
}

void add_errors(const ErrorBlock& more, ErrorBlock& errors) {
  errors.insert(errors.end(), more.begin(), more.end());
  std::ranges::sort(errors);
}

}  // namespace

std::vector<ErrorBlock> error_blocks(const ErrorSource& source, const ErrorPattern& pattern,
                                     const ModelDescription& model) {
  std::map<BlockPlace, ErrorBlock> by_place;
  for (const FactorIndex index : source.factors) {
    const Factor& factor = model.factors[index.value];
    if (!takes(pattern, factor)) continue;
    by_place[place_of(factor, pattern)].push_back(index);
  }
  std::vector<ErrorBlock> blocks;
  for (auto& [place, block] : by_place) {
    std::ranges::sort(block);
    blocks.push_back(std::move(block));
  }
  return blocks;
}

std::vector<std::vector<std::size_t>> source_subsets(std::size_t sources) {
  std::vector<std::vector<std::size_t>> subsets;
  std::vector<std::size_t> chosen;
  for (std::size_t wanted = 1; wanted <= sources; ++wanted) add_subsets(sources, wanted, chosen, subsets);
  return subsets;
}

CouplingRows coupling_rows(const CouplingStudy& study, const ModelDescription& model) {
  CouplingRows rows;
  rows.subsets = source_subsets(study.sources.size());
  rows.errors.resize(rows.subsets.size());
  for (std::size_t s = 0; s < study.sources.size(); ++s) {
    const std::vector<ErrorBlock> blocks = error_blocks(study.sources[s], study.pattern, model);
    for (std::size_t k = 0; k < rows.subsets.size(); ++k) {
      if (std::ranges::find(rows.subsets[k], s) == rows.subsets[k].end()) continue;
      for (const ErrorBlock& block : blocks) add_errors(block, rows.errors[k]);
    }
    std::vector<std::size_t>& own = rows.block_rows.emplace_back();
    if (blocks.size() == 1) own.push_back(s);  // subset s is this source alone
    for (const ErrorBlock& block : blocks) {
      if (blocks.size() == 1) break;
      own.push_back(rows.errors.size());
      rows.errors.push_back(block);
    }
  }
  return rows;
}

std::vector<FactorIndex> coupling_factors(const CouplingStudy& study, const ModelDescription& model) {
  std::vector<FactorIndex> factors;
  for (const ErrorSource& source : study.sources) {
    for (const ErrorBlock& block : error_blocks(source, study.pattern, model)) add_errors(block, factors);
  }
  return factors;
}

ErrorTable coupling_table(const CouplingStudy& study, const ModelDescription& model) {
  const CouplingRows rows = coupling_rows(study, model);
  ErrorTable table{coupling_factors(study, model), {}, study.sizes() * rows.errors.size()};
  table.values.reserve(table.rows * table.factors.size());
  for (std::size_t z = 0; z < study.sizes(); ++z) {
    for (const ErrorBlock& errors : rows.errors) {
      for (const FactorIndex factor : table.factors) {
        const bool is_length = model.factors[factor.value].dimension == Dimension::length;
        const std::vector<double>& sizes = is_length ? study.linear : study.angular;
        const bool is_set = std::ranges::binary_search(errors, factor);
        POESY_EXPECTS(!is_set || z < sizes.size());
        table.values.push_back(is_set ? sizes[z] : 0.0);
      }
    }
  }
  return table;
}

}  // namespace poesy
