#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/kinds/coupling/options.h"
#include "engine/model/model.h"
#include "engine/run/evaluation.h"
#include "engine/study/error_table.h"
#include "engine/study/study.h"

namespace poesy {

/// Errors that have one size at once, and the others zero; in the order of the model.
using ErrorBlock = std::vector<FactorIndex>;

/// What a pattern makes of a source: the blocks of its errors that move together, by limb, then by frame, dimension
/// and axis. One block, unless limbs or components are independent; then one for each limb, for each component of each
/// of its vectors and scalars, or, where both are, for each error. Empty where the pattern leaves none of its errors.
std::vector<ErrorBlock> error_blocks(const ErrorSource& source, const ErrorPattern& pattern,
                                     const ModelDescription& model);

/// All subsets of n sources but the empty one, by the number of sources, then in the order of the sources: 0, 1, 2, 01,
/// 02, 12, 012.
std::vector<std::vector<std::size_t>> source_subsets(std::size_t sources);

/// The sets of errors that are solved at each size, none of them twice: the subsets, then the blocks of the sources
/// that have more than one.
struct CouplingRows {
  std::vector<std::vector<std::size_t>> subsets;     ///< [K] the sources in each; row k is subset k
  std::vector<std::vector<std::size_t>> block_rows;  ///< [sources] the rows of each source's blocks
  std::vector<ErrorBlock> errors;                    ///< [N] the errors of each row
};

/// Precondition: no factor in two sources.
CouplingRows coupling_rows(const CouplingStudy& study, const ModelDescription& model);

/// The errors that the pattern leaves of all sources, in the order of the model.
std::vector<FactorIndex> coupling_factors(const CouplingStudy& study, const ModelDescription& model);

/// The table to be solved at every pose: row z * N + n has the errors of row n at size z, all positive; its columns are
/// coupling_factors.
ErrorTable coupling_table(const CouplingStudy& study, const ModelDescription& model);

}  // namespace poesy
