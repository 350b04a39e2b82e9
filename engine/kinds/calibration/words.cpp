#include "engine/kinds/calibration/words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "engine/base/nan.h"
#include "engine/calibration/inference.h"
#include "engine/report/display.h"

namespace poesy::calibration {
namespace {

// If the p-value is smaller than this, the measurements contradict the fitted errors.
constexpr double kContradiction = 0.01;
// If the p-value is larger than this, the measurements contradict the stated noise.
constexpr double kTooQuiet = 0.9999;
// Two estimates are reported as correlated if the magnitude of their correlation is at least this.
constexpr double kTogether = 0.95;
constexpr std::size_t kAngles = 3;  // number of components of a displacement that are angles; they come first

/// Returns true if a chi-square test can judge the fit: it converged, the noise is known and not estimated, and degrees
/// of freedom are left.
bool has_test(const Result& found) {
  return found.converged != 0 && found.noise_is_known != 0 && found.sd_is_estimated == 0 && found.dof > 0;
}

/// Returns true if the residuals are far smaller than expected from the stated noise. With a prior, the test also
/// counts the estimates, which are expected to be of the size of their tolerances.
bool is_noise_too_large(const Result& found) { return has_test(found) && found.p > kTooQuiet; }

std::string some(const Result& found, const std::vector<std::size_t>& numbers) {
  std::vector<std::string> names;
  for (const std::size_t n : numbers) names.push_back(found.fitted[n].name);
  return some_names(names, 18);
}

/// Clauses on the combinations of fitted errors that the measurement cannot determine.
std::vector<std::string> unseen_notes(const Result& found) {
  const auto k = static_cast<Eigen::Index>(found.fitted.size());
  calibration::Matrix projector(k, k);
  for (Eigen::Index i = 0; i < k; ++i) {
    for (Eigen::Index j = 0; j < k; ++j) projector(i, j) = found.null_projector(std::size_t(i), std::size_t(j));
  }
  std::vector<std::string> notes;
  for (const calibration::Confounded& part : calibration::confounded(projector)) {
    const std::string names = some(found, part.numbers);
    if (part.numbers.size() == 1) {
      notes.push_back(names + " changes nothing that was measured" + (found.frame.empty() ? "" : ", beyond the frame"));
    } else if (!found.frame.empty()) {
      notes.push_back(fmt::format("{}: no measurement tells them apart and from the unknown frame ({})", names,
                                  counted(part.directions, "direction", "directions")));
    } else {
      notes.push_back(fmt::format("{}: no measurement tells them apart ({})", names,
                                  counted(part.directions, "direction", "directions")));
    }
  }
  if (!notes.empty() && found.has_prior != 0) notes.push_back("only the tolerances decide there");
  return notes;
}

/// Clauses on groups of fitted errors whose estimates are correlated.
std::vector<std::string> together_notes(const Result& found) {
  std::vector<std::string> notes;
  std::vector<bool> listed(found.fitted.size(), false);
  for (std::size_t first = 0; first < found.fitted.size(); ++first) {
    if (listed[first]) continue;
    std::vector<std::size_t> part{first};
    double least = 1.0;
    double most = 0.0;
    for (std::size_t n = 0; n < part.size(); ++n) {
      for (std::size_t j = first + 1; j < found.fitted.size(); ++j) {
        const double size = std::abs(found.correlation(part[n], j));
        if (listed[j] || std::ranges::find(part, j) != part.end() || !(size >= kTogether)) continue;
        part.push_back(j);
        listed[j] = true;
      }
    }
    if (part.size() < 2) continue;
    std::ranges::sort(part);
    for (std::size_t a = 0; a < part.size(); ++a) {
      for (std::size_t b = a + 1; b < part.size(); ++b) {
        const double size = std::abs(found.correlation(part[a], part[b]));
        least = std::min(least, size);
        most = std::max(most, size);
      }
    }
    notes.push_back(
        fmt::format("{} move together (correlations {:.3f} to {:.3f}); sums and differences of them are known "
                    "better than each",
                    some(found, part), least, most));
  }
  return notes;
}

/// A clause on the number of combinations of fitted errors with effects below the noise; empty if there are none.
std::string below_noise_text(const Result& found) {
  if (found.noise_is_known == 0 || found.below_noise == 0) return {};
  const bool one = found.below_noise == 1;
  return fmt::format("{} of {} directions {} below the noise: the tolerances say more about {}", found.below_noise,
                     found.fitted.size(), one ? "is" : "are", one ? "it" : "them");
}

/// A clause on the errors with a tolerance that are not fitted. Precondition: there are some.
std::string unfitted_text(const Result& found) {
  const std::string text =
      fmt::format("{} more {} a tolerance and {} not fitted", found.unfitted,
                  found.unfitted == 1 ? "error has" : "errors have", found.unfitted == 1 ? "is" : "are");
  if (found.noise_is_known == 0) return text;
  return text +
         ": a good chi-square does not mean that the fitted errors are the true ones, and intervals are too "
         "narrow for them";
}

/// The root mean square over the poses (SI) of a component of the displacement that remains after calibration. The mean
/// square at a pose is left_mean^2 + left_sd^2.
double left_rms(const Result& found, std::size_t component) {
  double sum = 0.0;
  std::size_t poses = 0;
  for (std::size_t m = 0; m < found.left_mean.length<axis::Pose>(); ++m) {
    const double mean = found.left_mean(m, component);
    const double sd = found.left_sd(m, component);
    if (std::isnan(mean)) continue;
    sum += mean * mean + (std::isnan(sd) ? 0.0 : sd * sd);
    ++poses;
  }
  return std::sqrt(sum / static_cast<double>(poses));
}

bool is_measured(const Result& found, const std::string& component) {
  return std::ranges::any_of(found.values, [&](const std::string& value) {
    return value.starts_with("deviation_" + component + " ") || value.starts_with("actual_" + component + " ");
  });
}

/// True if two components of the remaining displacement are equal at all poses, except for rounding.
bool are_same(const Result& found, std::size_t one, std::size_t other) {
  const auto same = [](double a, double b) {
    return std::abs(a - b) <= kLeftRounding || (std::isnan(a) && std::isnan(b));
  };
  for (std::size_t m = 0; m < found.left_mean.length<axis::Pose>(); ++m) {
    if (!same(found.left_mean(m, one), found.left_mean(m, other))) return false;
    if (!same(found.left_sd(m, one), found.left_sd(m, other))) return false;
  }
  return true;
}

}  // namespace

std::vector<std::string> moved_names() { return {calibration::kComponents.begin(), calibration::kComponents.end()}; }

std::string values_text(const Result& found) {
  std::map<std::string, std::size_t> counts;
  for (const std::string& value : found.values) ++counts[value.substr(0, value.find(' '))];
  std::vector<std::string> parts;
  for (const auto& [column, count] : counts) {
    if (column != "distance") parts.push_back(fmt::format("{} {}", count, column));
  }
  if (found.distances > 0) parts.push_back(counted(found.distances, "distance", "distances"));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string measured_text(const Result& found) {
  return fmt::format("{}: {} at {}; {}, {}", found.file, values_text(found),
                     counted(found.measured_poses, "pose", "poses"),
                     counted(found.fitted.size(), "fitted error", "fitted errors"),
                     counted(found.dof, "degree of freedom", "degrees of freedom"));
}

std::string residual_text(const Result& found) {
  if (found.converged == 0) return "the fit did not converge";
  if (found.noise_is_known == 0) return "the noise is 0, so all values count alike and there are no intervals";
  const std::string residual = fmt::format("residual {:.3g} of the noise", found.rms);
  if (found.dof == 0) return residual + "; as many values as fitted numbers, so nothing checks the fit";
  const std::string test =
      fmt::format("{}; chi-square {:.3g} of {} (p = {:.2g})", residual, found.chi_square, found.dof, found.p);
  if (found.sd_is_estimated != 0) return test + ": the noise follows from the residual";
  if (is_noise_too_large(found)) return test + ": less than the stated noise";
  return test + (is_contradicted(found) ? ": the fitted errors do not explain the measurements"
                                        : ": nothing contradicts the fitted errors");
}

std::vector<std::string> unsure_notes(const Result& found) {
  std::vector<std::string> notes;
  if (std::string below = below_noise_text(found); !below.empty()) notes.push_back(std::move(below));
  if (found.unfitted > 0) notes.push_back(unfitted_text(found));
  return notes;
}

bool is_contradicted(const Result& found) { return has_test(found) && found.p < kContradiction; }

std::vector<std::string> estimate_notes(const Result& found) {
  std::vector<std::string> notes = unseen_notes(found);
  for (std::string& note : together_notes(found)) notes.push_back(std::move(note));
  std::string condition = fmt::format("condition {:.4g} (scaled by the tolerances and the noise)", found.condition);
  if (const std::string below = below_noise_text(found); !below.empty()) condition += "; " + below;
  notes.push_back(std::move(condition));
  if (found.unfitted > 0) notes.push_back(unfitted_text(found));
  return notes;
}

std::vector<LeftComponent> left_components(const Result& found) {
  const std::vector<std::string> moved = moved_names();
  std::vector<LeftComponent> list;
  for (std::size_t c = 0; c < moved.size(); ++c) {
    const double rms = left_rms(found, c);
    const bool is_of_tool = c >= 2 * kAngles;
    if (!(rms > kLeftRounding) || (is_of_tool && are_same(found, c, c - kAngles))) continue;
    list.push_back({c, {moved[c], c < kAngles ? "rad" : "m"}, rms});
  }
  return list;
}

std::optional<LeftLength> left_length(const Result& found) {
  bool has_tool = false;
  for (std::size_t c = kAngles; c < 2 * kAngles; ++c) has_tool = has_tool || !are_same(found, c + kAngles, c);
  LeftLength made{{has_tool ? "tip_position" : "position", "m"}, (has_tool ? 2 : 1) * kAngles, 0.0};
  for (std::size_t c = made.first; c < made.first + kAngles; ++c) made.rms = std::hypot(made.rms, left_rms(found, c));
  if (!(made.rms > kLeftRounding)) return std::nullopt;
  return made;
}

std::vector<std::string> left_notes(const Result& found) {
  if (found.converged == 0) return {};
  std::vector<std::string> parts;
  std::vector<std::string> unmeasured;
  const std::size_t poses = found.left_mean.length<axis::Pose>();
  for (const auto& [component, named, rms] : left_components(found)) {
    if (component >= 2 * kAngles) continue;
    parts.push_back(named.name + " " + response_text(named, rms));
    if (!is_measured(found, named.name) && !is_measured(found, "tip_" + named.name)) unmeasured.push_back(named.name);
  }
  if (const std::optional<LeftLength> length = left_length(found)) {
    parts.push_back(length->named.name + " " + response_text(length->named, length->rms));
  }
  if (parts.empty()) return {};
  std::vector<std::string> notes;
  std::string line = fmt::format("left at the {}, predicted: {} (root mean square)", counted(poses, "pose", "poses"),
                                 fmt::join(parts, ", "));
  if (!unmeasured.empty()) {
    line += fmt::format("; {} {} not measured", fmt::join(unmeasured, ", "), unmeasured.size() == 1 ? "was" : "were");
  }
  if (found.left_in_device_frame != 0) line += "; as the measuring device sees it";
  notes.push_back(std::move(line));
  if (std::string kept = kept_text(found); !kept.empty()) notes.push_back(std::move(kept));
  return notes;
}

std::string kept_text(const Result& found) {
  if (found.converged == 0 || std::isnan(found.kept)) return {};
  return fmt::format("the limits are kept at all poses by {} of the machines that this one may be{}",
                     percent_text(found.kept),
                     is_contradicted(found) ? ", if the fitted errors explained its measurements" : "");
}

std::string typed_text(const Result& found) {
  if (found.converged == 0) return {};
  // The half-width of an estimate's interval divided by its standard deviation. This ratio is the same for all fitted
  // errors.
  double quantile = kNaN;
  for (std::size_t k = 0; k < found.estimate.size() && std::isnan(quantile); ++k) {
    quantile = (found.high(k) - found.estimate(k)) / found.sd(k);
  }
  std::vector<std::string> parts;
  for (std::size_t n = 0; n < found.typed.size(); ++n) {
    const NamedUnit& typed = found.typed[n];
    const Unit& unit = display(typed);
    std::string text = fmt::format("{} {:.4f} -> {:.4f}", typed.name, found.typed_present(n) / unit.si,
                                   found.typed_value(n) / unit.si);
    const double half = quantile * found.typed_sd(n);
    if (!std::isnan(half)) text += fmt::format(" +- {:.4f}", half / unit.si);
    parts.push_back(text + (unit.dimension == Dimension::number ? "" : " " + std::string(unit.name)));
  }
  return parts.empty() ? "" : fmt::format("to type in: {}", fmt::join(parts, ", "));
}

std::vector<std::string> calibration_warnings(const Result& found) {
  std::vector<std::string> list;
  if (found.converged == 0) return {std::string(kNotConverged)};
  if (found.noise_is_known == 0) return list;
  std::vector<std::size_t> outliers;
  for (std::size_t i = 0; i < found.values.size(); ++i) {
    if (found.outlier(i) != 0) outliers.push_back(i);
  }
  std::ranges::stable_sort(outliers, std::ranges::greater(),
                           [&](std::size_t i) { return std::abs(found.standardised(i)); });
  const std::string residual = fmt::format("residual {:.3g} of the noise, p = {:.1g}", found.rms, found.p);
  if (!outliers.empty()) {
    const std::size_t first = outliers.front();
    const std::string others =
        outliers.size() == 1 ? "" : fmt::format(" ({} more may be because of it)", outliers.size() - 1);
    const std::string_view advice =
        outliers.size() == 1 ? "measure it again, or leave it out"
                             : "measure it again, or fit more errors: these may not explain the measurements";
    list.push_back(fmt::format("{}: {} is {:.1f} standard deviations off{}; {}", residual, found.values[first],
                               std::abs(found.standardised(first)), others, advice));
  }
  if (is_noise_too_large(found)) {
    list.push_back(residual +
                   (found.has_prior != 0 ? ": the stated noise or the tolerances are" : ": the stated noise is") +
                   " larger than the scatter of the measurements, so intervals are too wide; are the units right?");
  }
  if (is_contradicted(found) && outliers.empty()) {
    list.push_back(
        found.has_prior != 0
            ? fmt::format("estimates are far outside their tolerances (S = {:.3g} of {}): are these the sigmas?",
                          found.chi_square, found.dof)
            : residual + ": the fitted errors do not explain the measurements; intervals are too narrow");
  }
  return list;
}

}  // namespace poesy::calibration
