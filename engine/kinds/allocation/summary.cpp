#include "engine/kinds/allocation/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "engine/base/units.h"
#include "engine/report/display.h"

namespace poesy::allocation {
namespace {

/// Rounds down to this many significant digits. If a value is below a number with this many digits only because of
/// rounding errors, the result is that number.
double rounded_down(double value, int digits) {
  constexpr double kRounding = 1e-12;
  if (!(value > 0.0) || std::isinf(value)) return value;
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - (digits - 1));
  return std::floor(value / unit * (1.0 + kRounding)) * unit;
}

}  // namespace

std::vector<std::size_t> limited_responses(const Result& found) {
  std::vector<std::size_t> list;
  for (std::size_t r = 0; r < found.limit.size(); ++r) {
    if (!std::isnan(found.limit(r))) list.push_back(r);
  }
  return list;
}

std::optional<std::size_t> worst_pose(std::span<const double> at_poses) {
  std::optional<std::size_t> worst;
  double largest = 0.0;
  for (std::size_t m = 0; m < at_poses.size(); ++m) {
    if (!(at_poses[m] > largest)) continue;
    largest = at_poses[m];
    worst = m;
  }
  return worst;
}

const Result::Parts<double>& shown_shares(const Result& found) {
  return has_costs(found) ? found.share : found.mean_square_share;
}

std::vector<std::size_t> ordered_parts(const Result& found, RowOrder order) {
  std::vector<std::size_t> list = positions(found.parts());
  if (order == RowOrder::study) return list;
  if (order == RowOrder::name) {
    std::ranges::stable_sort(list, {}, [&](std::size_t n) { return found.part_names[n]; });
    return list;
  }
  const Result::Parts<double>& shares = shown_shares(found);
  std::ranges::stable_sort(list, std::ranges::greater(),
                           [&](std::size_t n) { return std::isnan(shares(n)) ? -HUGE_VAL : shares(n); });
  return list;
}

std::string certificate_text(const Result& found) {
  using enum YieldVerdict::Decision;
  const YieldVerdict& shown = found.certificate;
  const std::string good = "of the machines are within all limits at all poses";
  const std::string asked = percent_text(shown.asked);
  const std::string sure = percent_text(shown.conf_level) + " confidence";
  const std::string counts =
      fmt::format("({} of {} rejected, {} {} allowed)", count_text(shown.rejects),
                  counted(shown.machines, "fresh machine", "fresh machines"), count_text(found.certificate_most),
                  found.certificate_most == 1 ? "was" : "were");
  if (shown.decision == kept) return fmt::format("certified: at least {} {}, with {} {}", asked, good, sure, counts);
  if (shown.decision == not_kept) {
    return fmt::format("not certified: fewer than {} {}, with {} {}", asked, good, sure, counts);
  }
  return fmt::format("not certified: it is not shown with {} that at least {} {} {}", sure, asked, good, counts);
}

std::size_t parts_on_drawing(const Result& found) {
  std::size_t drawn = 0;
  for (std::size_t n = 0; n < found.parts(); ++n) drawn += found.is_left_out(n) ? 0 : 1;
  return drawn;
}

std::string drawing_number(double tolerance, const std::string& si_unit) {
  constexpr int kDigits = 4;
  return number_text(rounded_down(tolerance / display_unit(dimension_of(si_unit)).si, kDigits), kDigits);
}

std::string drawing_text(double tolerance, const std::string& si_unit) {
  const std::string number = "+-" + drawing_number(tolerance, si_unit);
  const Unit& unit = display_unit(dimension_of(si_unit));
  return unit.dimension == Dimension::number ? number : fmt::format("{} {}", number, unit.name);
}

}  // namespace poesy::allocation
