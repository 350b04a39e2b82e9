#include "engine/kinds/monte_carlo/drivers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "engine/base/nan.h"
#include "engine/base/units.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/report/display.h"
#include "engine/stats/error_scores.h"
#include "engine/stats/told_together.h"
#include "engine/stats/yield_gradient.h"

namespace poesy::monte_carlo {
namespace {

constexpr double kStep = kErrorGrowth - 1.0;

/// If less than this share of the scatter is linear in the errors, the shares of single errors say little.
constexpr double kMostlyLinear = 0.9;

const YieldResult* yield_in(const StoredResult& result) {
  const auto& machines = monte_carlo_of(result).machines;
  return machines && machines->yield ? &*machines->yield : nullptr;
}

/// Positions of the limited responses for which the shares of the errors in the scatter are known. The response whose
/// limit rejects most machines comes first.
std::vector<std::size_t> shared_responses(const StoredResult& result, const YieldResult& yield) {
  std::vector<std::size_t> list;
  if (!yield.has_shares()) return list;
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    if (!std::isnan(yield.linear_share(r))) list.push_back(r);
  }
  std::ranges::stable_sort(list, {}, [&](std::size_t r) { return yield.by_response(r); });
  return list;
}

/// [errors] The change of the yield if the sigma of one error grows by a tenth, and both ends of its interval. If a
/// file has only the gradient of the yield, the change is computed from the gradient.
struct Changes {
  using Values = Array<double, axis::Factor>;
  Values value;
  Values low;
  Values high;

  bool is_known(std::size_t p) const { return !std::isnan(low(p)) && !std::isnan(high(p)); }
};

Changes changes_of(const StoredResult& result, const YieldResult& yield) {
  if (yield.has_change()) return {yield.change, yield.change_ci_low, yield.change_ci_high};
  const auto part = [&](const Changes::Values& slope) {
    Changes::Values change(slope.lengths(), kNaN);
    for (std::size_t p = 0; p < slope.size(); ++p) {
      if (std::isnan(slope(p))) continue;
      change(p) = std::max(-yield.value, kStep * slope(p) * result.factor_sigma[p]);
    }
    return change;
  };
  return {part(yield.gradient), part(yield.gradient_ci_low), part(yield.gradient_ci_high)};
}

/// Whether the share of error p in the scatter of any limited response is above zero or unknown. Also true if no
/// response has known shares. shares: the shares, or the lower ends of their intervals.
bool has_any_share(const StoredResult& result, const YieldResult& yield, const MainEffects::Indices& shares,
                   std::size_t p) {
  const std::vector<std::size_t> responses = shared_responses(result, yield);
  return responses.empty() || std::ranges::any_of(responses, [&](std::size_t r) { return !(shares(r, p) <= 0.0); });
}

/// The largest share of error p in the scatter of these responses; NaN if no share is known.
double largest_share(const YieldResult& yield, std::span<const std::size_t> responses, std::size_t p) {
  double largest = kNaN;
  for (const std::size_t r : responses) {
    const double share = yield.mean_square_share(r, p);
    if (!(share <= largest) && !std::isnan(share)) largest = share;
  }
  return largest;
}

/// The errors whose effect on the yield was tested, and those whose effect is distinguished from zero ("told").
struct ToldErrors {
  std::vector<std::size_t> told;  ///< positions of the errors whose effect is distinguished from zero: first those
                                  ///< whose share in the scatter of a response is certainly above zero or unknown,
                                  ///< then the others; in each group the largest loss of yield first
  std::size_t tested = 0;  ///< number of errors whose effect was tested: their change of the yield is known, and not
                           ///< all their shares in scatter are known to be zero
  std::size_t known = 0;   ///< number of errors whose change of the yield is known
};

/// Tests the effects of errors on the yield. All errors are tested together, because some of many separate tests would
/// show an effect by chance.
ToldErrors told_errors(const StoredResult& result, const YieldResult& yield, const Changes& changes) {
  ToldErrors found;
  std::vector<Estimate> estimates;
  std::vector<double> zero_sd;
  for (std::size_t p = 0; p < changes.value.size(); ++p) {
    const bool has_sd = !yield.change_sd_without_effect.empty() && !std::isnan(yield.change_sd_without_effect(p));
    zero_sd.push_back(has_sd ? yield.change_sd_without_effect(p) : 0.0);
    const bool tested = changes.is_known(p) && has_any_share(result, yield, yield.mean_square_share, p);
    found.known += changes.is_known(p) ? 1 : 0;
    found.tested += tested ? 1 : 0;
    estimates.push_back(tested ? Estimate{changes.value(p), {changes.low(p), changes.high(p)}}
                               : Estimate{kNaN, {kNaN, kNaN}});
  }
  const double freedom = static_cast<double>(yield.rejects) - 1.0;
  const std::vector<bool> told =
      told_together(estimates, {-yield.value, 1.0 - yield.value}, freedom, zero_sd, yield.conf_level);
  for (std::size_t p = 0; p < told.size(); ++p) {
    if (told[p]) found.told.push_back(p);
  }
  found.told = largest_first(std::move(found.told), [&](std::size_t p) { return -changes.value(p); });
  std::stable_partition(found.told.begin(), found.told.end(),
                        [&](std::size_t p) { return has_any_share(result, yield, yield.mean_square_share_ci_low, p); });
  return found;
}

/// The shares of errors in the scatter of the limited response with index r.
ResponseShares shares_of(const YieldResult& yield, std::size_t r) {
  ResponseShares shares{r, yield.mean_square_share.row(r), {}, yield.linear_share(r)};
  for (std::size_t p = 0; p < shares.each.size(); ++p) {
    if (std::isnan(shares.each[p])) {
      shares.correlated.push_back(p);
    } else {
      shares.together -= shares.each[p];
    }
  }
  constexpr double kRounding = 1e-12;
  if (shares.correlated.empty() || !(shares.together > kRounding)) shares.together = 0.0;
  return shares;
}

std::string linear_note(const StoredResult& result, const YieldResult& yield, std::size_t r) {
  if (is_first_order(result) && !(yield.linear_share(r) < kMostlyLinear)) {
    return fmt::format("{}: {}, so it is not tested whether its scatter is linear in them", result.responses[r].name,
                       kFirstOrder);
  }
  return fmt::format(
      "{}: {} of its scatter is linear in the errors{}", result.responses[r].name, percent_text(yield.linear_share(r)),
      yield.linear_share(r) < kMostlyLinear ? "; the rest belongs to no error alone, so these shares say little" : "");
}

/// A note on the mean of a response over the machines, which tighter tolerances do not change. Empty if the mean is a
/// smaller share of the mean square than kNoticeable, or if the file does not contain it.
std::string offset_note(const StoredResult& result, const YieldResult& yield, std::size_t r) {
  constexpr double kNoticeable = 0.001;  // smallest share of the mean square for which there is a note
  if (!yield.has_offset() || !(yield.offset_share(r) >= kNoticeable)) return {};
  return fmt::format(
      "{}: not in these shares is its mean over the machines, {} as a root mean square over the poses: {} of the whole "
      "mean square. Background and means of all errors make it together, with their signs; tighter tolerances leave it "
      "as it is",
      result.responses[r].name, response_text(result.responses[r], yield.offset(r)),
      percent_text(yield.offset_share(r)));
}

/// A note that names the errors whose shares are known only together; empty if there are none.
std::string together_note(const StoredResult& result, const ResponseShares& shares) {
  if (shares.correlated.empty()) return {};
  return fmt::format(
      "together: {}; correlated errors have no shares of their own, and where some are correlated, shares have no "
      "intervals",
      some_names(names_of(result.factors, shares.correlated)));
}

/// Adds to a table of shares a line with the joint shares of the correlated errors. columns: position of each
/// response's column of shares.
void add_together(Table& table, const YieldResult& yield, std::span<const std::size_t> responses,
                  std::span<const std::size_t> columns) {
  const ResponseShares first = shares_of(yield, responses.front());
  if (first.correlated.empty()) return;
  std::vector<Cell> row{text_cell(together_text(first))};
  row.resize(table.columns.size(), text_cell("-"));
  for (std::size_t n = 0; n < responses.size(); ++n) {
    row[columns[n]] = percent_cell(shares_of(yield, responses[n]).together);
  }
  const auto larger = std::ranges::count_if(first.each, [&](double share) { return share > first.together; });
  table.rows.insert(table.rows.begin() + larger, std::move(row));
}

Table share_table(const StoredResult& result, const YieldResult& yield, const std::vector<std::size_t>& responses) {
  const std::size_t first = responses.front();
  std::vector<FilledColumn> columns{name_column(result.factors, "error")};
  const auto add = [&](const std::string& name, const std::string& heading, std::span<const double> values,
                       int dispensable) {
    columns.push_back(
        {percent_column(name, heading, dispensable), [values](std::size_t p) { return percent_cell(values[p]); }});
  };
  Table table{.name = "mean_square_shares",
              .caption = fmt::format("Which errors a limit is up against: shares of the scatter of {}, to first order",
                                     result.responses[first].name),
              .columns = {},
              .notes = {fmt::format("scatter: mean square about the mean over the machines, over all poses, of a norm "
                                    "that of its vector; low, high: {} interval",
                                    percent_text(yield.conf_level))},
              .ranked = true};
  if (std::string note = together_note(result, shares_of(yield, first)); !note.empty()) {
    table.notes.push_back(std::move(note));
  }
  std::vector<std::size_t> shares;  // positions of the columns
  for (const std::size_t r : responses) {
    const std::string& response = result.responses[r].name;
    shares.push_back(columns.size());
    add("share_" + response, response, yield.mean_square_share.row(r), r == first ? 0 : 1);
    add("share_ci_low_" + response, "low", yield.mean_square_share_ci_low.row(r), r == first ? 0 : 2);
    add("share_ci_high_" + response, "high", yield.mean_square_share_ci_high.row(r), r == first ? 0 : 2);
    table.notes.push_back(linear_note(result, yield, r));
    if (std::string note = offset_note(result, yield, r); !note.empty()) table.notes.push_back(std::move(note));
    if (const LimitVerdict* verdict = verdict_on(result, r); verdict != nullptr && verdict->limit.is_spread()) {
      table.notes.push_back(response +
                            ": with its sign, less its mean over the poses, which does not change its spread");
    }
  }
  const auto share = [&](std::size_t p) { return yield.mean_square_share(first, p); };
  fill(table, largest_first(positions(result.factors.size()), share), columns);
  add_together(table, yield, responses, shares);
  return table;
}

/// Adds a line that counts errors: "33 errors whose effects are not certain". Adds nothing if there are none.
void add_line(Table& table, std::size_t errors, std::string_view one, std::string_view many) {
  if (errors == 0) return;
  std::vector<Cell> row{text_cell(fmt::format("{} {}", counted(errors, "error", "errors"), errors == 1 ? one : many))};
  row.resize(table.columns.size(), text_cell(""));
  table.rows.push_back(std::move(row));
}

/// A note on how small a change of the yield these machines can distinguish from zero (the median over the errors whose
/// change is not certain, each tested alone), and how many machines a change of a tenth of that size would need. Empty
/// if all changes are certain.
std::string needed_machines_note(const Changes& changes, const ToldErrors& found, const YieldResult& yield) {
  constexpr std::uint64_t kFiner = 10;
  std::vector<double> half_widths;
  for (std::size_t p = 0; p < changes.value.size(); ++p) {
    const double half_width = 0.5 * (changes.high(p) - changes.low(p));
    const bool is_told = std::ranges::find(found.told, p) != found.told.end();
    if (half_width > 0.0 && !is_told) half_widths.push_back(half_width);
  }
  if (half_widths.empty()) return {};
  const auto middle = half_widths.begin() + static_cast<std::ptrdiff_t>(half_widths.size() / 2);
  std::ranges::nth_element(half_widths, middle);
  return fmt::format(
      "With {}, a change of about {} is distinguished from zero; a tenth of it needs {}. The shares of the scatter "
      "rank errors with far fewer",
      counted(yield.machines, "machine", "machines"), percent_text(*middle),
      counted(kFiner * kFiner * yield.machines, "machine", "machines"));
}

/// A note on the order of the listed changes, and on their bias: among many estimates, those whose interval excludes
/// zero are usually larger than the truth (Ioannidis 2008, Epidemiology 19, 640-648). with_shares: whether the table
/// has a column with shares of the scatter.
std::string selection_note(bool with_shares) {
  return fmt::format(
      "rows are listed because their interval excludes zero, the largest loss first{}; of many uncertain effects those "
      "that are listed are overestimated as a rule, so {}",
      with_shares ? ", errors whose share may be zero last" : "",
      with_shares ? "compare a change with the share of the scatter"
                  : "run more machines before you rely on a small one");
}

Table change_table(const StoredResult& result, const YieldResult& yield) {
  const Changes changes = changes_of(result, yield);
  const auto column = [&](std::string name, std::string heading, const Changes::Values& values) {
    return FilledColumn{percent_column(std::move(name), std::move(heading)),
                        [&values](std::size_t p) { return percent_cell(values(p)); }};
  };
  Table table{
      .name = "yield_gradient",
      .caption = fmt::format("What the yield changes by if the sigma of one error grows by {}", percent_text(kStep)),
      .columns = {},
      .notes = {fmt::format(
          "low, high: {} interval of this error alone; slope: of the yield by sigma, 1/mm or 1/deg, which holds for "
          "small changes alone",
          percent_text(yield.conf_level))},
      .ranked = true};
  const ToldErrors found = told_errors(result, yield, changes);
  if (found.tested > 1) {
    table.notes.push_back(fmt::format(
        "shown are errors whose effect is certain at {} for all {} together (Holm 1979): of so many intervals some "
        "exclude zero by chance",
        percent_text(yield.conf_level), count_text(found.tested)));
  }
  std::vector<FilledColumn> columns{name_column(result.factors, "error"),
                                    column("change", "yield", changes.value),
                                    column("change_low", "low", changes.low),
                                    column("change_high", "high", changes.high),
                                    {number_column("slope", "slope", "", 1), [&](std::size_t p) {
                                       return number_cell(yield.gradient(p) * display(result.factors[p]).si);
                                     }}};
  const std::vector<std::size_t> shared = shared_responses(result, yield);
  if (!shared.empty()) {
    columns.push_back({percent_column("share", "share of scatter"),
                       [&, shared](std::size_t p) { return percent_cell(largest_share(yield, shared, p)); }});
  }
  if (found.tested > 1 && !found.told.empty()) table.notes.push_back(selection_note(!shared.empty()));
  if (!shared.empty()) {
    std::vector<std::string> names;
    for (const std::size_t r : shared) names.push_back(result.responses[r].name);
    table.notes.push_back(fmt::format("share of scatter: {}of the scatter of {}",
                                      names.size() > 1 ? "the largest of the shares " : "", fmt::join(names, ", ")));
  }
  fill(table, found.told, columns);
  const std::size_t unknown = changes.value.size() - found.known;
  add_line(table, found.known - found.told.size(), "whose effect is not certain", "whose effects are not certain");
  add_line(table, unknown, "of which these machines do not tell it", "of which these machines do not tell it");
  if (const std::string note = needed_machines_note(changes, found, yield); !note.empty()) table.notes.push_back(note);
  if (unknown > 0) {
    table.notes.emplace_back(
        "not told: where an error is correlated and not all errors of its block are normal, where it is drawn with "
        "others of its feature in a zone, where its mean is shifted, "
        "where it is a column of given machines, where one error that is not normal makes the rejects alone and no "
        "linear map is found, or no machine is "
        "rejected");
  }
  if (yield.rejects > 0 && yield.rejects < kFewRejects) {
    table.notes.push_back(fmt::format(
        "{} are few: intervals of 95 % by normal errors then hold the truth in some 90 % of all cases with five, and "
        "less often with fewer",
        counted(yield.rejects, "reject", "rejects")));
  }
  return table;
}

void add_share_figure(const StoredResult& result, const YieldResult& yield, Section& section, Page& page) {
  const std::vector<std::size_t> responses = shared_responses(result, yield);
  if (responses.empty()) return;
  const ResponseShares first = shares_of(yield, responses.front());
  std::vector<std::string> names = names_of(result.factors);
  if (!first.correlated.empty()) names.push_back(together_text(first));
  const auto add = [&](const std::string& name, const MainEffects::Indices& values, bool has_together = false) {
    std::vector<double> list;
    for (const std::size_t r : responses) {
      const std::span row = values.row(r);
      list.insert(list.end(), row.begin(), row.end());
      if (!first.correlated.empty()) list.push_back(has_together ? shares_of(yield, r).together : kNaN);
    }
    return page.figures.pool.add(name, list, 0.01);
  };
  Bars bars{{{"response", names_of(result.responses, responses)}},
            {{"share of the scatter", std::vector(responses.size(), std::vector<std::string>{"%"}),
              add("mean_square_share", yield.mean_square_share, true),
              add("mean_square_share_low", yield.mean_square_share_ci_low),
              add("mean_square_share_high", yield.mean_square_share_ci_high)}},
            std::move(names)};
  add_figure(page, section, "mean-square-shares", std::move(bars),
             "The errors that make a limited response scatter: shares of its mean square about its mean, to first "
             "order. Thin lines are intervals.");
}

/// Adds to the page the figure of the errors whose effect on the yield is certain.
void add_change_figure(const StoredResult& result, const YieldResult& yield, Section& section, Page& page) {
  const Changes changes = changes_of(result, yield);
  const std::vector<std::size_t> told = told_errors(result, yield, changes).told;
  if (told.empty()) return;
  const auto add = [&](const std::string& name, const Changes::Values& values) {
    std::vector<double> list;
    for (const std::size_t p : told) list.push_back(values(p));
    return page.figures.pool.add(name, list, 0.01);
  };
  Bars bars{{},
            {{fmt::format("change of the yield if sigma grows by {}", percent_text(kStep)),
              {{"percentage points"}},
              add("yield_change", changes.value),
              add("yield_change_low", changes.low),
              add("yield_change_high", changes.high)}},
            names_of(result.factors, told)};
  add_figure(page, section, "yield-gradient", std::move(bars),
             "The errors on which the yield depends for certain, all tested together. Thin lines are intervals of one "
             "error alone.");
}

}  // namespace

std::vector<std::size_t> largest_first(std::vector<std::size_t> order,
                                       const std::function<double(std::size_t)>& value) {
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    const double x = value(a);
    const double y = value(b);
    return std::isnan(y) ? !std::isnan(x) : x > y;
  });
  return order;
}

std::vector<double> in_order(const MainEffects::Indices& values, std::span<const std::size_t> responses) {
  std::vector<double> list;
  for (const std::size_t r : responses) {
    const std::span row = values.row(r);
    list.insert(list.end(), row.begin(), row.end());
  }
  return list;
}

std::optional<ResponseShares> response_shares(const StoredResult& result) {
  const YieldResult* const yield = yield_in(result);
  if (yield == nullptr) return std::nullopt;
  const std::vector<std::size_t> responses = shared_responses(result, *yield);
  if (responses.empty()) return std::nullopt;
  return shares_of(*yield, responses.front());
}

std::string together_text(const ResponseShares& shares) {
  return counted(shares.correlated.size(), "correlated error", "correlated errors") + " together";
}

std::vector<Table> driver_tables(const StoredResult& result) {
  const YieldResult* const yield = yield_in(result);
  if (yield == nullptr) return {};
  std::vector<Table> tables;
  const std::vector<std::size_t> responses = shared_responses(result, *yield);
  if (!responses.empty()) tables.push_back(share_table(result, *yield, responses));
  tables.push_back(change_table(result, *yield));
  return tables;
}

void add_drivers_section(const StoredResult& result, std::span<const Table> tables, Page& page) {
  const YieldResult& yield = *yield_in(result);
  Section& section = page.add_section("yield", "What the yield depends on");
  section.paragraph(
      "A machine has one set of errors, and is good if it is within every limit at every pose. The yield is the share "
      "of good machines. What each error adds to a limited response, and what the yield changes by with its size, "
      "follow from the same machines.");
  add_share_figure(result, yield, section, page);
  section.table(tables, "mean_square_shares");
  add_change_figure(result, yield, section, page);
  section.table(tables, "yield_gradient");
  section.table(tables, "reject_poses");
}

}  // namespace poesy::monte_carlo
