#include "engine/io/result_format.h"
#include "engine/io/result_parts.h"

namespace poesy {
namespace {

/// The group in the words of a kind of study.
struct Wording {
  Axes quantities;   ///< axes of what an interval is for
  Axes slots;        ///< axes of what comes to its end alone
  std::string name;  ///< of the dataset of the quantities
  std::string unit;
  std::string quantity;
  std::string rule;
};

const Wording kGlobalIndices{
    {"response", "factor"},
    {"factor"},
    "index",
    "SI: response unit / factor unit",
    "Global index",
    "An error got samples until, at a milestone, the half-width of every response's global index was at most "
    "relative_error of the index, or the index rounding (below 1e-10), or max was there"};

const Wording kOverallMeans{
    {"response"},
    {},
    "mean",
    "SI: response unit, see /responses/unit",
    "Mean over the samples of all poses",
    "Every pose got samples until, at a milestone, the half-width of the mean of every response of the headline was at "
    "most relative_error of its magnitude, or max was there"};

const Wording& wording(std::string_view kind) {
  return kind == result_format::kSensitivity ? kGlobalIndices : kOverallMeans;
}

Axes with_milestones(Axes axes) {
  axes.emplace_back("milestone");
  return axes;
}

void add_group(ResultBuilder& result, const Wording& words, const ConvergenceResult& found) {
  h5::File& file = result.file();
  file.make_group("/convergence");
  result.show_axes("/convergence", with_milestones(words.quantities));
  file.set_attribute("/convergence", "description",
                     words.rule + ". The half-width is the larger distance from the value to an end of its interval");
  file.set_attribute("/convergence", "relative_error", found.relative_error);
  file.set_attribute("/convergence", "conf_level", found.conf_level);
  const std::vector<std::uint64_t> limits{found.min, found.max};
  file.set_attribute("/convergence", "min", std::span(limits).first(1));
  file.set_attribute("/convergence", "max", std::span(limits).last(1));
}

}  // namespace

void add_convergence(ResultBuilder& result, std::string_view kind, const ConvergenceResult& found) {
  const Wording& words = wording(kind);
  result.add_axis("milestone", found.milestones, {"1", "Samples at each pose when the intervals were looked at"});
  add_group(result, words, found);
  const Axes history = with_milestones(words.quantities);
  result.add("/convergence/" + words.name, history, found.quantity,
             {words.unit, words.quantity + " at each milestone; NaN after its samples ended"});
  result.add("/convergence/half_width", history, found.half_width,
             {words.unit, "Half-width of its interval at each milestone; NaN after its samples ended"});
  result.add("/convergence/reached", words.quantities, found.reached,
             {"1", "1: the half-width at the end is small enough; 0: it is not"});
  result.add("/convergence/relative_half_width", words.quantities, found.relative_half_width,
             {"1", "Half-width at the end over the magnitude of what it is for; NaN for zero over zero"});
  result.add("/convergence/samples", words.slots, found.samples, {"1", "Samples at each pose at the end"});
}

ConvergenceResult read_convergence(const h5::File& file, std::string_view kind) {
  const Wording& words = wording(kind);
  std::size_t slots = 1;
  for (const std::string& axis : words.slots) slots *= axis_length(file, axis);
  const std::size_t pairs = slots * axis_length(file, "response");
  const auto number = [&](const char* name) {
    return static_cast<std::size_t>(file.attribute<std::uint64_t>("/convergence", name).at(0));
  };
  ConvergenceResult found;
  found.min = number("min");
  found.max = number("max");
  found.relative_error = file.attribute<double>("/convergence", "relative_error").at(0);
  found.conf_level = file.attribute<double>("/convergence", "conf_level").at(0);
  found.milestones = file.read<std::uint64_t>("/milestone");
  const std::size_t history = pairs * found.milestones.size();
  found.quantity = read_exactly<double>(file, "/convergence/" + words.name, history);
  found.half_width = read_exactly<double>(file, "/convergence/half_width", history);
  found.reached = read_exactly<std::uint8_t>(file, "/convergence/reached", pairs);
  found.relative_half_width = read_exactly<double>(file, "/convergence/relative_half_width", pairs);
  found.samples = read_exactly<std::uint64_t>(file, "/convergence/samples", slots);
  return found;
}

}  // namespace poesy
