#include "engine/report/tolerance_table.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/report/display.h"

namespace poesy {
namespace {

std::string number(double value) { return std::isnan(value) ? "-" : fmt::format("{:.4g}", value); }

std::string index_cells(const SensitivityResult& found, std::size_t at, double scale) {
  const auto text = [&](double index) {
    return std::abs(index) < kIndexRounding ? std::string("0") : number(index * scale);
  };
  const std::string interval = fmt::format("[{}, {}]", text(found.global_ci_low[at]), text(found.global_ci_high[at]));
  return fmt::format("{:>9} {:<22}", text(found.global[at]), interval);
}

std::string tolerance_cell(double tolerance, const Unit& unit) {
  if (std::isinf(tolerance)) return fmt::format("  {:>18}", "no effect");
  return fmt::format("  {:>18}", fmt::format("{} {:<3}", number(tolerance / unit.si), unit.name));
}

std::string reference_lines(const StoredResult& result, const ResponseTolerances& tolerances) {
  const NamedUnit& response = result.responses[tolerances.response];
  const std::optional<ReferenceError>& reference = tolerances.all.reference;
  if (!reference) return fmt::format("no error has an effect on {}\n", response.name);
  const NamedUnit& factor = result.factors[reference->factor];
  const double rms = std::sqrt(tolerances.all.mean_square.at(tolerances.all.equal_effect));
  std::string text = fmt::format("equal effect: as much as {} = {}\n", factor.name,
                                 readable_text({reference->tolerance, dimension_of(factor.unit)}));
  text += fmt::format("  with these, predicted root mean square of {}: {}\n", response.name,
                      std::isnan(rms) ? "unknown" : response_text(response, rms));
  return text;
}

std::string limit_lines(const StoredResult& result, const ResponseTolerances& tolerances) {
  if (!tolerances.limit) return "";
  const NamedUnit& response = result.responses[tolerances.response];
  return fmt::format(
      "limit: predicted root mean square of {} over samples and poses = {}; its mean is below that. The background "
      "alone gives {}\n"
      "  an error without effect on its own has its equal tolerance, for it may act together with others\n",
      response.name, response_text(response, tolerances.limit->limit),
      response_text(response, std::sqrt(tolerances.all.mean_square.background)));
}

}  // namespace

std::string response_text(const NamedUnit& response, double si) {
  const Unit& unit = display(response);
  const std::string value = fmt::format("{:.4g}", si / unit.si);
  return unit.name == "1" ? value : fmt::format("{} {}", value, unit.name);
}

std::string tolerance_table(const StoredResult& result, const ResponseTolerances& tolerances) {
  const SensitivityResult& found = result.sensitivity;
  const NamedUnit& response = result.responses[tolerances.response];
  const Unit& response_unit = display(response);
  std::string text = fmt::format("Tolerances for {}: standard deviations of normal errors\n", response.name) +
                     reference_lines(result, tolerances) + limit_lines(result, tolerances);
  text += fmt::format("\n{:<16}  {:<7}  {:>4}  {:<40}  {:>7}  {:>18}", "error", "kind", "limb",
                      fmt::format("index with {:.3g} % interval", 100.0 * found.conf_level), "share", "equal effect");
  if (tolerances.limit) text += fmt::format("  {:>18}  {:>18}", "limit, eq. effect", "limit, eq. toler.");
  text += '\n';
  for (std::size_t p = 0; p < result.factors.size(); ++p) {
    const NamedUnit& factor = result.factors[p];
    const Unit& unit = display(factor);
    text += fmt::format(
        "{:<16}  {:<7}  {:>4}  {} {:<7}  {:>5} %", factor.name, error_kind(dimension_of(factor.unit)),
        result.factor_limb[p], index_cells(found, tolerances.response * found.factors + p, unit.si / response_unit.si),
        fmt::format("{}/{}", response_unit.name, unit.name),
        std::isnan(tolerances.all.variance_share[p]) ? "-"
                                                     : fmt::format("{:.1f}", 100.0 * tolerances.all.variance_share[p]));
    text += tolerance_cell(tolerances.all.equal_effect[p], unit);
    if (tolerances.limit) {
      text += tolerance_cell(tolerances.limit->equal_effect[p], unit) +
              tolerance_cell(tolerances.limit->equal_tolerance[p], unit);
    }
    text += '\n';
  }
  return text;
}

}  // namespace poesy
