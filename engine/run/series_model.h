#pragma once

#include <memory>

#include "engine/model/model.h"

namespace poesy {

/// Wraps a model: if one error varies over a known range (SampleBlock::range) and no additional outputs are wanted
/// (OutcomeBlock::details), the evaluator replaces solves by certified series. It solves the model at Chebyshev nodes
/// over the range, and forms a series for each response (engine/docs/decisions/0230-certified-series.md). The
/// certificate is a few further solves, at which the series must give the same responses. A sample that a series gives
/// has the status SolveStatus::by_series and no iterations. The following samples are solved one by one instead:
///
/// - all samples of a pose and error, if a solve at a node or for the certificate does not end with
///   SolveStatus::converged, a series does not converge, or the certificate fails;
/// - samples beyond the range, and samples at which the root of a series would not be precise.
///
/// The outcome of a sample depends only on its pose, the previous pose, its errors and the range.
std::unique_ptr<Model> with_series(std::shared_ptr<const Model> model);

}  // namespace poesy
