#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/model.h"
#include "engine/report/html/figures.h"
#include "engine/report/html/page.h"
#include "engine/result/result_file.h"

/// Functions for the sections that reports of all kinds of results have.
namespace poesy {

struct ReportKind;

/// A result, with its study and the model of its mechanism if they can be made again from the result file.
struct ReportedResult {
  StoredResult stored;                           ///< content of the result file
  std::string path;                              ///< path of the result file
  std::shared_ptr<const Model> model = nullptr;  ///< model of the result's mechanism; null if it cannot be built again
  std::shared_ptr<const Study> study = nullptr;  ///< study of the result; null if it cannot be read again
};

/// The names of the quantities at these indices.
std::vector<std::string> names_of(const std::vector<NamedUnit>& things, std::span<const std::size_t> positions);
/// The indices of the responses in StoredResult::headline (those that a summary shows). The response that ranks errors
/// (default_ranking()) comes first, and responses that do not vary come last.
std::vector<std::size_t> headline_order(const StoredResult& result);
/// The indices of all responses: those of StoredResult::headline in the order of headline_order(), followed by the
/// others, except that all responses that do not vary come last.
std::vector<std::size_t> response_order(const StoredResult& result);

/// The units in which these responses are shown: for each response a list with one unit.
std::vector<std::vector<std::string>> response_units(const StoredResult& result,
                                                     std::span<const std::size_t> responses);
/// The words of a caption that describe the order of errors. mixed: true if errors have different units.
std::string order_by_effect(bool mixed);
bool mixed_units(const std::vector<NamedUnit>& things);  ///< Returns true if the units differ.

/// The responses and poses that the figures of a result show. They are limited so that a report stays small.
struct ShownCells {
  /// If the figures of all responses would have more values than this, the responses outside StoredResult::headline are
  /// left out. If the others still have too many values (kMost, kMostInLayer), poses are left out as well.
  static constexpr std::size_t kMostWithAllResponses = 300'000;
  static constexpr std::size_t kMost = 600'000;         ///< The largest number of values of all shown responses.
  static constexpr std::size_t kMostInLayer = 400'000;  ///< The largest number of values of one response.

  std::vector<std::size_t> responses;  ///< indices of the responses that are shown
  std::vector<std::size_t> poses;      ///< indices of the poses that are shown, ascending
  std::size_t all_responses = 0;       ///< number of responses before some were left out
  std::size_t all_poses = 0;           ///< number of poses in the result

  /// Returns the values at the poses that are shown: [rows x shown poses]. values: values at all poses [rows x all
  /// poses].
  std::vector<double> at_poses(std::span<const double> values) const;
  bool thinned() const { return poses.size() < all_poses; }  ///< Returns true if poses are left out.
  std::string note() const;  ///< A sentence that says what is left out; empty if nothing is left out.
};

/// The number of values for each response and pose in figures that show a summary of the samples, such as mean, or
/// median and quantiles.
inline constexpr std::size_t kSummaryRows = 4;

/// Chooses the responses and poses that figures show. rows: number of values of each response at each pose. responses:
/// the responses to show; none: all responses, or those of StoredResult::headline if all would give too many values.
ShownCells shown_cells(const StoredResult& result, std::size_t rows,
                       std::optional<std::vector<std::size_t>> responses = std::nullopt);

/// Makes figures of a result over its poses, with the responses and poses that are shown.
class PoseFigures {
 public:
  /// The object refers to `result` and `page`. shown: the responses and poses that figures show.
  PoseFigures(const StoredResult& result, ShownCells shown, Page& page);

  /// The indices of the responses that are shown.
  const std::vector<std::size_t>& responses() const { return shown_.responses; }
  void add_note(Section& section) const;  ///< Adds a note to the section if responses or poses are left out.
  /// Adds values / unit at the shown poses to the page's arrays. values: values at all poses [rows x all poses].
  ArrayName add(const std::string& name, std::span<const double> values, double unit = 1.0) const;
  /// Adds values of a response at the shown poses to the page's arrays, in the unit that results show. values: values
  /// at all poses [rows x all poses], SI.
  ArrayName add(const std::string& name, std::span<const double> values, const NamedUnit& response) const;

  /// The x axis of curves over poses: the time on a trajectory, otherwise the pose's number.
  Coordinate axis() const;
  /// A heat map with these rows. The columns are the poses, which the reader orders by time or by a coordinate. order:
  /// first order of the columns; see HeatMap::order.
  HeatMap heat_map(std::vector<HeatLayer> layers, std::vector<std::string> rows, std::string order) const;
  /// Adds a field with the condition number of each pose.
  void add_condition(std::vector<Field>& fields) const;
  /// A field with the share of solves that did not converge at each pose. shares: the shares at all poses.
  Field not_converged(std::span<const double> shares) const;
  /// Adds a map of the poses to a section, coloured by these fields. key: key of the figure in the page.
  void add_workspace(Section& section, std::vector<Field> fields,
                     std::string_view caption = "Each dot is a pose of the study, coloured by what is chosen.",
                     const std::string& key = "workspace") const;

 private:
  std::vector<Coordinate> coordinates() const;
  Coordinate time_axis() const;
  Coordinate number_axis() const;
  ArrayName numbers() const;

  const StoredResult& result_;
  Page& page_;
  ShownCells shown_;
};

/// Returns the estimates with the two ends of each interval. If `course` has half-widths instead of ends, the ends are
/// computed from the half-widths.
EstimateCourse with_ends(EstimateCourse course);

/// The curve of the estimates of one quantity over the number of samples, with their intervals. unit: the unit of the
/// curve in SI, such as 0.001 for mm. at: index of the quantity in `course`. array: beginning of the names of the
/// stored arrays.
Series series_of(const EstimateCourse& course, std::size_t at, double unit, std::string label, const std::string& array,
                 ArrayPool& pool);

/// A figure with an x axis for the number of samples, and no panels yet.
Lines over_samples(const EstimateCourse& course, ArrayPool& pool);

/// Adds to the page a section on the uncertainty of estimates; its first paragraph explains the intervals. heading:
/// "How sure are ...".
Section& add_how_sure(Page& page, std::string heading, double conf_level);

/// The ends of a response's limit as marks in a figure of the response. The lower end is left out unless the response
/// has negative values (has_negative). Empty if the study does not limit the response, or limits only its spread.
std::vector<Mark> limit_marks(const StoredResult& result, std::size_t response, bool has_negative);

/// A sentence for each limit: "gap keeps its limit of 12 mm with 3.05 mm." If a yield is judged, one sentence on the
/// yield instead. Empty if the study states no limits.
std::string limits_text(const StoredResult& result);

/// A clause as a sentence, with a capital letter and a full stop.
std::string as_sentence(std::string clause);

/// Puts a section on the study's limits in front of all other sections, if there is a table of the limits or of the
/// yield. tables: the result's tables.
void add_limits(std::span<const Table> tables, Page& page);

/// Adds to the page the section that describes the responses in words.
void add_responses(const StoredResult& result, Page& page);

/// Adds to the page the section with the unit and the meaning of every error and every pose coordinate. Figures show
/// the same explanation if a reader points at a name.
void add_glossary(const StoredResult& result, Page& page);

/// Adds to the page the section on solves that did not converge. The section says how solves ended, shows how many did
/// not converge for each row of the tally (SolveTally) and each pose, and lists failures with the commands that replay
/// them.
void add_outcomes(const ReportKind& kind, const ReportedResult& result, Page& page);

/// Adds to the page the section on what was run, for one result or for several results side by side. For several
/// results, settings that differ are visible, and settings that are equal are folded.
void add_what_was_run(const ReportKind& kind, std::span<const ReportedResult> results, Page& page);

/// Adds a figure to a page, and the place where it is drawn to a section. key: key of the figure in the page.
void add_figure(Page& page, Section& section, const std::string& key, Figure figure, std::string_view caption);

/// A quantity by which results are compared. It has a value for each option and each item, in the unit shown.
struct ComparableQuantity {
  std::string label;  ///< label for people
  std::string array;  ///< beginning of the names of the quantity's arrays in the page
  /// [options] The units of the values: a list with one unit for all items, or with one for each item.
  std::vector<std::vector<std::string>> units;
  std::vector<double> value;      ///< [options x items] values
  std::vector<double> low = {};   ///< lower ends of the intervals of `value`; empty if there are none
  std::vector<double> high = {};  ///< upper ends of the intervals of `value`; empty if there are none
};

/// The numbers of a result that can be compared with those of another result of the same kind, for options (such as
/// responses) and items (such as errors).
struct Comparable {
  std::string option_word;           ///< what an option is: "response"
  std::vector<std::string> options;  ///< names of the options
  std::string item_word;             ///< what an item is: "error"
  std::vector<std::string> items;    ///< names of the items
  /// The compared quantities. Bars show all of them; ranks, scatter plot, table and answer use the first one.
  std::vector<ComparableQuantity> quantities = {};
  bool ranked = false;              ///< true if items are ordered by size
  std::string total_label = {};     ///< label of the totals; empty: there are none
  std::vector<double> totals = {};  ///< [options] total over all items, in the units shown
};

/// A Comparable without quantities; its options are the responses in the order of response_order().
Comparable comparable_by_response(const StoredResult& result, std::string item_word, std::vector<std::string> items);

/// Adds a quantity with the units of the responses. value(response, item): the value, SI.
void add_quantity(Comparable& to, const StoredResult& result, std::string label, std::string array,
                  const std::function<double(std::size_t, std::size_t)>& value);

/// Two results, reduced to the options and items that both have, in the order of the first result (A).
struct Comparison {
  Comparable a;                     ///< part of the first result
  Comparable b;                     ///< part of the second result
  std::vector<std::string> only_a;  ///< items that only the first result has
  std::vector<std::string> only_b;  ///< items that only the second result has
};

/// Compares two results of this kind. Throws InputError if they have no option or no item in common.
Comparison comparison(const ReportKind& kind, const ReportedResult& a, const ReportedResult& b);

/// The tables of a comparison, one for each option.
std::vector<Table> comparison_tables(const Comparison& compared);

/// The summary of a comparison at the top of its report.
Answer comparison_answer(const Comparison& compared);

/// Adds sections with the figures and tables of a comparison to a page.
void add_comparison(const Comparison& compared, Page& page);

}  // namespace poesy
