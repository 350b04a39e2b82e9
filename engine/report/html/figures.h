#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// Figures as plain values. Numbers are in the unit that the figure shows; NaN means that a number is not known.
/// Neither this file nor the script that draws the figures (engine/report/html/web) depends on models of mechanisms or
/// on kinds of study.
namespace poesy {

/// The name of an array in an ArrayPool; empty: no array.
using ArrayName = std::string;

/// Arrays of numbers by name. Each array is stored once, however many figures show it.
class ArrayPool {
 public:
  /// Stores values / unit as 32-bit floats; infinities become NaN. If the pool already has an array of this name, that
  /// array stays, because equal names must mean equal arrays. Returns the name.
  ArrayName add(const std::string& name, std::span<const double> values, double unit = 1.0);

  const std::map<std::string, std::vector<float>>& arrays() const { return arrays_; }  ///< The arrays by their names.

 private:
  std::map<std::string, std::vector<float>> arrays_;
};

/// A choice between options, which the reader of a figure makes.
struct Choice {
  std::string label;                 ///< label of the choice
  std::vector<std::string> options;  ///< options from which the reader chooses
};

/// A quantity that bars may show. It has a value for each series, each combination of options of Bars::choices, and
/// each item.
struct BarQuantity {
  std::string label;  ///< label for people
  /// [combinations of options] The units of the values: a list with one unit for all items, or with one for each item.
  std::vector<std::vector<std::string>> units;
  ArrayName value;      ///< [series x combinations of options x items] values
  ArrayName low = {};   ///< lower ends of the intervals of `value`; empty if there are none
  ArrayName high = {};  ///< upper ends of the intervals of `value`; empty if there are none
};

/// A figure of horizontal bars. A reader chooses a quantity and an option of each choice, and sees a bar for each
/// series and item.
struct Bars {
  std::vector<Choice> choices;           ///< choices of the reader
  std::vector<BarQuantity> quantities;   ///< quantities that bars may show
  std::vector<std::string> items;        ///< names of the items
  std::vector<std::string> series = {};  ///< names of the series; empty if there is only one
  bool by_first = false;  ///< true: items are sorted by their bar of the first series, false: by their largest bar
};

/// An axis of a figure, with a value for each column, pose or point of the figure.
struct Coordinate {
  std::string name;  ///< name of the axis for people
  std::string unit;  ///< unit of the values
  ArrayName value;   ///< values, one for each column, pose or point
};

/// A quantity that a heat map may show.
struct HeatLayer {
  std::string label;           ///< label for people
  std::string unit;            ///< unit of the values
  ArrayName value;             ///< [rows x columns] values
  bool signed_values = false;  ///< true if values are differences, so that colours are centred at 0
};

/// A heat map.
struct HeatMap {
  std::vector<HeatLayer> layers;        ///< quantities from which the reader chooses
  std::vector<std::string> rows;        ///< names of the rows, from top to bottom
  std::string column_label;             ///< label of the columns
  std::vector<Coordinate> coordinates;  ///< coordinates of the columns
  ArrayName numbers = {};               ///< numbers of the columns; empty: 0, 1, 2, ...
  /// Initial order of the columns: a coordinate's name, or "|name|" for the coordinate's magnitude; empty: order of the
  /// arrays.
  std::string order = {};
};

/// A quantity that may colour the dots of poses. If it has several rows of values, the reader chooses one of the rows.
struct Field {
  std::string label;                   ///< label for people
  std::string unit;                    ///< unit of the values
  ArrayName value;                     ///< [poses] or [rows x poses] values
  std::vector<std::string> rows = {};  ///< names of the rows; empty: there is only one
  bool signed_values = false;          ///< true if values are differences; see HeatLayer
};

/// A map that shows poses as dots at their coordinates.
struct WorkspaceMap {
  std::vector<Coordinate> coordinates;  ///< coordinates of the poses
  std::vector<Field> fields;            ///< quantities that may colour the poses
  ArrayName numbers = {};               ///< numbers of the poses; empty: 0, 1, 2, ...
};

/// A curve with a point at each value of the x axis.
struct Series {
  std::string label;            ///< label for people
  ArrayName value;              ///< values at the points
  ArrayName low = {};           ///< lower ends of the intervals of `value`; empty if there are none
  ArrayName high = {};          ///< upper ends of the intervals of `value`; empty if there are none
  std::string style = "solid";  ///< "solid", "dashed" or "dotted"
};

/// A value that is marked by a line across a panel.
struct Mark {
  std::string label;        ///< label for people
  double value;             ///< marked value in the unit of the axis
  std::string beyond = {};  ///< side that a limit forbids, "above" or "below"; empty: not a limit
};

/// Curves that share a y axis.
struct Panel {
  std::string label;           ///< label for people
  std::string unit;            ///< unit of the values
  std::vector<Series> series;  ///< curves of the panel
  /// Marked values of the y axis; a value far beyond the curves is written as text instead.
  std::vector<Mark> marks = {};
};

/// Panels one below the other, with the same x axis.
struct Lines {
  Coordinate x;               ///< x axis of all panels
  std::vector<Panel> panels;  ///< panels from top to bottom
  bool log = false;           ///< true if the x axis is logarithmic
  std::size_t most = 8;       ///< largest number of curves that are shown at first
  /// Marked values of the x axis, drawn in every panel even if they are beyond the curves.
  std::vector<Mark> marks = {};
};

/// A scatter plot of named points. A reader chooses an option of each choice.
struct Scatter {
  std::vector<Choice> choices;          ///< choices of the reader
  std::pair<std::string, ArrayName> x;  ///< label and values [combinations of options x points] of the horizontal axis
  std::pair<std::string, ArrayName> y;  ///< label and values [combinations of options x points] of the vertical axis
  std::vector<std::string> units;       ///< unit of both axes, for each combination of options
  std::vector<std::string> names;       ///< names of the points
};

/// An error in a picture of the mechanism.
struct PicturedError {
  std::string name;   ///< name of the error
  std::string words;  ///< place and axis of the error, in words
  std::size_t frame;  ///< index of the error's frame among the frames of all limbs
  std::size_t axis;   ///< axis of the frame: 0, 1 or 2 for x, y or z
  bool turns;         ///< true if the error is a rotation about the axis, false if it is a displacement along it
  bool is_own;        ///< true if the frame is the error's own (SketchedError::own), of which only z is shown
  std::string size;   ///< size of the error in the figure, with the unit; empty if it is not known
  std::string share;  ///< share of the error (ErrorShares) as text with the unit; empty if there are no shares
};

/// A picture of a mechanism at some poses. The reader can turn it, and choose the pose and an error. Lengths are in mm,
/// in the base frame.
struct Robot {
  double yaw;                              ///< yaw angle at first, deg
  double pitch;                            ///< pitch angle at first, deg
  double scale;                            ///< pixels per millimetre
  std::vector<double> centre;              ///< point in the middle of the picture: x, y, z
  bool z_is_down;                          ///< true if y and z change their signs before the picture is turned
  std::vector<std::string> poses = {};     ///< names of the poses
  std::vector<PicturedError> errors = {};  ///< errors that the reader can choose
  ArrayName frames = {};                   ///< [poses x frames x 12] origin, x, y and z axis of each frame
  std::size_t limbs = 0;                   ///< number of limbs
  /// [poses x errors x limbs x 6] The motion of the end of each limb if the error has the size that is shown: rotation
  /// (rad), and displacement at the base's origin (mm). Empty if the motions are not known.
  ArrayName motions = {};
  double exaggeration = 1.0;  ///< initial factor by which motions are enlarged
};

/// A size of an error or of a tolerance, as a slider shows it.
struct WhatIfSize {
  std::string label;  ///< what the size is: "sigma"
  double value;       ///< size in `unit`
  std::string unit;   ///< unit: "mm"
};

/// A slider that multiplies the sizes of some errors by one of WhatIf::factors.
struct WhatIfSlider {
  std::string name;                 ///< name of the error, the feature or the part
  std::vector<WhatIfSize> sizes;    ///< sizes in the study
  std::vector<std::size_t> errors;  ///< indices of the errors in WhatIf::deviations
  std::vector<double> costs = {};   ///< cost at each of WhatIf::factors; empty: the study states no cost
};

/// A limit on a component with its sign, or on the norm of several components.
struct WhatIfLimit {
  std::size_t components;  ///< number of components, 1 or more
  double low;              ///< lower end in the unit of the components; minus infinity if there is none
  double high;             ///< upper end in the unit of the components; infinity if there is none
};

/// Data from which a page predicts the yield of machines if their errors have other sizes than in the study. The
/// machines were solved at some of the study's poses. The limits are on components of responses, which are assumed to
/// change linearly with the errors.
struct WhatIf {
  std::vector<double> factors;        ///< factors from which a slider chooses, ascending; one of them is 1
  std::vector<WhatIfSlider> sliders;  ///< sliders that the reader moves
  /// Limits on the components. The first limit is on the first WhatIfLimit::components of them, the second limit on the
  /// next ones, and so on.
  std::vector<WhatIfLimit> limits;
  std::size_t machines = 0;  ///< number of machines
  std::size_t poses = 0;     ///< number of poses
  /// [poses x components x machines] Values of the components if the errors have the study's sizes; NaN if a machine is
  /// not solved.
  ArrayName components = {};
  ArrayName deviations = {};  ///< [errors x machines] deviations of the errors from their means at the study's sizes
  ArrayName slopes = {};      ///< [poses x components x errors] derivatives of the components by the errors
  double yield = 0.0;         ///< yield of the study, 0 to 1
  double yield_low = 0.0;     ///< lower end of the interval of the study's yield
  double yield_high = 0.0;    ///< upper end of the interval of the study's yield
  double quantile = 0.0;      ///< standard normal quantile for the confidence level of the intervals
  /// Estimated error of a linearly predicted component if all sizes of errors change by 100 %, as a share of its limit.
  /// The error of smaller changes is proportional to the change.
  double linear_error = 0.0;
  /// Share of machines that the prediction judges to be good although the study rejects them at a pose that is not in
  /// `components`, or although they cannot be solved at other sizes of errors.
  double missed = 0.0;
  double other_costs = 0.0;  ///< cost of the parts that have no slider
};

using Figure = std::variant<Bars, HeatMap, WorkspaceMap, Lines, Scatter, Robot, WhatIf>;  ///< Any kind of figure.

/// The figures of a document, and the arrays of their numbers.
struct FigureSet {
  std::map<std::string, std::string> about;  ///< explanations of names that appear in figures; not every name has one
  std::map<std::string, Figure> figures;     ///< figures by their keys in the page
  ArrayPool pool;                            ///< numbers of all figures
};

/// The figure set as JSON for a script element of HTML; the text contains no "<". Arrays are little-endian 32-bit
/// floats in base64.
std::string figures_json(const FigureSet& set);

std::string base64(std::span<const std::byte> bytes);  ///< Bytes as base64 (RFC 4648, with padding).

}  // namespace poesy
