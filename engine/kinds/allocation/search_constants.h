#pragma once

#include <cstddef>

/// The constants of the search for tolerances, with reasons to change them in the source. A study cannot set them.
/// theory.md ("From root mean squares to a certificate") describes the method.
namespace poesy::allocation {

/// The tolerances in the first linearisation, as a share of those that follow from [errors] of the study
/// (ToleranceProgramme::usual()). Make the share smaller if the first linearisation is far from the last one, larger if
/// rounding hides the effects of such small errors.
inline constexpr double kLinearSize = 0.01;
/// The trust region of a linearisation: the factor by which a tolerance may grow. Make it smaller for mechanisms in
/// which the effect of an error changes much if its tolerance grows by this factor.
inline constexpr double kMaxGrowth = 4.0;
/// The largest number of linearisations before machines are tried. Make it larger if costs still change by then.
inline constexpr std::size_t kMaxLinearisations = 6;
/// Linearisations are repeated until the cost changes by less than this share of the cost. A smaller share is useless,
/// because later stages change the cost by a few per cent.
inline constexpr double kCostTolerance = 1e-3;

/// The largest number of trials of machines in one loop. Make it larger if loops end before the deciding load is near
/// 1. The load of a machine is its largest ratio of a response to its limit (MachineLoads). The deciding load is the
/// largest load after those of the rejects that the design may have (deciding_load()).
inline constexpr std::size_t kMaxTrials = 12;
/// How far the deciding load may be below 1. Loads are nearly proportional to tolerances, so a smaller value only helps
/// if costs must be compared more finely.
inline constexpr double kLoadTolerance = 2e-3;
/// How far the deciding load may be below 1 after the last scaling, which no improvement follows. Make it smaller if
/// the loads of machines near the limit are closer together than this.
inline constexpr double kFinalLoadTolerance = 1e-5;
/// Machines with loads below this share of the deciding load are screened out: they are not tried again, because small
/// changes of tolerances do not make them decide. Make it smaller if the last scaling finds rejects among these
/// machines (decision D66).
inline constexpr double kScreeningLoad = 0.75;
/// The number of all machines divided by the number in a pilot, which is a trial of only a part of the machines. Make
/// it smaller if the deciding load of the pilot (deciding_load()) is too noisy to approach the yield.
inline constexpr std::size_t kPilotOf = 8;
/// The smallest number of machines in a pilot that looks for rejects among machines that were screened out.
inline constexpr std::size_t kMinPilot = 20'000;
/// After a relative change of a tolerance by more than this, effects are measured again or all machines are tried
/// again. The trials of a pilot end when the deciding load differs from 1 by less than this. Make it smaller for
/// mechanisms in which the effect of an error changes much with such a change of its tolerance.
inline constexpr double kRelinearise = 0.1;
/// To keep the yield, the search reduces the share of each limit that root mean squares may use. If the share falls
/// below this number times its value before machines were tried, root mean squares do not show which parts cause
/// rejects. Then the search tightens the parts whose errors are larger in rejected machines. Make the number larger if
/// this starts too late.
inline constexpr double kBlindShare = 0.7;

/// The largest number of machines from which the gradient of the yield is estimated, unless the design may have more
/// rejects than this. With more machines the gradient is less noisy, but it is biased, because the machines are farther
/// from the limit.
inline constexpr std::size_t kMaxGradientMachines = 3000;
/// The score of a part (PartScores) is significant if it is larger than this number times its standard deviation.
inline constexpr double kSignificance = 3.0;
/// The largest number of steps along the gradient. More steps would fit the noise of the machines (decision D66).
inline constexpr std::size_t kMaxGradientSteps = 3;
/// One step along the gradient solves at most this many optimisation problems, each with a rescaled limit, to find
/// tolerances that keep the yield.
inline constexpr std::size_t kMaxFits = 6;
/// The trust region of a step along the gradient: the factor by which a tolerance may grow.
inline constexpr double kGradientGrowth = 1.3;
/// The least share of the cost that a step along the gradient must save. A smaller saving is noise.
inline constexpr double kMinSaving = 1e-4;

/// The factor by which the tolerance of a part is multiplied to predict the yield with a coarser part. Texts of results
/// call such a tolerance "5 % larger".
inline constexpr double kCoarserStep = 1.05;
/// The number of machines near the limit from which the effect of a coarser part is estimated. With more machines, the
/// predicted yield is less noisy.
inline constexpr std::size_t kProbes = 700;
/// The number of machines near the limit for parts of small effect. Each of them also has a mirrored machine.
inline constexpr std::size_t kProbesOfSmall = 3000;
/// A part has a small effect if a change of its tolerance changes the loads of machines (root mean square) by less than
/// this number times the relative change of the tolerance.
inline constexpr double kSmallEffect = 0.01;
/// The factor on the tolerance of a part in the first step of use_remaining_yield(). The factor of each further step is
/// the square of the one before.
inline constexpr double kFirstCoarsening = 1.25;
/// The largest number of steps by which a part gets coarser to use remaining yield.
inline constexpr std::size_t kMaxCoarsenings = 12;
/// The largest number of passes over all parts to use remaining yield.
inline constexpr std::size_t kMaxCoarseningRounds = 3;

}  // namespace poesy::allocation
