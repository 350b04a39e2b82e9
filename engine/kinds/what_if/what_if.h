#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/model/model.h"
#include "engine/report/html/figures.h"
#include "engine/report/html/page.h"
#include "engine/study/study.h"

/// The report section in which a reader changes the sizes of errors and sees the predicted yield.
namespace poesy {

/// Errors whose sizes one slider changes together.
struct SizedErrors {
  std::string name;                ///< name of the errors in the report
  std::vector<WhatIfSize> sizes;   ///< sizes of the errors in the study
  std::vector<std::size_t> slots;  ///< positions of the errors among those that vary (Plan::factors)
  /// Cost of the errors at each of what_if_factors(); empty if the study states no cost.
  std::vector<double> costs = {};
};

/// A study that judges machines by limits, and its yield. Keeps references to study, model and poses.
struct JudgedMachines {
  const Study& study;                ///< the study, with draws per machine and without calibration by measurements
  const Model& model;                ///< the model of its mechanism
  const PoseSet& poses;              ///< poses of the study
  std::vector<SizedErrors> errors;   ///< errors that a reader may change
  std::vector<double> pose_weights;  ///< [poses] weight of each pose; larger if more machines are beyond a limit there
  std::size_t machines;              ///< number of machines of the study
  double yield;                      ///< yield of the study
  double yield_low;                  ///< lower end of the confidence interval of the yield
  double yield_high;                 ///< upper end of the confidence interval of the yield
  double conf_level;                 ///< confidence level of the interval
};

/// The factors by which a slider can multiply sizes of errors, ascending: 0.25, 0.3, ..., 2.
std::span<const double> what_if_factors();

/// The groups of errors that a reader of the report may change: each error of the study is a group, but a feature of
/// the drawing is one group with its errors in all limbs. Errors that the study states as values, and errors that
/// machines draw anew at each pose, are left out.
std::vector<SizedErrors> sized_errors(const Study& study, const PoseSet& poses);

/// Predicted yields at other sizes of errors.
struct YieldPrediction {
  WhatIf figure;        ///< the numbers from which the page predicts yields
  std::string changes;  ///< sentence on the changes that raise the yield most; empty if there is none
};

/// Predicts yields from the first machines of the study, which are solved again, and from derivatives at the mean
/// errors. At most ten groups of errors get a slider: those with the largest effects on the limited responses. The
/// prediction is compared with exact solves of the same machines, with all sizes at their smallest and at their
/// largest. None if a limit is on several poses together, if the responses are not nearly linear, or if the model does
/// not reach the poses.
std::optional<YieldPrediction> what_if(const JudgedMachines& judged, ArrayPool& pool);

/// Adds to the page the section with the predicted yields, if there is a prediction. Returns a sentence on the changes
/// that raise the yield most; empty if there is no prediction or no such change. after: id of the section that the new
/// one follows.
std::string add_what_if(const JudgedMachines& judged, std::string_view after, Page& page);

}  // namespace poesy
