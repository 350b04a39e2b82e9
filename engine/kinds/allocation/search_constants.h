#pragma once

#include <cstddef>

/// The constants of the search for tolerances. Each comment says what the constant is and when to change it; theory.md
/// ("From root mean squares to a certificate") has the method. They change what a study finds, so no study sets them.
namespace poesy::allocation {

/// Errors are so many times as large as usual where their effects count as linear. Make it smaller where the first
/// linearisation is far from the settled one, larger where responses drown in rounding.
inline constexpr double kLinearSize = 0.01;
/// Trust region: tolerances grow at most so much from one linearisation to the next. Make it smaller for mechanisms
/// whose effects change much within a few tolerances.
inline constexpr double kMaxGrowth = 4.0;
/// At most so many linearisations before machines are tried. More help where the cost has not settled by then.
inline constexpr std::size_t kMaxLinearisations = 6;
/// The cost has settled when it moves by less than this share. The later stages move it by percents.
inline constexpr double kCostTolerance = 1e-3;

/// At most so many trials of machines in one loop. Each loop ends after two to five of them as a rule.
inline constexpr std::size_t kMaxTrials = 12;
/// The deciding load is near enough to 1 when it is within so much below it. A tolerance follows a load in proportion,
/// so a smaller value pays only where costs must be compared more finely.
inline constexpr double kLoadTolerance = 2e-3;
/// The same for the last scaling, after which nothing is improved. Make it smaller for more than a million machines,
/// whose loads are nearer to each other.
inline constexpr double kFinalLoadTolerance = 1e-5;
/// Screening: machines below this share of the deciding load are not tried again, because they do not come to decide
/// while tolerances change a little. Make it smaller where the last stage finds rejects among them (README.md, D66).
inline constexpr double kScreeningLoad = 0.75;
/// A pilot is one of so many machines.
inline constexpr std::size_t kPilotOf = 8;
/// The pilot that looks for rejects among machines that were screened out has at least so many machines.
inline constexpr std::size_t kMinPilot = 20'000;
/// Effects are measured again, or all machines tried again, where tolerances or the load have moved by this share.
inline constexpr double kRelinearise = 0.1;
/// Where the yield takes limits on root mean squares below this share of the settled ones, a few machines decide that
/// root mean squares do not see, and the parts that reject machines are tightened instead.
inline constexpr double kBlindShare = 0.7;

/// At most so many machines of largest load tell the gradient. More make it less noisy; farther from the limit it is
/// less the gradient of the yield.
inline constexpr std::size_t kMaxGradientMachines = 3000;
/// A score is no noise from so many of its standard deviations on.
inline constexpr double kSignificance = 3.0;
/// At most so many steps along the gradient. More follow the noise of the machines (README.md, D66).
inline constexpr std::size_t kMaxGradientSteps = 3;
/// At most so many fits of one step to the yield.
inline constexpr std::size_t kMaxFits = 6;
/// Trust region of one step along the gradient, which holds near its tolerances only.
inline constexpr double kGradientGrowth = 1.3;
/// A step along the gradient must save this share of the cost. A smaller saving is noise.
inline constexpr double kMinSaving = 1e-4;

/// A part is made so many times as coarse to find what it does. Users see it as "5 % coarser".
inline constexpr double kCoarserStep = 1.05;
/// So many machines near the limit tell what a part does. More make the yield with a coarser part less noisy.
inline constexpr std::size_t kProbes = 700;
/// The same for parts of small effect, with mirrored machines.
inline constexpr std::size_t kProbesOfSmall = 3000;
/// A part has a small effect where its errors change loads by less than so many times the step.
inline constexpr double kSmallEffect = 0.01;
/// The first step of a part that takes up remaining yield; each further step is the square of the one before.
inline constexpr double kFirstCoarsening = 1.25;
/// At most so many steps of one such part.
inline constexpr std::size_t kMaxCoarsenings = 12;
/// At most so many rounds over all parts.
inline constexpr std::size_t kMaxCoarseningRounds = 3;

}  // namespace poesy::allocation
