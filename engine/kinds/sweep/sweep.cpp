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
#include "engine/report/requirements.h"
#include "engine/report/tables.h"
#include "engine/stats/proportion.h"
#include "engine/study/study_kind.h"

namespace poesy::sweep {
namespace {

std::string verdict_of(const StoredResult& stored) {
  using enum YieldVerdict::Decision;
  if (!stored.verdicts) return "none";
  const std::optional<YieldVerdict>& yield = stored.verdicts->yield;
  if (yield && yield->decision == not_asked) return "none";
  if (yield && yield->decision == undecided) return "undecided";
  return stored.verdicts->passed() ? "kept" : "not kept";
}

/// For each machine of a design, true if the machine is rejected.
using Rejected = std::vector<bool>;

/// The numbers of machines that two designs judge differently.
struct Discordant {
  std::uint64_t gained = 0;  ///< machines that are rejected in the first design but not in the other
  std::uint64_t lost = 0;    ///< machines that are rejected in the other design but not in the first
};

Discordant discordant(const Rejected& first, const Rejected& other) {
  Discordant count;
  for (std::size_t n = 0; n < first.size(); ++n) {
    count.gained += first[n] && !other[n] ? 1U : 0U;
    count.lost += !first[n] && other[n] ? 1U : 0U;
  }
  return count;
}

/// The arrays of a result for the changes from one design to all others, and for the ends of their intervals.
struct Changes {
  Result::Numbers& value;
  Result::Numbers& low;
  Result::Numbers& high;
};

/// Collects the results of designs one after the other, and compares each design with the first and with the best one.
class Comparer {
 public:
  Comparer(std::span<const SweptKey> keys, std::span<const SweptDesign> designs, std::string response)
      : keys_(keys), designs_(designs), response_(std::move(response)) {}

  /// Adds the next design. rejected: [machines] 1 if the machine is rejected, otherwise 0; empty if the design has no
  /// machines.
  void add(const StoredResult& stored, const std::vector<std::uint8_t>& rejected) {
    const std::size_t d = found_.solves.size();
    const ReportKind& kind = kind_of(stored).report;
    if (d == 0) begin(stored);
    found_.solves.push_back(kind.tally(stored).total());
    found_.content_sha256(d) = stored.content_sha256;
    found_.verdict(d) = verdict_of(stored);
    found_.left_out(d) = left_out_share(stored);
    found_.has_first_poses(d) = stored.poses == first_poses_ ? 1 : 0;
    merits_.push_back(merits_of(stored));
    if (d == 0) begin(stored, merits_.front(), !rejected.empty());
    if (has_machines_) {
      rejected_.emplace_back(rejected.begin(), rejected.end());
      found_.machines(d) = rejected.size();
    }
    for (std::size_t q = 0; q < found_.quantities.size(); ++q) keep(q, d);
  }

  /// The comparison. Precondition: all designs were added.
  Result result() && {
    if (has_machines_) pair_machines();
    for (std::size_t q = 0; q < found_.quantities.size(); ++q) {
      compare_all_with(0, q, {found_.change, found_.change_low, found_.change_high});
      if (const auto best = best_design(found_, q)) {
        compare_all_with(*best, q, {found_.from_best, found_.from_best_low, found_.from_best_high});
      }
    }
    return std::move(found_);
  }

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
    found_.left_out = decltype(found_.left_out)({count});
    found_.has_first_poses = decltype(found_.has_first_poses)({count});
    first_poses_ = stored.poses;
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

  /// Records the names and units of the figures of merit, which are those of the first design. judges_machines: true if
  /// the machines of the first design were judged.
  void begin(const StoredResult& stored, const std::vector<Merit>& merits, bool judges_machines) {
    const bool has_yield = stored.verdicts && stored.verdicts->yield;
    has_machines_ = has_yield && judges_machines;
    const std::size_t count = merits.size();
    found_.quantity_unit = decltype(found_.quantity_unit)({count});
    found_.most_is_best = decltype(found_.most_is_best)({count});
    found_.is_paired = decltype(found_.is_paired)({count}, std::uint8_t{0});
    for (std::size_t q = 0; q < count; ++q) {
      found_.quantities.push_back(merits[q].what);
      found_.quantity_unit(q) = merits[q].unit;
      found_.most_is_best(q) = merits[q].most_best ? 1 : 0;
    }
    for (auto* numbers : {&found_.merit, &found_.low, &found_.high, &found_.change, &found_.change_low,
                          &found_.change_high, &found_.from_best, &found_.from_best_low, &found_.from_best_high}) {
      *numbers = Result::Numbers({count, designs_.size()}, kNaN);
    }
    found_.conf_level = has_yield ? stored.verdicts->yield->conf_level : designs_.front().study.analysis.conf_level;
    if (!has_machines_) return;
    for (auto* counts : {&found_.gained, &found_.lost, &found_.machines}) {
      *counts = Array<std::uint64_t, axis::Design>({designs_.size()}, std::uint64_t{0});
    }
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

  /// The figure of merit q of design d; null if the design does not have it.
  const Merit* find(std::size_t q, std::size_t d) const {
    const auto at = std::ranges::find(merits_[d], found_.quantities[q], &Merit::what);
    return at == merits_[d].end() ? nullptr : &*at;
  }

  void keep(std::size_t q, std::size_t d) {
    const Merit* own = find(q, d);
    if (own == nullptr) return;
    found_.merit(q, d) = own->value;
    found_.low(q, d) = own->low;
    found_.high(q, d) = own->high;
  }

  /// For each design, counts the machines that this design and the first one judge differently. Does nothing if designs
  /// have different numbers of machines, as with adaptive samples.
  void pair_machines() {
    if (!std::ranges::all_of(rejected_, [&](const Rejected& own) { return own.size() == rejected_.front().size(); })) {
      return;
    }
    found_.is_paired(yield_at()) = 1;
    for (std::size_t d = 1; d < rejected_.size(); ++d) {
      const Discordant count = discordant(rejected_.front(), rejected_[d]);
      found_.gained(d) = count.gained;
      found_.lost(d) = count.lost;
    }
  }

  /// Sets the changes of figure of merit q from the reference design to all others.
  void compare_all_with(std::size_t reference, std::size_t q, const Changes& changes) const {
    const Merit* from = find(q, reference);
    for (std::size_t d = 0; d < merits_.size(); ++d) {
      const Merit* own = find(q, d);
      if (d == reference || from == nullptr || own == nullptr) continue;
      MeritChange change = change_of(*from, *own);
      if (found_.is_paired(q) != 0) take_pairs(reference, d, change);
      changes.value(q, d) = change.value;
      changes.low(q, d) = change.low;
      changes.high(q, d) = change.high;
    }
  }

  /// Replaces the interval of a change of the yield by the interval from paired verdicts. It is narrower, because both
  /// designs have the same machines.
  void take_pairs(std::size_t from, std::size_t to, MeritChange& change) const {
    const Discordant count = discordant(rejected_[from], rejected_[to]);
    const Interval paired = paired_change(count.gained, count.lost, rejected_[from].size(), found_.conf_level).interval;
    change.low = 100.0 * paired.low;
    change.high = 100.0 * paired.high;
  }

  /// The position of the yield among the figures of merit. Precondition: there is a yield.
  std::size_t yield_at() const {
    return static_cast<std::size_t>(std::ranges::find(found_.quantities, kYieldMerit) - found_.quantities.begin());
  }

  std::span<const SweptKey> keys_;
  std::span<const SweptDesign> designs_;
  std::string response_;
  std::vector<std::vector<Merit>> merits_;  ///< [designs] the figures of merit of each design
  PoseSet first_poses_;                     ///< poses of the first design
  std::vector<Rejected> rejected_;  ///< [designs] which machines each design rejects; empty unless has_machines_
  bool has_machines_ = false;       ///< true if the first design has a yield of machines that were judged
  Result found_;
};

}  // namespace

std::string short_key(const Result& found, std::size_t key) {
  const auto last = [](const std::string& name) { return name.substr(name.find_last_of('.') + 1); };
  const std::string own = last(found.keys[key]);
  const auto alike = std::ranges::count_if(found.keys, [&](const std::string& name) { return last(name) == own; });
  return alike > 1 ? found.keys[key] : own;
}

std::string design_name(const Result& found, std::size_t design) {
  std::string text;
  for (std::size_t k = 0; k < found.keys.size(); ++k) {
    text += fmt::format("{}{} = {}", k == 0 ? "" : ", ", short_key(found, k), found.value(design, k));
  }
  return text;
}

std::optional<std::size_t> best_design(const Result& found, std::size_t quantity) {
  std::optional<std::size_t> best;
  const double sign = found.most_is_best(quantity) != 0 ? 1.0 : -1.0;
  for (std::size_t d = 0; d < found.designs(); ++d) {
    const double value = found.merit(quantity, d);
    if (std::isnan(value)) continue;
    if (!best || sign * value > sign * found.merit(quantity, *best)) best = d;
  }
  return best;
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

std::optional<Result> run_sweep(std::span<const SweptKey> keys, std::span<const SweptDesign> designs,
                                const std::string& response, const RunOptions& options,
                                const std::function<void(std::size_t)>& begin) {
  RunOptions of_design = options;
  of_design.keep_rejected = true;
  Comparer comparer(keys, designs, response);
  for (std::size_t d = 0; d < designs.size(); ++d) {
    const SweptDesign& design = designs[d];
    begin(d);
    const std::unique_ptr<Model> model = build_model(design.study.mechanism);
    std::optional<StudyResult> result = run_study(design.study, *model, design.poses.poses, of_design);
    if (!result || !options.checkpoints->complete()) return std::nullopt;
    const StoredResult stored =
        as_stored(design.study, design.poses, std::move(result->found), result->drawing ? &*result->drawing : nullptr);
    comparer.add(stored, result->rejected);
  }
  return std::move(comparer).result();
}

}  // namespace poesy::sweep
