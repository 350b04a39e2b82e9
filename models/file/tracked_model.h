#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/model.h"
#include "models/file/charts.h"
#include "models/file/pose_tracker.h"
#include "models/file/rounding.h"

namespace poesy::file {

/// The part of a model of a mechanism file that needs no solver: poses and charts, mobility, and bounds of errors.
class TrackedModel : public Model {
 public:
  const ModelDescription& description() const override { return description_; }
  std::optional<std::string> unreachable(std::span<const double> pose) const override;
  std::vector<double> joint_displacements(std::span<const double> pose) const override;
  std::optional<std::vector<double>> pose_from_chart(std::size_t chart,
                                                     std::span<const double> coordinates) const override;
  std::string no_pose_because(std::size_t chart, std::span<const double> coordinates) const override;
  std::vector<std::string> mobility() const override;
  std::vector<std::string> remarks() const override;
  std::vector<std::string> unusual_geometry() const override;
  std::vector<std::string> unusual_errors() const override;
  /// The rotation base_R_platform of perfect limbs at a reachable pose (SI), or at home if the pose is empty.
  virtual lie::Matrix3<double> orientation(std::span<const double> pose) const = 0;
  /// The bound of an error: for a length, the shortest link of the error's limb, or the mechanism's reach if the limb
  /// has no link; for an angle, half a turn; for a number, 1.
  ErrorBound error_bound(FactorIndex factor) const override;

 protected:
  /// Fills in the description, except for responses and the data that follow from them.
  TrackedModel(const MechanismFile& file, Checked found);

  /// Sets the responses, and which of them summaries show. deforms: true if the response `gap` may be among those that
  /// summaries show.
  void set_responses(std::vector<Response> responses, bool deforms = true);

  /// The mechanism and its tracker, for derived classes that solve the mechanism.
  /// @{
  const Mechanism& mechanism() const { return mechanism_; }
  const std::shared_ptr<const PoseTracker>& tracker() const { return tracker_; }
  /// @}
  /// The description, for derived classes that complete it.
  ModelDescription& described() { return description_; }

 private:
  Mechanism mechanism_;
  double mismatch_;  ///< largest mismatch of perfect limbs, m
  std::shared_ptr<const PoseTracker> tracker_;
  std::vector<Chart> charts_;
  ModelDescription description_;
};

/// A limb in the form that solvers need. drives: drive numbers (chain::Joint::drive) of the joints that move, in this
/// limb and the following limbs. The function removes the numbers of this limb from the front.
chain::Limb chain_limb(const Limb& limb, bool errors_at_joints, std::span<const std::size_t>& drives);

/// For each joint that moves, the number of its drive (chain::Joint::drive); 0 if it has no drive, or if the drive
/// moves no other joint.
std::vector<std::size_t> shared_drives(const Mechanism& mechanism);

/// The displacements of all joints and fixed frames; 0 for fixed frames. moving: those of the joints that move (rad,
/// m).
std::vector<double> with_fixed(const Mechanism& mechanism, std::span<const double> moving);

}  // namespace poesy::file
