#pragma once

#include <functional>
#include <optional>

#include "engine/run/result.h"
#include "engine/run/runner.h"
#include "engine/study/study.h"

namespace poesy {

/// Solves every row of a table of errors at every pose of the study. Empty when stopped.
using SolveTable = std::function<std::optional<EvaluationResult>(const ErrorTable&)>;

/// Which errors deform the mechanism at all (Du et al. 2022, Section 5.1), for each group of sizes:
///
/// Single stage: each error alone. It is harmless where the model's measure of deformation is no more than rounding at
/// pose_share of the poses, rounded to whole poses, one at least (657 of 692 at 0.95, as in the paper); else it
/// deforms. A pose that was not solved counts as deformed, for no deformation was shown there to be absent.
///
/// Coupled stage: for each frame of a limb, all of its errors that did not deform alone, together. Where that deforms,
/// two that deform as a pair are a coupling, and the verdict names its angular member, or both where they are of one
/// kind. An error takes part when setting it to zero takes away nine tenths of the deformation at pose_share of the
/// poses; where no pair deforms, all that take part are named.
///
/// Precondition: the model has a measure of deformation.
std::optional<IdentificationResult> identify(const Analysis& analysis, const ModelDescription& model,
                                             const SolveTable& solve);

}  // namespace poesy
