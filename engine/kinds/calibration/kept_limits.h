#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/calibration/left.h"
#include "engine/model/model.h"
#include "engine/study/study.h"

namespace poesy {

/// How likely a machine keeps the limits of its study after its calibration: the share of 1000 machines, drawn from
/// what is known of it and solved exactly, that keep all of them.
class KeptLimits {
 public:
  /// Arguments must outlive it.
  KeptLimits(const Study& study, const Model& model, const calibration::Knowledge& known);

  /// Solves the machines at a pose.
  void add(calibration::ExactMachine& machine, std::span<const double> pose, std::span<const double> drive_at,
           const calibration::Corrected& corrected);

  /// The share of the machines that keep all limits that can be judged; NaN if there are none.
  double share() const;
  /// A sentence that names limits that cannot be judged, because they are not of the platform's displacement; empty if
  /// there are none.
  std::string not_judged() const { return not_judged_; }

 private:
  /// A limit with the components of which its response is formed.
  struct Judged {
    ValueLimit allowed;
    std::vector<std::size_t> components;           ///< one, or those of a norm
    std::vector<std::vector<double>> values = {};  ///< [machines] at the poses
  };

  std::vector<Judged> limits_;
  calibration::Matrix errors_;  ///< [F x machines]
  calibration::Matrix phi_;     ///< [places x machines]
  std::string not_judged_;
};

}  // namespace poesy
