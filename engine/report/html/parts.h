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

/// Functions for the sections of all kinds of results.
namespace poesy {

struct ReportKind;

/// A result and its file.
struct ReportedResult {
  StoredResult stored;                           ///< the result
  std::string path;                              ///< path of its file
  std::shared_ptr<const Model> model = nullptr;  ///< model of the mechanism; null if it cannot be built again
};

/// The names at these positions.
std::vector<std::string> names_of(const std::vector<NamedUnit>& things, std::span<const std::size_t> positions);
/// The responses of the headline: the one that ranks errors first (default_ranking), those that do not vary last.
std::vector<std::size_t> headline_order(const StoredResult& result);
/// All responses: those of the headline first, in that order; those that do not vary last.
std::vector<std::size_t> response_order(const StoredResult& result);

/// The units of these responses, each as a list with one unit.
std::vector<std::vector<std::string>> response_units(const StoredResult& result,
                                                     std::span<const std::size_t> responses);
/// The part of a caption that describes the order of errors. mixed: whether their units differ.
std::string order_by_effect(bool mixed);
bool mixed_units(const std::vector<NamedUnit>& things);  ///< Whether the things have different units.

/// The part of a result's numbers that its figures show, so that a report stays small.
struct ShownCells {
  /// If there are more numbers than this, responses outside the headline are left out, then poses.
  static constexpr std::size_t kMostWithAllResponses = 300'000;
  static constexpr std::size_t kMost = 600'000;         ///< The largest number of numbers in a page.
  static constexpr std::size_t kMostInLayer = 400'000;  ///< The largest number of numbers in one layer.

  std::vector<std::size_t> responses;  ///< positions of the responses shown
  std::vector<std::size_t> poses;      ///< positions of the poses shown, ascending
  std::size_t all_responses = 0;       ///< number of responses in the result
  std::size_t all_poses = 0;           ///< number of poses in the result

  /// The numbers at the poses that are shown. values: [rows x M] at all poses.
  std::vector<double> at_poses(std::span<const double> values) const;
  bool thinned() const { return poses.size() < all_poses; }  ///< Whether poses are left out.
  std::string note() const;  ///< A sentence that says what is left out; empty if nothing is.
};

/// The numbers for each response and pose in figures that show summaries: mean or median, quantiles and so on.
inline constexpr std::size_t kSummaryRows = 4;

/// The part of a result to show, for `rows` numbers of each response at each pose. responses: those that must be shown;
/// none: all, or those of the headline.
ShownCells shown_cells(const StoredResult& result, std::size_t rows,
                       std::optional<std::vector<std::size_t>> responses = std::nullopt);

/// Makes the figures by pose of a result, for the part shown. Refers to the result and the page.
class PoseFigures {
 public:
  PoseFigures(const StoredResult& result, ShownCells shown, Page& page);  ///< For one page.

  const std::vector<std::size_t>& responses() const {
    return shown_.responses;
  }                                       ///< The positions of the responses shown.
  void add_note(Section& section) const;  ///< Adds a note to the section if something is left out.
  /// Adds values [rows x M] in units of `unit`, at the poses shown.
  ArrayName add(const std::string& name, std::span<const double> values, double unit = 1.0) const;
  /// Adds values of a response, SI, in the unit shown.
  ArrayName add(const std::string& name, std::span<const double> values, const NamedUnit& response) const;

  /// The x axis of curves over poses: the time on a trajectory, otherwise the number of the pose.
  Coordinate axis() const;
  /// A heat map with these rows, whose columns are the poses in the order of time or of any coordinate.
  HeatMap heat_map(std::vector<HeatLayer> layers, std::vector<std::string> rows, std::string order) const;
  /// Adds the condition number of each pose, if the result has it.
  void add_condition(std::vector<Field>& fields) const;
  Field not_converged(
      std::span<const double> shares) const;  ///< A field with the share of solves that did not converge, [M].
  /// Adds a map of the poses, coloured by these fields.
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

EstimateCourse with_ends(
    EstimateCourse course);  ///< The course with intervals, computed from half-widths if necessary.

/// The curve of the quantity at this position of [R x P], with its band, in units of `unit`.
Series series_of(const EstimateCourse& course, std::size_t at, double unit, std::string label, const std::string& array,
                 ArrayPool& pool);

/// The axis of the number of samples for such curves, without panels.
Lines over_samples(const EstimateCourse& course, ArrayPool& pool);

/// Adds a section on the uncertainty of quantities, which begins by explaining the intervals. heading: "How sure are
/// ...".
Section& add_how_sure(Page& page, std::string heading, double conf_level);

/// The limit of a response as marks in its distribution or curves; on both sides of zero if it has negative values.
/// Empty if the study does not limit it.
std::vector<Mark> limit_marks(const StoredResult& result, std::size_t response, bool has_negative);

/// A sentence for each limit, "gap keeps its limit of 12 mm with 3.05 mm.", or one on the yield; empty without limits.
std::string limits_text(const StoredResult& result);

/// Adds the section on the study's limits if it states any. tables: those of the result.
void add_limits(std::span<const Table> tables, Page& page);

/// Adds the first section, which describes the responses in words.
void add_responses(const StoredResult& result, Page& page);

/// Adds the section with the unit and the meaning of every error and every pose coordinate. Figures show these too if a
/// reader points at a name.
void add_glossary(const StoredResult& result, Page& page);

/// Adds the section on solves that did not converge: how solves ended, their numbers by row and pose, and the listed
/// failures with the commands that replay them.
void add_outcomes(const ReportKind& kind, const ReportedResult& result, Page& page);

/// Adds the section on what was run, of one result or of two side by side: differences first, and equal settings
/// folded.
void add_what_was_run(const ReportKind& kind, std::span<const ReportedResult> results, Page& page);

/// Adds a figure to a page and a place for it to a section.
void add_figure(Page& page, Section& section, const std::string& key, Figure figure, std::string_view caption);

/// A quantity that is compared between results, for R options and P items, in the units shown.
struct ComparableQuantity {
  std::string label;                            ///< for people
  std::string array;                            ///< prefix of the names of its arrays
  std::vector<std::vector<std::string>> units;  ///< [R] a list with one unit for all items, or with P units
  std::vector<double> value;                    ///< [R x P]
  std::vector<double> low = {};                 ///< [R x P] lower ends of intervals; empty if there are none
  std::vector<double> high = {};                ///< [R x P] upper ends of intervals; empty if there are none
};

/// The part of a result that can be compared with another one of its kind.
struct Comparable {
  std::string option_word;           ///< "response"
  std::vector<std::string> options;  ///< [R]
  std::string item_word;             ///< "error"
  std::vector<std::string> items;    ///< [P]
  /// Bars show all quantities. Ranks and the scatter plot use the first one, the table the last one.
  std::vector<ComparableQuantity> quantities = {};
  bool ranked = false;              ///< whether items are ordered by size
  std::string total_label = {};     ///< label of the totals; empty: there are none
  std::vector<double> totals = {};  ///< [R] a number for all items together, in the units shown
};

/// A Comparable without quantities, whose options are the responses in the order of response_order().
Comparable comparable_by_response(const StoredResult& result, std::string item_word, std::vector<std::string> items);

/// Adds a quantity in the unit of each response. value(response, item): SI.
void add_quantity(Comparable& to, const StoredResult& result, std::string label, std::string array,
                  const std::function<double(std::size_t, std::size_t)>& value);

/// The parts of two results with the same options and items, in the order of A.
struct Comparison {
  Comparable a;                     ///< the first result
  Comparable b;                     ///< the second result
  std::vector<std::string> only_a;  ///< items that only the first has
  std::vector<std::string> only_b;  ///< items that only the second has
};

/// Compares two results of this kind. Throws InputError if they have nothing in common.
Comparison comparison(const ReportKind& kind, const ReportedResult& a, const ReportedResult& b);

/// The tables of a comparison, one for each option.
std::vector<Table> comparison_tables(const Comparison& compared);

/// The summary of a comparison.
Answer comparison_answer(const Comparison& compared);

/// Adds sections with the figures and tables of a comparison to a page.
void add_comparison(const Comparison& compared, Page& page);

}  // namespace poesy
