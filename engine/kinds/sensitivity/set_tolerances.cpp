#include "engine/kinds/sensitivity/tolerances.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "engine/base/contract.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/base/units.h"
#include "engine/kinds/confirming_study.h"
#include "engine/kinds/sensitivity/indices.h"
#include "engine/kinds/sensitivity/linearity.h"
#include "engine/kinds/sensitivity/ranking.h"
#include "engine/kinds/study_file.h"
#include "engine/report/table.h"
#include "engine/result/csv_table.h"
#include "engine/storage/file_writer.h"
#include "engine/study/study.h"

namespace poesy::sensitivity {
namespace {

constexpr const char* kStem = "confirm";
constexpr const char* kEqualEffect = "confirm_equal_effect";
constexpr const char* kEqualTolerance = "confirm_equal_tolerance";
/// The largest tolerance, as a share of the dimension of the mechanism that the error changes. At a quarter, four
/// standard deviations of a normal error equal the dimension.
constexpr double kShareOfPart = 0.25;

/// The Monte Carlo study of the same errors at the same poses as a sensitivity result.
Study monte_carlo_study(const StoredResult& result, const Catalog& catalog) {
  // The poses of the result are used, because the path of a pose file is relative to a study that may no longer exist.
  Study study = stored_study(result, "the result", catalog).study;
  if (study.analysis.factors.size() != result.factors.size()) {
    throw FileError("the result", "keeps a study that does not fit its factors", "run the study again");
  }
  return as_confirming_study(std::move(study), kStem);
}

/// For each error of the study, a quarter of the dimension of the mechanism that the error changes.
std::vector<double> quarters_of_parts(const Study& study) {
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  std::vector<double> largest;
  for (const FactorIndex factor : study.analysis.factors) {
    largest.push_back(kShareOfPart * model->error_bound(factor).size);
  }
  return largest;
}

/// Sets the errors of a study to normal errors with these tolerances [errors] as standard deviations, SI. A tolerance
/// above `largest` is cut to it, and a text on its error is added to `at_largest`.
void set_tolerances(Study& study, std::span<const double> largest, std::span<const double> tolerances,
                    std::vector<std::string>& at_largest) {
  for (std::size_t p = 0; p < tolerances.size(); ++p) {
    const FactorIndex factor = study.analysis.factors[p];
    study.errors.by_factor[factor.value] = Distribution::normal(std::min(tolerances[p], largest[p]));
    if (tolerances[p] < largest[p]) continue;
    const Factor& named = study.model().factors[factor.value];
    const std::string text = named.name + " is " + readable_text({largest[p], named.dimension});
    if (std::ranges::find(at_largest, text) == at_largest.end()) at_largest.push_back(text);
  }
}

/// The position of the response or error that a command-line option names. Throws InputError if there is none.
std::size_t position(const std::vector<NamedUnit>& things, const std::string& name, std::string_view option,
                     std::string_view what) {
  const auto at = std::ranges::find(things, name, &NamedUnit::name);
  if (at != things.end()) return static_cast<std::size_t>(at - things.begin());
  throw InputError({}, fmt::format("{}: this result has no {} '{}'", option, what, printable(name)),
                   suggestion(name, names(things)));
}

/// The positive quantity (SI) that a command-line option states. owner: the response or error whose dimension the
/// quantity must have. Throws InputError if the text does not state a positive quantity of this dimension.
double positive(const std::string& text, std::string_view option, const NamedUnit& owner) {
  const Dimension dimension = dimension_of(owner.unit);
  const std::string example = fmt::format("{} is measured in {}", owner.name, display_unit(dimension).name);
  Quantity quantity;
  if (const auto number = parse_number(text); number && dimension == Dimension::number) {
    quantity.si = *number;
  } else {
    try {
      quantity = parse_quantity(text);
    } catch (const QuantityError& error) {
      throw InputError({}, fmt::format("{}: {}", option, printable(error.what(), 200)), example);
    }
  }
  if (quantity.dimension != dimension) {
    throw InputError(
        {}, fmt::format("{}: '{}' has another dimension than {}", option, printable(text), name(dimension)), example);
  }
  if (!(quantity.si > 0.0)) {
    throw InputError({}, fmt::format("{}: '{}' is not above zero", option, printable(text)), "write a positive one");
  }
  return quantity.si;
}

/// The position of the response for which tolerances are set.
std::size_t chosen_response(const TolerancesOptions& options, const StoredResult& result) {
  if (!options.response.empty()) return position(result.responses, options.response, "--response", "response");
  std::vector<std::string> known;
  for (const NamedUnit& response : result.responses) {
    const std::string_view unit = display(response).name;
    known.push_back(unit == "1" ? response.name : fmt::format("{} ({})", response.name, unit));
  }
  throw InputError({options.result}, fmt::format("has tolerances for {}", fmt::join(known, ", ")),
                   "choose one with --response NAME");
}

std::optional<ReferenceError> reference_of(const TolerancesOptions& options, const StoredResult& result,
                                           std::size_t response) {
  if (!options.reference) return sensitivity_of(result).reference(response);
  const std::size_t equals = options.reference->find('=');
  const std::size_t factor = position(result.factors, options.reference->substr(0, equals), "--reference", "error");
  const NamedUnit& named = result.factors[factor];
  if (equals == std::string::npos) return ReferenceError{factor, display(named).si};
  return ReferenceError{factor, positive(options.reference->substr(equals + 1), "--reference", named)};
}

void check_sizes(const TolerancesOptions& options, const StoredResult& result, std::size_t response) {
  for (std::size_t p = 0; p < result.factors.size(); ++p) {
    const double index = sensitivity_of(result).global(response, p);
    if (!is_too_small_to_tell(index, index_rounding(result, response, p))) continue;
    throw InputError(
        {options.result},
        fmt::format("the error '{}' is so small in this study that its effect on {} cannot be told from the "
                    "rounding of the solves",
                    result.factors[p].name, result.responses[response].name),
        "study larger errors");
  }
}

void check_reference(const TolerancesOptions& options, const StoredResult& result, const ResponseStudy& response,
                     const std::string& name, const std::optional<ReferenceError>& reference) {
  if (!reference) {
    throw InputError({}, fmt::format("--response: no error of this result has an effect on {}", name),
                     "there is nothing to set tolerances by; name another response");
  }
  if (has_effect(response.index[reference->factor])) return;
  const std::string_view source = options.reference ? "--reference" : "the study's [analysis] reference";
  const std::string& factor = result.factors[reference->factor].name;
  if (std::isnan(response.index[reference->factor])) {
    throw InputError({options.result}, fmt::format("{}: the effect of '{}' on {} is not known", source, factor, name),
                     "name another with --reference");
  }
  throw InputError(
      {options.result},
      fmt::format("{}: '{}' has no effect on {} (index 0), so nothing can be counted from it", source, factor, name),
      "name another with --reference");
}

void check_prediction(const StoredResult& result, const MeanSquare& response, const std::string& name) {
  if (std::isnan(response.background)) {
    throw InputError(
        {}, fmt::format("--limit: {} with the background alone is not known, for a pose was not solved", name),
        "where the background cannot be assembled, lower it; else raise [solver] max_iterations; or leave out "
        "--limit");
  }
  for (std::size_t p = 0; p < response.effects.size(); ++p) {
    if (!std::isnan(response.effects[p])) continue;
    throw InputError({},
                     fmt::format("--limit: the effect of '{}' on {} is not known at a pose where too few samples count",
                                 result.factors[p].name, name),
                     "run the study with more samples, or leave out --limit");
  }
}

/// The limit on the response that --limit states, SI. Throws InputError if the background alone exceeds it.
double checked_limit(const TolerancesOptions& options, const StoredResult& result, const MeanSquare& response,
                     const NamedUnit& named) {
  const double limit = positive(*options.limit, "--limit", named);
  check_prediction(result, response, named.name);
  if (limit * limit > response.background) return limit;
  throw InputError(
      {},
      fmt::format("--limit: the background alone gives {} a root mean square of {}, so no tolerance can "
                  "meet {}",
                  named.name, response_text(named, std::sqrt(response.background)), response_text(named, limit)),
      "raise the limit, or study smaller errors in [analysis] background");
}

/// Sets the tolerances with which the limit (SI) is kept. Negligible errors get the studied size, and the other errors
/// share the rest of the limit.
void set_limit(ResponseTolerances& found, double limit, const StoredResult& result, const ResponseStudy& study,
               const Catalog& catalog) {
  const MeanSquare& response = found.all.mean_square;
  const double added = std::min(response.growth(result.factor_sigma), limit * limit - response.background);
  found.negligible = negligible_errors(result, found.response, response, added);
  std::vector<Dimension> dimensions;
  for (const NamedUnit& factor : result.factors) dimensions.push_back(dimension_of(factor.unit));
  found.limit =
      limit_tolerances(study, response.holding(found.negligible, result.factor_sigma),
                       one_size_for_each(result.factor_sigma, dimensions), limit, largest_tolerances(result, catalog));
  for (const std::size_t p : found.negligible) {
    found.limit->equal_effect[p] = found.limit->equal_tolerance[p] = result.factor_sigma[p];
  }
}

/// Sets the tolerance of negligible errors to the studied size, for a response without a limit. The reference error is
/// never negligible.
void set_negligible(ResponseTolerances& found, const StoredResult& result) {
  const MeanSquare& response = found.all.mean_square;
  found.negligible = negligible_errors(result, found.response, response, response.growth(result.factor_sigma));
  std::erase(found.negligible, found.all.reference->factor);
  for (const std::size_t p : found.negligible) found.all.equal_effect[p] = result.factor_sigma[p];
}

/// Lines with the commands that run the written studies, and with the errors whose tolerance was cut to the largest
/// one.
std::string commands_of(const Confirmation& written) {
  std::string commands;
  for (const std::string& study : written.paths) {
    const std::string outcome = std::filesystem::path(study).replace_extension(".h5").string();
    commands += "test with: " + shell_command({"poesy", "run", study, "-o", outcome}) + "\n";
  }
  for (const std::string& error : written.at_largest) {
    commands += "  the tolerance of " + error + ", a quarter of the part that it is an error of, and no more\n";
  }
  return commands;
}

/// Writes the table of tolerances and, with a limit, the studies that test them. Returns text about the files.
std::string write_files(const TolerancesOptions& options, const StoredResult& result, const ResponseTolerances& found,
                        const Catalog& catalog) {
  const std::string beside = std::filesystem::path(options.result).stem().string() + "_tolerances";
  const std::string folder = options.folder.empty() ? beside : options.folder;
  OutputFolder output(folder, valid_hash(result));
  claim_tolerance_files(output, result, found, catalog);
  std::string table;
  std::string commands;
  output.fill([&] {
    if (found.limit) commands = commands_of(write_confirmation(folder, result, found, catalog));
    table = write_tolerances(folder, result, found);
  });
  return table + "\n" + commands;
}

/// A note on the number of errors of the mechanism that the study neither varies nor holds constant in its background.
/// None if there are no such errors, or if this program does not have the mechanism or cannot read the stored study.
std::optional<std::string> perfect_errors_note(const StoredResult& result, const Catalog& catalog) {
  const std::optional<Study> study = study_in(result, catalog);
  if (!study) return std::nullopt;
  const std::vector<FactorIndex>& varied = study->analysis.factors;
  std::set<FactorIndex> present(varied.begin(), varied.end());
  if (const auto& background = study->analysis.background) {
    present.insert(background->factors.begin(), background->factors.end());
  }
  const std::size_t all = study->model().factors.size();
  if (present.size() == all) return std::nullopt;
  const std::size_t absent = all - present.size();
  return fmt::format("{} of the mechanism's {} errors {} not in this study, and {} as perfect here", absent, all,
                     absent == 1 ? "was" : "were", absent == 1 ? "counts" : "count");
}

/// Refuses the option --limit if the result describes what remains after a calibration, because the studies that test
/// tolerances draw errors anew at each pose, so they have no machines to calibrate.
void refuse_calibrated(const TolerancesOptions& options, const StoredResult& result, const Catalog& catalog) {
  const std::optional<Study> study = study_in(result, catalog);
  if (!options.limit || !study || study->analysis.calibration == nullptr) return;
  throw InputError({options.result},
                   "its indices describe what a calibration leaves, and tolerances are tested without one",
                   "leave out --limit, or take a study of kind \"allocation\" with the same [analysis.calibration]");
}

/// The reason why the tolerances may not hold: the indices of some errors change with size. Empty if there is none.
/// Throws InputError instead of returning a reason, unless the user allows extrapolation.
std::string caveat_of(const TolerancesOptions& options, const StoredResult& result, const ResponseTolerances& found) {
  const std::string caveat = wrong_sizes_text(result, found);
  if (caveat.empty() || options.extrapolate) return caveat;
  const std::vector<std::size_t> changing = changing_errors(result, found.response);
  const bool counted_from = !found.limit && std::ranges::count(changing, found.all.reference->factor) > 0;
  throw InputError({options.result}, caveat,
                   fmt::format("study each at that size ([errors.override]){}{}, or give --extrapolate",
                               result.metric == "published" ? ", or all by [solver] metric = \"platform\"" : "",
                               counted_from ? ", or count from another error (--reference)" : ""));
}

}  // namespace

std::vector<std::span<const double>> proposed_tolerances(const ResponseTolerances& tolerances) {
  if (!tolerances.limit) return {tolerances.all.equal_effect};
  return {tolerances.limit->equal_effect, tolerances.limit->equal_tolerance};
}

std::vector<double> largest_tolerances(const StoredResult& result, const Catalog& catalog) {
  return quarters_of_parts(monte_carlo_study(result, catalog));
}

void claim_tolerance_files(OutputFolder& folder, const StoredResult& result, const ResponseTolerances& tolerances,
                           const Catalog& catalog) {
  folder.claim("tolerances.csv");
  if (!tolerances.limit) return;
  for (const char* study : {kEqualEffect, kEqualTolerance}) folder.claim(std::string(study) + ".toml");
  for (const std::string& file : files_beside(monte_carlo_study(result, catalog))) folder.claim(file);
}

/// A comment in the studies that test tolerances.
static constexpr std::string_view kChance =
    "the tolerances are exactly at the limit, as far as the indices say, so chance decides between PASS and FAIL: a "
    "root mean square within some per cent of the limit confirms them";

Confirmation write_confirmation(const std::string& folder, const StoredResult& result,
                                const ResponseTolerances& tolerances, const Catalog& catalog) {
  POESY_EXPECTS(tolerances.limit.has_value());
  Study study = monte_carlo_study(result, catalog);
  make_folder(folder);
  write_files_beside(folder, study, result.poses);
  study.analysis.limits = {{tolerances.response, tolerances.limit->limit}};
  const ErrorModel as_studied = study.errors;
  const NamedUnit& response = result.responses[tolerances.response];
  const std::string limit = response.unit == "1"
                                ? shortest(tolerances.limit->limit)
                                : readable_text({tolerances.limit->limit, display(response).dimension});
  const std::vector<double> largest = quarters_of_parts(study);
  const std::string comment = (tolerances.caveat.empty() ? "" : tolerances.caveat + "\n# ") + std::string(kChance);
  Confirmation written;
  const auto add = [&](const std::string& name, const std::string& words, std::span<const double> values) {
    study.title = "Tests " + words + " against a limit of " + limit + " on the root mean square of " + response.name;
    study.errors = as_studied;
    set_tolerances(study, largest, values, written.at_largest);
    written.paths.push_back(write_confirming_study(folder, name, study, comment));
  };
  add(kEqualEffect, "tolerances of equal effect", tolerances.limit->equal_effect);
  add(kEqualTolerance, "equal tolerances", tolerances.limit->equal_tolerance);
  return written;
}

std::string set_sensitivity_tolerances(const StoredResult& result, const TolerancesOptions& options,
                                       const Catalog& catalog, std::size_t width) {
  const std::size_t response = chosen_response(options, result);
  const NamedUnit& named = result.responses[response];
  refuse_calibrated(options, result, catalog);
  check_sizes(options, result, response);
  const ResponseStudy study = response_study(sensitivity_of(result), result.factor_sigma, result.factor_mean, response);
  const std::optional<ReferenceError> reference = reference_of(options, result, response);
  check_reference(options, result, study, named.name, reference);
  ResponseTolerances found{response, tolerances(study, reference), std::nullopt};
  if (options.limit) {
    set_limit(found, checked_limit(options, result, found.all.mean_square, named), result, study, catalog);
  } else {
    set_negligible(found, result);
  }
  found.caveat = caveat_of(options, result, found);
  Table table = tolerance_table(result, found);
  if (const auto note = perfect_errors_note(result, catalog)) table.notes.push_back(*note);
  const std::string text = text_of(table, width) + "\n" + write_files(options, result, found, catalog);
  if (!found.limit) return text;
  return text + prose_of(fmt::format("each run says PASS if the root mean square of {} over all poses is at most {}, "
                                     "else FAIL with exit code 6",
                                     named.name, response_text(named, found.limit->limit)),
                         width);
}

}  // namespace poesy::sensitivity
