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

/// What the sections of all kinds of results share.
namespace poesy {

struct ReportKind;

/// A result and the file where it was found, as the reader may name it.
struct ReportedResult {
  StoredResult stored;                           ///< what it says
  std::string path;                              ///< where it was read from
  std::shared_ptr<const Model> model = nullptr;  ///< of the mechanism; null: it cannot be built again
};

/// The names at these positions.
std::vector<std::string> names_of(const std::vector<NamedUnit>& things, std::span<const std::size_t> positions);
/// The headline's responses, the one that ranks errors first (default_ranking), those that do not vary last.
std::vector<std::size_t> headline_order(const StoredResult& result);
/// All responses: those of the headline first, in that order, but whatever does not vary last.
std::vector<std::size_t> response_order(const StoredResult& result);

/// "mm", for each of these responses.
std::vector<std::vector<std::string>> response_units(const StoredResult& result,
                                                     std::span<const std::size_t> responses);
/// What a caption of bars says of the order of errors, whose units may be mixed.
std::string order_by_effect(bool mixed);
bool mixed_units(const std::vector<NamedUnit>& things);  ///< Whether not all have the same unit.

/// Which part of a result's cells goes into its figures, so that a report stays small.
struct ShownCells {
  /// Numbers of one figure: with more of them in all, responses that are not of the headline are left out, then poses.
  static constexpr std::size_t kMostWithAllResponses = 300'000;
  static constexpr std::size_t kMost = 600'000;         ///< Numbers that a page may hold.
  static constexpr std::size_t kMostInLayer = 400'000;  ///< Numbers that one layer may hold.

  std::vector<std::size_t> responses;  ///< positions
  std::vector<std::size_t> poses;      ///< ascending
  std::size_t all_responses = 0;       ///< of the result, shown or not
  std::size_t all_poses = 0;           ///< of the result, shown or not

  /// Of numbers at all poses, [rows x M], those at the poses that are shown.
  std::vector<double> at_poses(std::span<const double> values) const;
  bool thinned() const { return poses.size() < all_poses; }  ///< Whether not every pose is shown.
  std::string note() const;  ///< What is left out, in a sentence; empty where nothing is.
};

/// The numbers that figures by pose show of each response at each pose where they show summaries: mean or median,
/// quantiles and the like.
inline constexpr std::size_t kSummaryRows = 4;

/// The part of a result with so many numbers of each response at each pose. responses: those that have to be shown;
/// none: all, or the headline's.
ShownCells shown_cells(const StoredResult& result, std::size_t rows,
                       std::optional<std::vector<std::size_t>> responses = std::nullopt);

/// Makes the figures by pose of a result, of the cells shown. Refers to the result and the page.
class PoseFigures {
 public:
  PoseFigures(const StoredResult& result, ShownCells shown, Page& page);  ///< For one page.

  const std::vector<std::size_t>& responses() const { return shown_.responses; }  ///< Positions of the responses shown.
  void add_note(Section& section) const;  ///< Says in a section what is left out, if anything is.
  /// Adds values [rows x M] in units of `unit`, those at the poses shown.
  ArrayName add(const std::string& name, std::span<const double> values, double unit = 1.0) const;
  /// Adds values of a response, SI, in the unit shown.
  ArrayName add(const std::string& name, std::span<const double> values, const NamedUnit& response) const;

  /// What curves over poses have as their x: the time on a trajectory, else the number of the pose.
  Coordinate axis() const;
  /// A map of these rows whose columns are the poses, in the order of a trajectory's time or of any coordinate.
  HeatMap heat_map(std::vector<HeatLayer> layers, std::vector<std::string> rows, std::string order) const;
  /// Adds the condition number of each pose, where the result has it.
  void add_condition(std::vector<Field>& fields) const;
  Field not_converged(std::span<const double> shares) const;  ///< The share of solves that did not converge, [M].
  /// Adds poses as dots, coloured by these fields.
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

EstimateCourse with_ends(EstimateCourse course);  ///< With the ends of its intervals also where it states half-widths.

/// The curve of one quantity, at this position of [R x P], with its band, in units of `unit`.
Series series_of(const EstimateCourse& course, std::size_t at, double unit, std::string label, const std::string& array,
                 ArrayPool& pool);

/// The number of samples as the axis of such curves, and no panel yet.
Lines over_samples(const EstimateCourse& course, ArrayPool& pool);

/// The section that says how sure quantities are, begun with what their intervals are. heading: "How sure are ...".
Section& add_how_sure(Page& page, std::string heading, double conf_level);

/// The limit of a response as marks across its distribution or its curves; on both sides of zero if it has values below
/// zero. Empty where the study does not limit it.
std::vector<Mark> limit_marks(const StoredResult& result, std::size_t response, bool has_negative);

/// "gap keeps its limit of 12 mm with 3.05 mm.", for each limit, or what the yield is; empty where the study has none.
std::string limits_text(const StoredResult& result);

/// Adds the section on the study's limits, where it states any. tables: of the result.
void add_limits(std::span<const Table> tables, Page& page);

/// The section that comes first: what the responses are, in words.
void add_responses(const StoredResult& result, Page& page);

/// The section that has every error and every pose coordinate with its unit and what it is;
/// figures say it as well, where a reader points at a name.
void add_glossary(const StoredResult& result, Page& page);

/// The section that tells what was not solved: how solves ended, which rows and poses have how many that did not
/// converge, and the listed failures with the commands that replay them.
void add_outcomes(const ReportKind& kind, const ReportedResult& result, Page& page);

/// The section that tells what was run, of one result, or of two side by side: what differs, and folded what does not.
void add_what_was_run(const ReportKind& kind, std::span<const ReportedResult> results, Page& page);

inline constexpr std::string_view kLetters[] = {"A", "B"};  ///< "A" and "B" of two results.

/// Adds a figure to a page and its place to a section.
void add_figure(Page& page, Section& section, const std::string& key, Figure figure, std::string_view caption);

/// A quantity by which results are compared, for R options and P items, in the units shown.
struct ComparableQuantity {
  std::string label;                            ///< for people
  std::string array;                            ///< how its arrays are named
  std::vector<std::vector<std::string>> units;  ///< [R] of one for all items, or of P
  std::vector<double> value;                    ///< [R x P]
  std::vector<double> low = {};                 ///< [R x P] lower ends of intervals; empty where there are none
  std::vector<double> high = {};                ///< [R x P] upper ends, likewise
};

/// What a result offers to be compared with another one of its kind.
struct Comparable {
  std::string option_word;           ///< "response"
  std::vector<std::string> options;  ///< [R]
  std::string item_word;             ///< "error"
  std::vector<std::string> items;    ///< [P]
  /// Bars show all of them; the first gives ranks and the points against each other, the last the table.
  std::vector<ComparableQuantity> quantities = {};
  bool ranked = false;              ///< whether items have an order by size
  std::string total_label = {};     ///< what the totals are; empty: there are none
  std::vector<double> totals = {};  ///< [R] one number for all items together, in the units shown
};

/// A Comparable whose options are the responses, in the order of response_order, without quantities yet.
Comparable comparable_by_response(const StoredResult& result, std::string item_word, std::vector<std::string> items);

/// Adds a quantity in the unit shown of each response. value: SI, of (response, item).
void add_quantity(Comparable& to, const StoredResult& result, std::string label, std::string array,
                  const std::function<double(std::size_t, std::size_t)>& value);

/// What two results say of the same options and items, in the order of A.
struct Comparison {
  Comparable a;                     ///< of the first result
  Comparable b;                     ///< of the second
  std::vector<std::string> only_a;  ///< items of the first alone
  std::vector<std::string> only_b;  ///< items of the second alone
};

/// What there is to compare of two results of this kind and one mechanism. Throws InputError where they have nothing in
/// common.
Comparison comparison(const ReportKind& kind, const ReportedResult& a, const ReportedResult& b);

/// What a comparison says first.
Answer comparison_answer(const Comparison& compared);

/// Adds figures and tables of a comparison to a page, as sections.
void add_comparison(const Comparison& compared, Page& page);

}  // namespace poesy
