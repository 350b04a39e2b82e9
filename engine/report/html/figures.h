#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// Figures as plain values. Numbers are in the unit shown; NaN means not known. The files here and the script that
/// draws the figures (engine/report/html/web) know neither mechanisms nor kinds of study.
namespace poesy {

/// The name of an array in an ArrayPool; empty: no array.
using ArrayName = std::string;

/// Arrays of numbers by name. Each array is stored once, however many figures show it.
class ArrayPool {
 public:
  /// Stores values / unit as 32-bit floats; infinities become NaN. If the name exists, its array is kept, because equal
  /// names must mean equal arrays. Returns the name.
  ArrayName add(const std::string& name, std::span<const double> values, double unit = 1.0);

  const std::map<std::string, std::vector<float>>& arrays() const { return arrays_; }  ///< The arrays by their names.

 private:
  std::map<std::string, std::vector<float>> arrays_;
};

/// A choice that the reader of a figure has.
struct Choice {
  std::string label;                 ///< label of the choice
  std::vector<std::string> options;  ///< options from which the reader chooses
};

/// A quantity that bars may show: values for S series, R options of the choices and P items.
struct BarQuantity {
  std::string label;                            ///< label for people
  std::vector<std::vector<std::string>> units;  ///< [R] a list with one unit for all items, or with P units
  ArrayName value;                              ///< [S x R x P] values
  ArrayName low = {};                           ///< [S x R x P] lower ends of the intervals; empty if there are none
  ArrayName high = {};                          ///< [S x R x P] upper ends of the intervals; empty if there are none
};

/// A figure of horizontal bars.
struct Bars {
  std::vector<Choice> choices;           ///< choices, whose options together number R
  std::vector<BarQuantity> quantities;   ///< quantities that bars may show
  std::vector<std::string> items;        ///< [P] names of the items
  std::vector<std::string> series = {};  ///< [S] names of the series; empty if S = 1
  bool sorted = true;                    ///< true if the largest bar comes first
};

/// An axis of a figure.
struct Coordinate {
  std::string name;  ///< name of the axis for people
  std::string unit;  ///< unit of the values
  ArrayName value;   ///< [M] values at the M columns, poses or points of the figure
};

/// A quantity that a heat map may show.
struct HeatLayer {
  std::string label;           ///< label for people
  std::string unit;            ///< unit of the values
  ArrayName value;             ///< [P x M] values
  bool signed_values = false;  ///< true if values are differences; colours are then centred at 0
};

/// A heat map with P rows and M columns.
struct HeatMap {
  std::vector<HeatLayer> layers;        ///< quantities from which the reader chooses
  std::vector<std::string> rows;        ///< names of the rows, from top to bottom
  std::string column_label;             ///< label of the columns
  std::vector<Coordinate> coordinates;  ///< coordinates of the columns
  ArrayName numbers = {};               ///< [M] numbers of the columns; empty: they are counted from 0
  /// Order of the columns at first: a coordinate's name, or "|name|" for its magnitude; empty: order of the arrays.
  std::string order = {};
};

/// A quantity that may colour the dots of M poses. If it has P rows of values, the reader chooses one row.
struct Field {
  std::string label;                   ///< label for people
  std::string unit;                    ///< unit of the values
  ArrayName value;                     ///< [M] values, or [P x M] values by row
  std::vector<std::string> rows = {};  ///< [P] names of the rows; empty: there is only one
  bool signed_values = false;          ///< true if values are differences; see HeatLayer
};

/// A map that shows poses as dots at their coordinates.
struct WorkspaceMap {
  std::vector<Coordinate> coordinates;  ///< coordinates of the poses
  std::vector<Field> fields;            ///< quantities that may colour the poses
  ArrayName numbers = {};               ///< [M] numbers of the poses; empty: they are counted from 0
};

/// A curve with K points, one at each value of the x axis.
struct Series {
  std::string label;            ///< label for people
  ArrayName value;              ///< [K] values
  ArrayName low = {};           ///< [K] lower ends of the intervals; empty if there are none
  ArrayName high = {};          ///< [K] upper ends of the intervals; empty if there are none
  std::string style = "solid";  ///< "solid", "dashed" or "dotted"
};

/// A value that is marked by a line across a panel.
struct Mark {
  std::string label;        ///< label for people
  double value;             ///< value in the unit of its axis
  std::string beyond = {};  ///< side that a limit forbids, "above" or "below"; empty: the mark is not a limit
};

/// Curves that share a y axis.
struct Panel {
  std::string label;           ///< label for people
  std::string unit;            ///< unit of the values
  std::vector<Series> series;  ///< curves of the panel
  /// Marked values of the y axis; a value far beyond the curves is mentioned instead of drawn.
  std::vector<Mark> marks = {};
};

/// Panels one below the other, over the same x axis.
struct Lines {
  Coordinate x;               ///< x axis of all panels
  std::vector<Panel> panels;  ///< panels from top to bottom
  bool log = false;           ///< true if the x axis is logarithmic
  std::size_t most = 8;       ///< largest number of curves that are shown at first
  /// Marked values of the x axis, drawn in every panel; they may be beyond the curves.
  std::vector<Mark> marks = {};
};

/// A scatter plot of P named points, for R options of the choices.
struct Scatter {
  std::vector<Choice> choices;          ///< choices, whose options together number R
  std::pair<std::string, ArrayName> x;  ///< label and values [R x P] of the horizontal axis
  std::pair<std::string, ArrayName> y;  ///< label and values [R x P] of the vertical axis
  std::vector<std::string> units;       ///< [R] unit of both axes
  std::vector<std::string> names;       ///< [P] names of the points
};

/// An error in a picture of the mechanism.
struct PicturedError {
  std::string name;   ///< name of the error
  std::string words;  ///< place and axis of the error, in words
  std::size_t frame;  ///< index of its frame among the frames of all limbs
  std::size_t axis;   ///< axis of the frame: 0, 1 or 2 for x, y or z
  bool turns;         ///< true if the error is a rotation about the axis, false if it is a displacement along it
  std::string size;   ///< size for which its effect is shown, with the unit; empty if it has none
  std::string share;  ///< the error's share (ErrorShares) as text with its unit; empty if it has none
};

/// A picture of a mechanism at K poses that the reader can turn. L limbs hold the platform; F frames and E errors are
/// shown. Lengths are in mm, in the base frame.
struct Robot {
  double yaw;                              ///< first yaw angle, deg
  double pitch;                            ///< first pitch angle, deg
  double scale;                            ///< pixels per millimetre
  std::vector<double> centre;              ///< [3] point in the middle of the picture
  bool z_is_down;                          ///< true if y and z change their signs before the picture is turned
  std::vector<std::string> poses = {};     ///< [K] names of the poses
  std::vector<PicturedError> errors = {};  ///< [E] errors that the reader can choose
  ArrayName frames = {};                   ///< [K x F x 12] origin, x, y and z axis of each frame
  std::size_t limbs = 0;                   ///< number of limbs, L
  /// [K x E x L x 6] The motion of the platform by each limb if an error has its size, [rotation; displacement at the
  /// base's origin]; empty if not known.
  ArrayName motions = {};
  double exaggeration = 1.0;  ///< initial factor by which motions are enlarged
};

/// A size of an error or of a tolerance, as a slider shows it.
struct WhatIfSize {
  std::string label;  ///< what the size is: "sigma"
  double value;       ///< size in its unit
  std::string unit;   ///< unit: "mm"
};

/// A slider that multiplies the sizes of some errors by a factor.
struct WhatIfSlider {
  std::string name;                 ///< name of the error, the feature or the part
  std::vector<WhatIfSize> sizes;    ///< sizes in the study
  std::vector<std::size_t> errors;  ///< indices among the E errors of WhatIf
  std::vector<double> costs = {};   ///< cost at each of WhatIf::factors; empty: no cost is stated
};

/// A limit on a component with its sign, or on the norm of several components.
struct WhatIfLimit {
  std::size_t components;  ///< number of components, 1 or more
  double low;              ///< lower end in the unit of the components; minus infinity for none
  double high;             ///< upper end in the unit of the components; infinity for none
};

/// Data by which a page predicts the yield of machines whose errors have other sizes than in the study. There are B
/// machines at K poses. The limited responses have C components, which are taken to change linearly with E errors.
struct WhatIf {
  std::vector<double> factors;        ///< factors to which a slider can be set, ascending; 1 is one of them
  std::vector<WhatIfSlider> sliders;  ///< sliders that the reader moves
  /// Limits; each takes as many of the C components as it has, one limit after the other.
  std::vector<WhatIfLimit> limits;
  std::size_t machines = 0;   ///< number of machines, B
  std::size_t poses = 0;      ///< number of poses, K
  ArrayName components = {};  ///< [K x C x B] components at the study's sizes; NaN if a machine is not solved
  ArrayName deviations = {};  ///< [E x B] deviations of the errors from their means
  ArrayName slopes = {};      ///< [K x C x E] derivatives of the components by the errors
  double yield = 0.0;         ///< yield of the study
  double yield_low = 0.0;     ///< lower end of the interval of the study's yield
  double yield_high = 0.0;    ///< upper end of the interval of the study's yield
  double quantile = 0.0;      ///< standard normal quantile that belongs to the level of the intervals
  double linear_error = 0.0;  ///< error of a machine's predicted distance to its limit if all sizes change by 100 %
  double missed = 0.0;  ///< share of machines that are rejected only by poses not shown here, or that are not solved
  double other_costs = 0.0;  ///< cost of the parts that no slider changes
};

using Figure = std::variant<Bars, HeatMap, WorkspaceMap, Lines, Scatter, Robot, WhatIf>;  ///< Any kind of figure.

/// The figures of a document, and the arrays of their numbers.
struct FigureSet {
  std::map<std::string, std::string> about;  ///< explanations of names that appear in figures, as far as known
  std::map<std::string, Figure> figures;     ///< figures by their keys in the page
  ArrayPool pool;                            ///< numbers of all figures
};

/// The figure set as JSON for a script element of HTML, without "<". Arrays are little-endian 32-bit floats in base64.
std::string figures_json(const FigureSet& set);

std::string base64(std::span<const std::byte> bytes);  ///< Bytes as base64 (RFC 4648, with padding).

}  // namespace poesy
