#include "engine/report/method.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <vector>

#include "engine/model/calibrated.h"
#include "engine/report/display.h"
#include "engine/report/drawn_errors.h"
#include "engine/report/html/parts.h"
#include "engine/report/solves.h"
#include "engine/report/sources.h"
#include "engine/report/tables.h"
#include "engine/schema/settings.h"
#include "engine/storage/version.h"
#include "engine/study/limit_keys.h"

namespace poesy {
namespace {

std::string setting(const StoredResult& result, std::string_view section, std::string_view key) {
  return readable_setting(result.study_text, section, key);
}

/// The sentence on a changed geometry: "The geometry differs from that of the mechanism's file: a = 150 mm (there 200
/// mm)."
std::string geometry_sentence(const Study* study) {
  if (study == nullptr) return {};
  const std::vector<GeometryParameter>& known = study->model().geometry;
  std::vector<std::string> changes;
  for (std::size_t g = 0; g < known.size(); ++g) {
    const std::string value = readable_text({study->mechanism.geometry[g], known[g].dimension});
    const std::string usual = readable_text({known[g].published, known[g].dimension});
    if (value != usual) changes.push_back(fmt::format("{} = {} (there {})", known[g].name, value, usual));
  }
  if (changes.empty()) return {};
  return fmt::format("The geometry differs from that of the mechanism{}: {}.",
                     study->mechanism.file ? "'s file" : " as published", fmt::join(changes, ", "));
}

/// The sentence on the fidelity: "The equations of the mechanism were solved to first order in the errors."
std::string fidelity_sentence(const StoredResult& result) {
  const std::string fidelity = setting(result, "mechanism", "fidelity");
  if (fidelity.empty()) return {};
  const std::string_view how = fidelity == "exact"         ? "exactly"
                               : fidelity == "first-order" ? "to first order in the errors"
                                                           : "both exactly and to first order in the errors";
  return fmt::format("The equations of the mechanism were solved {}.", how);
}

std::string metric_sentence(const StoredResult& result) {
  return result.metric.empty()
             ? std::string("No metric weighs angles against lengths, because the mechanism needs none.")
             : "Mismatch is weighed by the metric " + metric_text(result) + ".";
}

std::string errors_sentence(const StoredResult& result, const StudyWords& words) {
  if (result.factors.empty() || words.fitted) return {};
  std::string text = counted(result.factors.size(), "geometric error was", "geometric errors were");
  if (!words.draws) return fmt::format("{} given values.", text);
  const std::vector<std::string> sizes = drawn_sizes(result, words);
  return fmt::format("{} drawn{}.", text, sizes.empty() ? "" : fmt::format(" ({})", fmt::join(sizes, "; ")));
}

/// The readable values of these keys in all sections whose names begin with `section`, each value once.
std::vector<std::string> settings_of(const StoredResult& result, std::string_view section,
                                     std::initializer_list<std::string_view> keys) {
  std::vector<std::string> values;
  for (const StudySetting& one : study_settings(result.study_text)) {
    if (!one.section.starts_with(section) || std::ranges::find(keys, one.key) == keys.end()) continue;
    std::string value = fmt::format("{} = {}", one.key, readable_setting(one.value));
    if (std::ranges::find(values, value) == values.end()) values.push_back(std::move(value));
  }
  return values;
}

/// Sentences on how the study reads the zones of a drawing and, in an allocation, the tolerances of parts. Empty if
/// errors are given, because the scatter in zones then has no effect.
std::string zones_sentence(const StoredResult& result, const StudyWords& words) {
  if (!words.draws && !words.fitted) return {};
  const std::string zones = setting(result, "errors", "zones");
  const std::vector<std::string> parts = settings_of(result, "analysis.parts", {"sigmas", "cpk"});
  std::string text;
  if (!zones.empty()) text = fmt::format("Features of the drawing scatter in their zones ({}).", zones);
  if (parts.empty()) return text;
  return text + fmt::format("{}Tolerances are multiples of the standard deviation of an error ({}).",
                            text.empty() ? "" : " ", fmt::join(parts, ", "));
}

constexpr std::size_t kMostNamed = 5;  // largest number of errors that a sentence names

/// The sentence on measured errors: "Measured errors: leg_1 (11 parts, mean 0.01 mm)."
std::string measured_sentence(const StoredResult& result) {
  const MeasuredErrors& found = result.measured;
  std::vector<std::string> errors;
  for (std::size_t e = 0; e < found.names.size(); ++e) {
    errors.push_back(fmt::format("{} ({}, mean {})", found.names[e], counted(found.parts[e], "part", "parts"),
                                 response_text(result.factors[found.factors[e]], found.mean[e])));
  }
  return errors.empty() ? std::string() : fmt::format("Measured errors: {}.", some_names(errors, kMostNamed));
}

/// The sentence on the means of errors: "Means that the study states: offset 0.05 mm."
std::string means_sentence(const StoredResult& result, const StudyWords& words) {
  if (words.from_tables && !words.fitted) return {};  // the means of the study have no effect on given errors
  std::vector<std::string> errors;
  for (std::size_t p = 0; p < result.factor_mean.size(); ++p) {
    if (result.factor_mean[p] == 0.0) continue;
    errors.push_back(result.factors[p].name + " " + response_text(result.factors[p], result.factor_mean[p]));
  }
  return errors.empty() ? std::string()
                        : fmt::format("Means that the study states: {}.", some_names(errors, kMostNamed));
}

/// The sentence on correlated errors: "Correlated errors, by their normal scores: [leg_1, leg_2] with [[1, 0.5], [0.5,
/// 1]]."
std::string correlated_sentence(const StoredResult& result, const StudyWords& words) {
  if (!words.draws) return {};
  std::vector<std::string> blocks;
  if (std::string all = setting(result, "errors", "correlated"); !all.empty()) blocks.push_back(std::move(all));
  for (const StudySetting& one : study_settings(result.study_text)) {
    if (!one.section.starts_with("errors.correlated")) continue;
    const std::string value = readable_setting(one.value);
    if (one.key == "factors") blocks.push_back(value);
    if (one.key == "correlation" && !blocks.empty()) blocks.back() += " with " + value;
  }
  return blocks.empty() ? std::string()
                        : fmt::format("Correlated errors, by their normal scores: {}.", fmt::join(blocks, "; "));
}

/// The sentence on background errors: "Background, the same in all machines: 12 errors, linear = 0.1 mm, angular = 0.01
/// deg."
std::string background_sentence(const StoredResult& result, const StudyWords& words) {
  if (words.from_tables && !words.fitted) return {};  // errors that a table does not give are zero
  const std::string factors = study_setting(result.study_text, "analysis.background", "factors");
  if (factors.empty()) return {};
  const bool is_list = factors.starts_with('[');
  const auto named = static_cast<std::size_t>(std::ranges::count(factors, '"')) / 2;
  std::vector<std::string> parts{is_list ? counted(named, "error", "errors") : "errors " + readable_setting(factors)};
  for (std::string& size : settings_of(result, "analysis.background", {"linear", "angular", "relative"})) {
    parts.push_back(std::move(size));
  }
  return fmt::format("Background, the same in all machines: {}.", fmt::join(parts, ", "));
}

/// A clause on how often a machine draws its errors: ", each with one set of errors at all poses, except 4 errors that
/// are drawn anew at each pose (play_x_1, ...)".
std::string draws_of_machines(const StoredResult& result) {
  std::vector<std::string> anew;
  std::size_t drawn = 0;
  for (std::size_t p = 0; p < result.factor_draws.size(); ++p) {
    if (p < result.factor_sigma.size() && !(result.factor_sigma[p] > 0.0)) continue;
    ++drawn;
    if (is_drawn_per_pose(result, p)) anew.push_back(result.factors[p].name);
  }
  if (anew.empty()) return ", each with one set of errors at all poses";
  if (anew.size() == drawn) return ", each with new errors at every pose";
  return fmt::format(", each with one set of errors at all poses, except {} drawn anew at each pose ({})",
                     counted(anew.size(), "error that is", "errors that are"), some_names(anew, kMostNamed));
}

/// The range of each coordinate over the poses: "x -80 mm to 80 mm, rz -10 deg to 10 deg". A coordinate that does not
/// vary has one value.
std::string ranges_text(const StoredResult& result) {
  std::string text;
  for (std::size_t c = 0; c < result.pose_coordinates.size(); ++c) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::size_t m = 0; m < result.poses.size(); ++m) {
      low = std::min(low, result.poses[PoseIndex(m)][c]);
      high = std::max(high, result.poses[PoseIndex(m)][c]);
    }
    const Dimension dimension = dimension_of(result.pose_coordinates[c].unit);
    text +=
        fmt::format("{}{} {}", c == 0 ? "" : ", ", result.pose_coordinates[c].name, readable_text({low, dimension}, 4));
    if (high > low) text += " to " + readable_text({high, dimension}, 4);
  }
  return text;
}

std::string poses_sentence(const StoredResult& result, const StudyWords& words) {
  const std::string choice = words.own_poses ? setting(result, "poses", "select") : std::string();
  std::string text = (words.fitted ? "What the calibration leaves was predicted at " : "The mechanism was solved at ") +
                     counted(result.poses.size(), "pose", "poses");
  if (!choice.empty()) text += fmt::format(" (selected: {}; {})", choice, ranges_text(result));
  const std::string samples = setting(result, "analysis", "samples");
  const bool machines = setting(result, "analysis", "draws") == "per machine";
  if (words.draws && !words.samples.empty()) {
    text += ", for " + words.samples;
  } else if (words.draws && !samples.empty()) {
    text += machines ? fmt::format(", for {} machines{}", samples, draws_of_machines(result))
                     : fmt::format(", with {} samples at each", samples);
  }
  const std::string rejected = words.own_poses ? rejected_text(result) : std::string();
  return text + "." + (rejected.empty() ? "" : " " + as_sentence(rejected));
}

/// A sentence on the errors that a calibration removes before responses are computed, or on the settings of the fit to
/// the measurements of one machine; empty if there is no calibration.
std::string calibration_sentence(const StoredResult& result, const StudyWords& words) {
  constexpr std::string_view kTable = "analysis.calibration";
  if (words.from_tables && !words.fitted) return {};
  if (setting(result, "analysis", "calibrated") == "true") return fmt::format("Responses are {}.", kLeftByCalibration);
  const std::string fit = setting(result, kTable, "fit");
  if (fit.empty()) return {};
  std::vector<std::string> parts{"fitted: " + fit};
  for (const StudySetting& one : study_settings(result.study_text)) {
    const bool is_noise = one.section == "analysis.calibration.noise";
    const bool says = one.section == kTable && (one.key == "measured" || one.key == "frame" || one.key == "prior" ||
                                                (words.fitted && (one.key == "target" || one.key == "sd")));
    if (!is_noise && !says) continue;
    parts.push_back(fmt::format("{}{}: {}", is_noise ? "noise of " : "", one.key, readable_setting(one.value)));
  }
  const std::string settings = fmt::format("{}", fmt::join(parts, "; "));
  return words.fitted ? fmt::format("Settings of the fit: {}.", settings)
                      : fmt::format("Responses are what a calibration of each machine leaves ({}).", settings);
}

std::string solves_sentence(const SolveCounts& solves) {
  const std::string all = counted_samples(solves.total(), solves.by_series());
  if (solves.total() == 0) return {};
  if (solves.not_converged() == 0) return fmt::format("All {} converged.", all);
  return fmt::format("{} of {} {} ({}).", count_text(solves.not_converged()), all, why_unsolved(solves),
                     percent_text(share_not_converged(solves)));
}

/// The verdict on the yield; null if the result has none.
const YieldVerdict* yield_of(const StoredResult& result) {
  return result.verdicts && result.verdicts->yield ? &*result.verdicts->yield : nullptr;
}

std::string limits_sentence(const StoredResult& result) {
  std::string text;
  for (const LimitVerdict& one : result.verdicts ? result.verdicts->limits : std::vector<LimitVerdict>()) {
    const NamedUnit& response = result.responses[one.response];
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", response.name,
                        limit_text(one.limit, [&](double value) { return response_text(response, value); }));
  }
  if (text.empty()) {  // certificates judge all limits together, and sweeps keep no verdicts on single limits
    for (const StudySetting& one : study_settings(result.study_text)) {
      if (one.section != "analysis.limits") continue;
      text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", one.key, readable_setting(one.value));
    }
  }
  text = text.empty() ? "" : "Limits: " + text + ".";
  const YieldVerdict* yield = yield_of(result);
  if (yield == nullptr) return text;
  if (yield->asked > 0.0) text += fmt::format(" The wanted yield is {}.", percent_text(yield->asked));
  return text + fmt::format(" The yield is {}, with a {} interval of {} to {} (Clopper and Pearson).",
                            percent_text(yield->value), percent_text(yield->conf_level), percent_text(yield->ci_low),
                            percent_text(yield->ci_high));
}

std::string repeat_sentence(const StoredResult& result, const StudyWords& words) {
  const std::string seed = seed_text(result, words);
  constexpr std::size_t kHashDigits = 12;  // enough to tell results apart; a line of 85 mm has no room for all 64
  return fmt::format(
      "{}The same study gives the same bits on any number of threads (the SHA-256 of the result begins "
      "with {}).",
      seed.empty() ? "" : fmt::format("Draws are addressed by the seed {} (Philox). ", seed),
      result.content_sha256.substr(0, kHashDigits));
}

/// The text and the sources that the kind of study adds to the method; empty if it adds nothing.
MethodWords method_of(const ReportKind& kind, const StoredResult& result) {
  return kind.method == nullptr ? MethodWords() : kind.method(result);
}

}  // namespace

std::string method_text(const ReportKind& kind, const StoredResult& result, const Study* study) {
  const StudyWords words = kind.words(result);
  std::string text = fmt::format("The study of kind {} of the mechanism {} was made with poesy {} ({}).", result.kind,
                                 result.model, result.poesy_version, result.git_commit);
  for (const std::string& sentence :
       {geometry_sentence(study), errors_sentence(result, words), zones_sentence(result, words),
        means_sentence(result, words), measured_sentence(result), correlated_sentence(result, words),
        background_sentence(result, words), poses_sentence(result, words), fidelity_sentence(result),
        method_of(kind, result).text, calibration_sentence(result, words), metric_sentence(result),
        solves_sentence(kind.tally(result).total()), limits_sentence(result), repeat_sentence(result, words)}) {
    if (!sentence.empty()) text += " " + sentence;
  }
  return text;
}

std::string method_references(const ReportKind& kind, const StoredResult& result) {
  // The year is known only for the version of this program.
  const std::string year =
      result.poesy_version == poesy_version() ? fmt::format("  year = {{{}}},\n", poesy_year()) : "";
  std::string text = fmt::format(
      "@misc{{poesy,\n"
      "  author = {{{{The poesy developers}}}},\n"
      "  title = {{poesy: a parallel Monte Carlo sensitivity engine for precision parallel robots}},\n"
      "{}  note = {{Version {}, commit {}}}\n"
      "}}\n",
      year, result.poesy_version, result.git_commit);
  std::vector<std::string_view> sources = method_of(kind, result).sources;
  if (yield_of(result) != nullptr) sources.push_back(kClopperPearson);
  for (const std::string_view source : sources) text += fmt::format("\n{}", source);
  return text;
}

}  // namespace poesy
