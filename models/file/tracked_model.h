#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/model.h"
#include "models/file/charts.h"
#include "models/file/rounding.h"

namespace poesy::file {

/// The part of a model that needs no solver: the poses and charts of a mechanism of a file, its mobility, and the
/// bounds of its errors.
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
  /// base_R_platform of perfect limbs at a reachable pose (SI), or at home if the pose is empty.
  virtual lie::Matrix3<double> orientation(std::span<const double> pose) const = 0;
  /// The shortest link of the error's limb, or the mechanism's reach if it has none; for an angle half a turn.
  ErrorBound error_bound(FactorIndex factor) const override;

 protected:
  /// Completes the description except for responses and data derived from them.
  TrackedModel(const MechanismFile& file, Checked found);

  /// Sets the responses and those shown in summaries. deforms: whether these may include the gap.
  void set_responses(std::vector<Response> responses, bool deforms = true);

  /// For derived classes that solve the mechanism.
  /// @{
  const Mechanism& mechanism() const { return mechanism_; }
  const std::shared_ptr<const Tracker>& tracker() const { return tracker_; }
  /// @}
  /// For derived classes that complete the description.
  ModelDescription& described() { return description_; }

 private:
  Mechanism mechanism_;
  double mismatch_;  ///< m: largest mismatch of perfect limbs
  std::shared_ptr<const Tracker> tracker_;
  std::vector<Chart> charts_;
  ModelDescription description_;
};

/// A limb in the form for solvers. drives: Joint::drive of each joint that moves; those of the limb are removed from
/// the front.
chain::Limb chain_limb(const Limb& limb, bool errors_at_joints, std::span<const std::size_t>& drives);

/// For each joint that moves, the number of its drive if the drive moves other joints too, else 0.
std::vector<std::size_t> shared_drives(const Mechanism& mechanism);

/// The displacements of all joints and fixed frames, from those of the joints that move [moving].
std::vector<double> with_fixed(const Mechanism& mechanism, std::span<const double> moving);

}  // namespace poesy::file
