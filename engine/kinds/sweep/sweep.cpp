#include "engine/kinds/sweep/sweep.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/kinds/registry.h"
#include "engine/kinds/result_file.h"
#include "engine/kinds/study_run.h"
#include "engine/report/merits.h"
#include "engine/report/tables.h"
#include "engine/stats/proportion.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

std::string verdict_of(const StoredResult& stored) {
  using enum YieldVerdict::Decision;
  if (!stored.verdicts) return "none";
  const std::optional<YieldVerdict>& yield = stored.verdicts->yield;
  if (yield && yield->decision == not_asked) return "none";
  if (yield && yield->decision == undecided) return "undecided";
  return stored.verdicts->passed() ? "kept" : "not kept";
}

/// The numbers of machines that two designs judge differently.
struct Discordant {
  std::uint64_t gained = 0;  ///< machines that are rejected only in the first design
  std::uint64_t lost = 0;    ///< machines that are rejected only in the other design
};

Discordant discordant(std::span<const std::uint8_t> first, std::span<const std::uint8_t> other) {
  Discordant count;
  for (std::size_t n = 0; n < first.size(); ++n) {
    count.gained += first[n] > other[n] ? 1U : 0U;
    count.lost += first[n] < other[n] ? 1U : 0U;
  }
  return count;
}

/// Compares designs with the first design, one after the other.
class Comparer {
 public:
  Comparer(std::span<const SweptKey> keys, std::span<const SweptDesign> designs, std::string response)
      : keys_(keys), designs_(designs), response_(std::move(response)) {}

  /// Adds the next design. rejected: [machines] 1 if the machine is rejected, otherwise 0; empty if the design has no
  /// machines.
  void add(const StoredResult& stored, std::vector<std::uint8_t> rejected) {
    const std::size_t d = found_.solves.size();
    const ReportKind& kind = kind_of(stored).report;
    if (d == 0) begin(stored);
    found_.solves.push_back(kind.tally(stored).total());
    found_.content_sha256(d) = stored.content_sha256;
    found_.verdict(d) = verdict_of(stored);
    const std::vector<Merit> merits = merits_of(stored);
    if (d == 0) begin(stored, merits, std::move(rejected));
    for (std::size_t q = 0; q < first_.size(); ++q) compare(q, d, merits);
    if (!first_rejected_.empty() && d > 0) pair(d, rejected);
  }

  SweepResult result() && { return std::move(found_); }

 private:
  /// Records the kind of the studies and the values of all designs.
  void begin(const StoredResult& stored) {
    const std::size_t count = designs_.size();
    found_.kind = stored.kind;
    std::ranges::transform(keys_, std::back_inserter(found_.keys), &SweptKey::key);
    found_.value = decltype(found_.value)({count, keys_.size()});
    found_.number = decltype(found_.number)({count, keys_.size()});
    found_.unit = decltype(found_.unit)({keys_.size()});
    found_.content_sha256 = decltype(found_.content_sha256)({count});
    found_.verdict = decltype(found_.verdict)({count});
    for (std::size_t d = 0; d < count; ++d) {
      for (std::size_t k = 0; k < keys_.size(); ++k) {
        const std::string& value = designs_[d].given[k].value;
        const SweptNumber number = number_of(value);
        found_.value(d, k) = value;
        found_.number(d, k) = number.number;
        if (d == 0) found_.unit(k) = number.unit;
      }
    }
    // A number whose unit differs from that of the first design is NaN, because one axis could not show both.
    for (std::size_t d = 1; d < count; ++d) {
      for (std::size_t k = 0; k < keys_.size(); ++k) {
        if (number_of(found_.value(d, k)).unit != found_.unit(k)) found_.number(d, k) = kNaN;
      }
    }
    if (response_.empty()) response_ = default_ranking(stored);
    found_.response = response_;
  }

  /// Records the figures of merit of the first design and which of its machines are rejected.
  void begin(const StoredResult& stored, const std::vector<Merit>& merits, std::vector<std::uint8_t> rejected) {
    first_ = merits;
    const bool has_yield = stored.verdicts && stored.verdicts->yield;
    if (has_yield) first_rejected_ = std::move(rejected);
    const std::size_t count = merits.size();
    found_.quantity_unit = decltype(found_.quantity_unit)({count});
    found_.most_is_best = decltype(found_.most_is_best)({count});
    found_.is_paired = decltype(found_.is_paired)({count}, std::uint8_t{0});
    for (std::size_t q = 0; q < count; ++q) {
      found_.quantities.push_back(merits[q].what);
      found_.quantity_unit(q) = merits[q].unit;
      found_.most_is_best(q) = merits[q].most_best ? 1 : 0;
    }
    for (auto* numbers :
         {&found_.merit, &found_.low, &found_.high, &found_.change, &found_.change_low, &found_.change_high}) {
      *numbers = SweepResult::Numbers({count, designs_.size()}, kNaN);
    }
    if (has_yield) found_.conf_level = stored.verdicts->yield->conf_level;
    if (first_rejected_.empty()) return;
    found_.is_paired(yield_at()) = 1;
    for (auto* counts : {&found_.gained, &found_.lost, &found_.machines}) {
      *counts = Array<std::uint64_t, axis::Design>({designs_.size()}, std::uint64_t{0});
    }
    found_.machines(0) = first_rejected_.size();
  }

  std::vector<Merit> merits_of(const StoredResult& stored) const {
    const auto at = std::ranges::find(stored.responses, response_, &NamedUnit::name);
    if (at == stored.responses.end()) {
      std::vector<std::string_view> known;
      std::ranges::transform(stored.responses, std::back_inserter(known), &NamedUnit::name);
      throw InputError({}, "--response: a design has no response '" + printable(response_) + "'",
                       suggestion(response_, known));
    }
    std::vector<Merit> merits = kind_of(stored).report.merits(stored, response_);
    if (!merits.empty()) return merits;
    throw InputError({}, "a design has no figure of merit by which it could be compared",
                     "give the parts of an allocation costs, or sweep a study of another kind");
  }

  void compare(std::size_t q, std::size_t d, const std::vector<Merit>& merits) {
    const auto own = std::ranges::find(merits, first_[q].what, &Merit::what);
    if (own == merits.end()) return;
    found_.merit(q, d) = own->value;
    found_.low(q, d) = own->low;
    found_.high(q, d) = own->high;
    if (d == 0) return;
    const MeritChange change = change_of(first_[q], *own);
    found_.change(q, d) = change.value;
    found_.change_low(q, d) = change.low;
    found_.change_high(q, d) = change.high;
  }

  /// The position of the yield among the figures of merit. Precondition: there is a yield.
  std::size_t yield_at() const {
    return static_cast<std::size_t>(std::ranges::find(first_, kYieldMerit, &Merit::what) - first_.begin());
  }

  /// Replaces the interval of the change of the yield by the paired interval, because both designs have the same
  /// machines. With adaptive samples, designs may have different numbers of machines; then the wider interval stays.
  void pair(std::size_t d, std::span<const std::uint8_t> rejected) {
    const std::size_t q = yield_at();
    found_.machines(d) = rejected.size();
    if (rejected.size() != first_rejected_.size()) return static_cast<void>(found_.is_paired(q) = 0);
    const Discordant count = discordant(first_rejected_, rejected);
    const Estimate change = paired_change(count.gained, count.lost, rejected.size(), found_.conf_level);
    found_.gained(d) = count.gained;
    found_.lost(d) = count.lost;
    found_.change_low(q, d) = 100.0 * change.interval.low;
    found_.change_high(q, d) = 100.0 * change.interval.high;
  }

  std::span<const SweptKey> keys_;
  std::span<const SweptDesign> designs_;
  std::string response_;
  std::vector<Merit> first_;
  std::vector<std::uint8_t> first_rejected_;
  SweepResult found_;
};

}  // namespace

std::string short_key(const SweepResult& found, std::size_t key) {
  const auto last = [](const std::string& name) { return name.substr(name.find_last_of('.') + 1); };
  const std::string own = last(found.keys[key]);
  const auto alike = std::ranges::count_if(found.keys, [&](const std::string& name) { return last(name) == own; });
  return alike > 1 ? found.keys[key] : own;
}

std::string design_name(const SweepResult& found, std::size_t design) {
  std::string text;
  for (std::size_t k = 0; k < found.keys.size(); ++k) {
    text += fmt::format("{}{} = {}", k == 0 ? "" : ", ", short_key(found, k), found.value(design, k));
  }
  return text;
}

void check_sweep(std::span<const SweptDesign> designs, const std::string& path) {
  const Study& first = designs.front().study;
  for (const SweptDesign& design : designs) {
    if (design.study.analysis.kind == first.analysis.kind) continue;
    throw InputError({path}, "--set makes studies of different kinds", "sweep a key other than analysis.kind");
  }
  if (kind_of(first).report.merits != nullptr) return;
  std::vector<std::string_view> able;
  for (const Kind* kind : kinds()) {
    if (kind->report.merits != nullptr) able.push_back(kind->study.name);
  }
  throw InputError({path},
                   fmt::format("studies of kind {} have no figure of merit by which designs are compared",
                               first.analysis.kind->name),
                   fmt::format("sweep a study of kind {}", either(able)));
}

std::optional<SweepResult> run_sweep(std::span<const SweptKey> keys, std::span<const SweptDesign> designs,
                                     const std::string& response, const RunOptions& options) {
  RunOptions of_design = options;
  of_design.keep_rejected = true;
  Comparer comparer(keys, designs, response);
  for (const SweptDesign& design : designs) {
    const std::unique_ptr<Model> model = build_model(design.study.mechanism);
    std::optional<StudyResult> result = run_study(design.study, *model, design.poses.poses, of_design);
    if (!result || !options.checkpoints->complete()) return std::nullopt;
    const StoredResult stored =
        as_stored(design.study, design.poses, std::move(result->found), result->drawing ? &*result->drawing : nullptr);
    comparer.add(stored, std::move(result->rejected));
  }
  return std::move(comparer).result();
}

}  // namespace poesy
