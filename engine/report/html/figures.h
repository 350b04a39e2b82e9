#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// Figures as plain values. Numbers are in the unit shown; NaN means not known. Neither this code nor the script that
/// draws the figures (engine/report/html/web) knows mechanisms or kinds of study.
namespace poesy {

/// The name of an entry of an ArrayPool; empty: none.
using ArrayName = std::string;

/// Arrays of numbers by name. Each is stored once, however many figures show it.
class ArrayPool {
 public:
  /// Stores values / unit as 32-bit floats; infinities become NaN. If the name exists, its array is kept, because equal
  /// names mean equal arrays. Returns the name.
  ArrayName add(const std::string& name, std::span<const double> values, double unit = 1.0);

  const std::map<std::string, std::vector<float>>& arrays() const { return arrays_; }  ///< The arrays by their names.

 private:
  std::map<std::string, std::vector<float>> arrays_;
};

/// A choice that the reader has, with its options.
struct Choice {
  std::string label;                 ///< what is chosen
  std::vector<std::string> options;  ///< what there is to choose from
};

/// A quantity that bars may show: S series, R options of the choice, P items.
struct BarQuantity {
  std::string label;                            ///< for people
  std::vector<std::vector<std::string>> units;  ///< [R] a list with one unit for all items, or with P units
  ArrayName value;                              ///< [S x R x P]
  ArrayName low = {};                           ///< [S x R x P] lower ends of the intervals; empty if there are none
  ArrayName high = {};                          ///< [S x R x P] upper ends of the intervals; empty if there are none
};

/// Horizontal bars.
struct Bars {
  std::vector<Choice> choices;           ///< choices of the reader
  std::vector<BarQuantity> quantities;   ///< quantities that bars may show
  std::vector<std::string> items;        ///< [P]
  std::vector<std::string> series = {};  ///< [S]; empty if S = 1
  bool sorted = true;                    ///< whether the largest bar comes first
};

/// An axis of a figure.
struct Coordinate {
  std::string name;  ///< for people
  std::string unit;  ///< unit of its values
  ArrayName value;   ///< [M]
};

/// One of the quantities that a heat map may show.
struct HeatLayer {
  std::string label;           ///< for people
  std::string unit;            ///< unit of its values
  ArrayName value;             ///< [P x M]
  bool signed_values = false;  ///< whether values are differences; colours are then centred at 0
};

/// A heat map with P rows and M columns.
struct HeatMap {
  std::vector<HeatLayer> layers;        ///< layers from which the reader chooses
  std::vector<std::string> rows;        ///< names of the rows, from top to bottom
  std::string column_label;             ///< label of the columns
  std::vector<Coordinate> coordinates;  ///< coordinates of the columns
  ArrayName numbers = {};               ///< [M] numbers of the columns; empty: counted from 0
  std::string order = {};  ///< first order of the columns: a coordinate's name, or "|name|"; empty: as they are stored
};

/// A quantity that may colour M poses. If it has rows, the reader chooses one of P.
struct Field {
  std::string label;                   ///< for people
  std::string unit;                    ///< unit of its values
  ArrayName value;                     ///< [M], or [P x M]
  std::vector<std::string> rows = {};  ///< [P]
  bool signed_values = false;          ///< whether values are differences; see HeatLayer
};

/// A map that shows poses as dots at their coordinates.
struct WorkspaceMap {
  std::vector<Coordinate> coordinates;  ///< of the poses
  std::vector<Field> fields;            ///< quantities that may colour them
  ArrayName numbers = {};               ///< [M] numbers of the poses; empty: counted from 0
};

/// A curve over the K values of x.
struct Series {
  std::string label;            ///< for people
  ArrayName value;              ///< [K]
  ArrayName low = {};           ///< [K] lower ends of the intervals; empty if there are none
  ArrayName high = {};          ///< [K] upper ends of the intervals; empty if there are none
  std::string style = "solid";  ///< "solid", "dashed" or "dotted"
};

/// A marked value, drawn across a panel.
struct Mark {
  std::string label;        ///< for people
  double value;             ///< in the unit of its axis
  std::string beyond = {};  ///< "above" or "below": the side that a limit forbids; empty: neither
};

/// Curves with a common axis.
struct Panel {
  std::string label;             ///< for people
  std::string unit;              ///< unit of its values
  std::vector<Series> series;    ///< the curves
  std::vector<Mark> marks = {};  ///< marked values; one far beyond the curves is mentioned instead of drawn
};

/// Panels one below the other, over the same x axis.
struct Lines {
  Coordinate x;                  ///< of all panels
  std::vector<Panel> panels;     ///< from top to bottom
  bool log = false;              ///< whether the x axis is logarithmic
  std::size_t most = 8;          ///< number of curves that are shown at first
  std::vector<Mark> marks = {};  ///< marked values of x, in every panel; they may be beyond the curves
};

/// Named points: R options of the choice, P points.
struct Scatter {
  std::vector<Choice> choices;          ///< choices of the reader
  std::pair<std::string, ArrayName> x;  ///< label and values [R x P] of the horizontal axis
  std::pair<std::string, ArrayName> y;  ///< label and values [R x P] of the vertical axis
  std::vector<std::string> units;       ///< [R]
  std::vector<std::string> names;       ///< [P]
};

/// An error in a picture of the mechanism.
struct PicturedError {
  std::string name;   ///< name of the error
  std::string words;  ///< its place, and its axis
  std::size_t frame;  ///< position among the frames of all limbs
  std::size_t axis;   ///< of the frame: 0, 1 or 2
  bool turns;         ///< whether it is a rotation about that axis
  std::string size;   ///< size at which it is shown, with its unit; empty if it has none
  std::string share;  ///< share with its unit; empty if it has none
};

/// A mechanism at K poses, drawn as a picture that can be turned. L limbs hold its platform. Lengths are in mm, in the
/// base frame.
struct Robot {
  double yaw;                              ///< first yaw angle, deg
  double pitch;                            ///< first pitch angle, deg
  double scale;                            ///< pixels per millimetre
  std::vector<double> centre;              ///< [3] centre of the picture
  bool z_is_down;                          ///< whether y and z change their signs before the picture is turned
  std::vector<std::string> poses = {};     ///< [K] names of the poses
  std::vector<PicturedError> errors = {};  ///< [E]
  ArrayName frames = {};                   ///< [K x frames x 12] origins, x, y and z axes
  std::size_t limbs = 0;                   ///< L
  /// [K x E x L x 6] The motion of the platform by each limb for an error of its size, [rotation; displacement at the
  /// base's origin]; empty if not known.
  ArrayName motions = {};
  double exaggeration = 1.0;  ///< initial factor by which motions are enlarged
};

using Figure = std::variant<Bars, HeatMap, WorkspaceMap, Lines, Scatter, Robot>;  ///< Any kind of figure.

/// The figures of a document by their keys, and their numbers.
struct FigureSet {
  std::map<std::string, std::string> about;  ///< explanations of names in the figures, as far as known
  std::map<std::string, Figure> figures;     ///< by their keys in the page
  ArrayPool pool;                            ///< numbers of all figures
};

/// The figure set as JSON for a script element of HTML: it has no "<". Arrays are little-endian 32-bit floats in
/// base64.
std::string figures_json(const FigureSet& set);

std::string base64(std::span<const std::byte> bytes);  ///< RFC 4648, with padding.

}  // namespace poesy
