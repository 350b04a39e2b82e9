#pragma once

#include <cstddef>

/// The constants of the search for tolerances, and when to change each. They change the results, so no study sets them.
/// theory.md ("From root mean squares to a certificate") describes the method.
namespace poesy::allocation {

/// The size of errors over their usual size at which effects count as linear. Make it smaller where the first
/// linearisation is far from the settled one, larger where responses of that size drown in rounding.
inline constexpr double kLinearSize = 0.01;
/// The trust region of a linearisation: the factor by which tolerances may grow. Make it smaller for mechanisms whose
/// effects change much within a few tolerances.
inline constexpr double kMaxGrowth = 4.0;
/// The largest number of linearisations before machines are tried. Make it larger if costs have not settled by then.
inline constexpr std::size_t kMaxLinearisations = 6;
/// The relative change of the cost below which it has settled. Later stages change it by percents.
inline constexpr double kCostTolerance = 1e-3;

/// The largest number of trials of machines in one loop. Make it larger where loops end before the load is near 1.
inline constexpr std::size_t kMaxTrials = 12;
/// How far the deciding load may be below 1. Tolerances are in proportion to it, so a smaller value pays only if costs
/// are compared more finely.
inline constexpr double kLoadTolerance = 2e-3;
/// The same for the last scaling, after which nothing is improved. Make it smaller where machines near the limit have
/// loads that are nearer to each other.
inline constexpr double kFinalLoadTolerance = 1e-5;
/// The share of the deciding load below which machines are screened out. They are not tried again, because small
/// changes of tolerances do not make them decide. Make it smaller if the last scaling finds rejects among them (D66).
inline constexpr double kScreeningLoad = 0.75;
/// The number of machines over that of a pilot. Make it smaller if the pilot's load is too noisy to approach the yield.
inline constexpr std::size_t kPilotOf = 8;
/// The least number of machines of a pilot that looks for rejects among machines that were screened out.
inline constexpr std::size_t kMinPilot = 20'000;
/// The relative change of tolerances or of the load above which effects are measured again, or all machines are tried
/// again. Make it smaller for mechanisms whose effects change much within a few tolerances.
inline constexpr double kRelinearise = 0.1;
/// The ratio of the allowed share of each limit to the settled one. If the yield needs a smaller one, root mean squares
/// do not show what rejects machines, and the parts that reject them are tightened instead. Make it larger if this
/// starts too late.
inline constexpr double kBlindShare = 0.7;

/// The largest number of machines from which the gradient is estimated. More make it less noisy, but are farther from
/// the limit and so bias the gradient.
inline constexpr std::size_t kMaxGradientMachines = 3000;
/// The number of standard deviations above which a score counts as more than noise.
inline constexpr double kSignificance = 3.0;
/// The largest number of steps along the gradient. More would follow the noise of the machines (D66).
inline constexpr std::size_t kMaxGradientSteps = 3;
/// The largest number of fits of one step to the yield.
inline constexpr std::size_t kMaxFits = 6;
/// The trust region of one step along the gradient, which holds only near its tolerances.
inline constexpr double kGradientGrowth = 1.3;
/// The share of the cost that a step along the gradient must save. A smaller saving is noise.
inline constexpr double kMinSaving = 1e-4;

/// The factor by which a part is made coarser to find its effect. Users read "5 % coarser".
inline constexpr double kCoarserStep = 1.05;
/// The number of machines near the limit that show the effect of a part. More make the yield with a coarser part less
/// noisy.
inline constexpr std::size_t kProbes = 700;
/// The number for parts of small effect, with mirrored machines.
inline constexpr std::size_t kProbesOfSmall = 3000;
/// The change of loads over the step below which a part has a small effect.
inline constexpr double kSmallEffect = 0.01;
/// The first step of a part that uses remaining yield; each further step is the square of the one before.
inline constexpr double kFirstCoarsening = 1.25;
/// The largest number of steps of one such part.
inline constexpr std::size_t kMaxCoarsenings = 12;
/// The largest number of rounds over all parts.
inline constexpr std::size_t kMaxCoarseningRounds = 3;

}  // namespace poesy::allocation
