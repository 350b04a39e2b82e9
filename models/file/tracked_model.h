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

/// What every mechanism of a file can say before anything is solved: where its poses and charts lead, how it moves, how
/// large its errors may be.
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
  /// The shortest link of the error's limb, the mechanism's reach where it has none, or half a turn.
  ErrorBound error_bound(FactorIndex factor) const override;

 protected:
  /// The description has everything but responses and what follows from them.
  TrackedModel(const MechanismFile& file, Checked found);

  /// Sets them, with those that summaries show. deforms: whether the gap is one of these, where there is one.
  void set_responses(std::vector<Response> responses, bool deforms = true);

  /// For those that solve it.
  /// @{
  const Mechanism& mechanism() const { return mechanism_; }
  const std::shared_ptr<const Tracker>& tracker() const { return tracker_; }
  /// @}
  /// To complete it.
  ModelDescription& described() { return description_; }

 private:
  Mechanism mechanism_;
  double mismatch_;  ///< m: of perfect limbs, at the most
  std::shared_ptr<const Tracker> tracker_;
  std::vector<Chart> charts_;
  ModelDescription description_;
};

/// A limb as solvers have it. drives: of each joint that moves, as chain::Joint has it; those of the limb are taken
/// off.
chain::Limb chain_limb(const Limb& limb, bool errors_at_joints, std::span<const std::size_t>& drives);

/// Of each joint that moves, the number of its drive where that moves others too, else 0.
std::vector<std::size_t> shared_drives(const Mechanism& mechanism);

/// A displacement for each joint and fixed frame, from those of the joints that move.
std::vector<double> with_fixed(const Mechanism& mechanism, std::span<const double> moving);

}  // namespace poesy::file
