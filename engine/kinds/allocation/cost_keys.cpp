#include "engine/kinds/allocation/cost_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "engine/base/ratio.h"
#include "engine/base/text.h"

namespace poesy::allocation {
namespace {

using Law = StatedCost::Law;

/// The names of cost laws in study files, in the order of StatedCost::Law.
constexpr std::array<std::string_view, 4> kLawNames{"none", "reciprocal", "reciprocal-power", "exponential"};

/// A cost as a study file states it. While a file is read, the coefficient b of the cost is for a tolerance in `unit`.
struct WrittenCost {
  StatedCost cost = {};
  Dimension dimension = Dimension::length;
  std::string unit = {};   ///< the unit of the tolerance as written; empty if the file states none
  double unit_size = 1.0;  ///< size of the unit, SI
};

/// The size of a unit in SI. None if the text is not a unit of this dimension.
std::optional<double> unit_size(std::string_view spelling, Dimension dimension) {
  if (dimension == Dimension::number) return spelling == si_unit(dimension) ? 1.0 : ratio_unit(spelling);
  const Unit* unit = find_unit(spelling);
  if (unit == nullptr || unit->dimension != dimension) return std::nullopt;
  return unit->si;
}

NumberBounds not_negative() {
  return {0.0, std::numeric_limits<double>::infinity(), true, "at least 0", "it must be at least 0"};
}

KeyValue<WrittenCost> unit_value() {
  const auto read = [](const StudyValue& value, WrittenCost& written) {
    written.unit = value.text();
    const auto size = unit_size(written.unit, written.dimension);
    if (!size) {
      value.fail(fmt::format("is '{}', which is not a unit of the part's tolerance, {}", printable(written.unit),
                             with_article(written.dimension)),
                 written.dimension == Dimension::number ? "known: %, ppm, um/m, 1"
                                                        : "known: " + unit_names(written.dimension));
    }
    written.unit_size = *size;
  };
  return {.type = "text", .read = read, .text = [](const WrittenCost& written) {
            return in_quotes(si_unit(written.dimension));
          }};
}

KeyValue<WrittenCost> tau_value() {
  const auto read = [](const StudyValue& value, WrittenCost& written) {
    written.cost.tau = value.positive_quantity(written.dimension);
  };
  return {.type = "quantity", .bounds = "greater than 0", .read = read, .text = [](const WrittenCost& written) {
            return exact_value(written.cost.tau, written.dimension);
          }};
}

const InnerRows<WrittenCost>& cost_keys() {
  using Row = InnerRow<WrittenCost>;
  static const InnerRows<WrittenCost> keys{
      .paths = {"analysis.parts.cost", "analysis.parts.processes.cost"},
      .meaning = "What one tolerance T costs, in any currency.",
      .chooser = "law",
      .owner = "the cost law",
      .rows = {
          Row{.name = "law",
              .value = word_at<Law>({{Law::reciprocal, "a + b / T"},
                                     {Law::reciprocal_power, "a + b / T^k"},
                                     {Law::exponential, "a + b exp(-T / tau)"}},
                                    &WrittenCost::cost, &StatedCost::law),
              .missing = "write e.g. {}",
              .example = "\"reciprocal\"",
              .meaning = "How the cost falls with T."},
          Row{.name = "a",
              .value = number_at(not_negative(), &WrittenCost::cost, &StatedCost::a),
              .meaning = "What no tolerance saves."},
          Row{.name = "b",
              .value = number_at(not_negative(), &WrittenCost::cost, &StatedCost::b),
              .missing = "write what a fine tolerance costs, e.g. {}",
              .example = "1",
              .meaning = "What falls with T."},
          Row{.name = "k",
              .value = number_at(above_zero("2"), &WrittenCost::cost, &StatedCost::k),
              .missing = "write the power of T, e.g. {}",
              .example = "2",
              .only_for = {name(Law::reciprocal_power)},
              .meaning = "The power of T."},
          Row{.name = "tau",
              .value = tau_value(),
              .missing = "write by how much T grows until b has fallen to 37 %, e.g. {}",
              .example = "\"0.1 mm\"",
              .only_for = {name(Law::exponential)},
              .meaning = "By how much T grows until what falls has fallen to 37 %."},
          Row{.name = "unit",
              .value = unit_value(),
              .missing = "write the unit of T in which b is stated, e.g. {}",
              .example = "\"mm\"",
              .only_for = {name(Law::reciprocal), name(Law::reciprocal_power)},
              .meaning =
                  "The unit of T in which b is stated, of lengths, angles or numbers as the part's errors are: b = 1 "
                  "with \"mm\" costs 1 at T = 1 mm."}}};
  return keys;
}

}  // namespace

std::string_view name(StatedCost::Law law) { return kLawNames.at(static_cast<std::size_t>(law)); }

CostLaw StatedCost::cost_law() const {
  switch (law) {
    case Law::reciprocal:
      return CostLaw::reciprocal(a, b);
    case Law::reciprocal_power:
      return CostLaw::reciprocal_power(a, b, k);
    case Law::exponential:
      return CostLaw::exponential(a, b, tau);
    case Law::none:
      break;
  }
  return CostLaw::constant(0.0);
}

StudyTable cost_table() { return described(cost_keys()); }

StatedCost read_cost(const StudyValue& value, Dimension dimension) {
  const StudySection section = value.section();
  WrittenCost written{.dimension = dimension};
  read_keys(cost_keys(), section, written, Nothing());
  StatedCost& cost = written.cost;
  if (written.unit.empty() || cost.b == 0.0) return cost;
  cost.b *= std::pow(written.unit_size, cost.k);
  if (std::isnormal(cost.b)) return cost;
  section.require("b").fail(fmt::format("with T in {} is {} with T in {}, which is out of range",
                                        printable(written.unit), shortest(cost.b), si_unit(dimension)),
                            "state the cost with a smaller power of T, or in another currency");
}

std::string cost_text(const StatedCost& cost, Dimension dimension) {
  const WrittenCost written{.cost = cost, .dimension = dimension};
  std::vector<std::string> keys;
  for (const InnerRow<WrittenCost>& row : cost_keys().rows) {
    if (!holds_for(row.only_for, name(cost.law))) continue;
    keys.push_back(fmt::format("{} = {}", row.name, row.value.text(written)));
  }
  return fmt::format("{{ {} }}", fmt::join(keys, ", "));
}

}  // namespace poesy::allocation
