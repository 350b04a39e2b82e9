#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// Figures as plain values. Numbers are already in the unit shown; NaN is one that is not known. Nothing here knows a
/// mechanism or a kind of study, nor does what draws them (engine/report/html/web).
namespace poesy {

/// Name of an entry of an ArrayPool; empty: none.
using ArrayName = std::string;

/// Arrays of numbers by name, each kept once however many figures show it.
class ArrayPool {
 public:
  /// Keeps values / unit as 32-bit floats; infinities become NaN. Where the name is taken, what it names is kept: one
  /// name stands for one array. Returns the name.
  ArrayName add(const std::string& name, std::span<const double> values, double unit = 1.0);

  const std::map<std::string, std::vector<float>>& arrays() const { return arrays_; }  ///< By their names.

 private:
  std::map<std::string, std::vector<float>> arrays_;
};

/// Something that the reader may choose, with its options.
struct Choice {
  std::string label;                 ///< what is chosen
  std::vector<std::string> options;  ///< what there is to choose from
};

/// What bars may show: S series, R options of the choice, P items.
struct BarQuantity {
  std::string label;                            ///< for people
  std::vector<std::vector<std::string>> units;  ///< [R] of one for all items, or of P
  ArrayName value;                              ///< [S x R x P]
  ArrayName low = {};                           ///< likewise; none: without intervals
  ArrayName high = {};                          ///< upper ends of the intervals; empty where there are none
};

/// Horizontal bars, the largest first where they are sorted.
struct Bars {
  std::vector<Choice> choices;           ///< what the reader may choose between
  std::vector<BarQuantity> quantities;   ///< what a bar may show
  std::vector<std::string> items;        ///< [P]
  std::vector<std::string> series = {};  ///< [S]; empty where S = 1
  bool sorted = true;                    ///< largest first
};

/// An axis of a figure.
struct Coordinate {
  std::string name;  ///< for people
  std::string unit;  ///< of its numbers
  ArrayName value;   ///< [M]
};

/// One of the quantities that a map may show.
struct HeatLayer {
  std::string label;           ///< for people
  std::string unit;            ///< of its numbers
  ArrayName value;             ///< [P x M]
  bool signed_values = false;  ///< a difference: its colours meet at 0 whatever its values are
};

/// P rows, M columns.
struct HeatMap {
  std::vector<HeatLayer> layers;        ///< what the reader may choose between
  std::vector<std::string> rows;        ///< names, from above
  std::string column_label;             ///< what stands from left to right
  std::vector<Coordinate> coordinates;  ///< of the columns
  ArrayName numbers = {};               ///< [M] of the columns; none: they count from 0
  std::string order = {};  ///< how columns stand at first: a coordinate's name, or "|name|"; none: as they come
};

/// What may colour M poses; with rows, one of P may be chosen.
struct Field {
  std::string label;                   ///< for people
  std::string unit;                    ///< of its numbers
  ArrayName value;                     ///< [M], or [P x M]
  std::vector<std::string> rows = {};  ///< [P]
  bool signed_values = false;          ///< as of HeatLayer
};

/// Poses as dots in their coordinates.
struct WorkspaceMap {
  std::vector<Coordinate> coordinates;  ///< of the poses
  std::vector<Field> fields;            ///< what may be shown at them
  ArrayName numbers = {};               ///< [M] of the poses; none: they count from 0
};

/// A line over the K values of x.
struct Series {
  std::string label;            ///< for people
  ArrayName value;              ///< [K]
  ArrayName low = {};           ///< lower ends of the intervals; empty where there are none
  ArrayName high = {};          ///< upper ends, likewise
  std::string style = "solid";  ///< "solid", "dashed" or "dotted"
};

/// A value that is marked across a panel.
struct Mark {
  std::string label;        ///< for people
  double value;             ///< in the unit of its axis
  std::string beyond = {};  ///< "above" or "below": where a limit allows nothing; empty: on both sides it is as good
};

/// Curves over one axis.
struct Panel {
  std::string label;             ///< for people
  std::string unit;              ///< of its numbers
  std::vector<Series> series;    ///< the curves
  std::vector<Mark> marks = {};  ///< values of its own axis; one far beyond the curves is said and not drawn
};

/// Panels below one another, over the same axis.
struct Lines {
  Coordinate x;                  ///< of all panels
  std::vector<Panel> panels;     ///< from above
  bool log = false;              ///< of x
  std::size_t most = 8;          ///< series that are shown until the reader asks for more
  std::vector<Mark> marks = {};  ///< values of x, in every panel; may lie beyond those of the curves
};

/// Points with names: R options of the choice, P points.
struct Scatter {
  std::vector<Choice> choices;          ///< what the reader may choose between
  std::pair<std::string, ArrayName> x;  ///< label, [R x P]
  std::pair<std::string, ArrayName> y;  ///< label and values of the axis upwards
  std::vector<std::string> units;       ///< [R]
  std::vector<std::string> names;       ///< [P]
};

/// An error as a picture of the mechanism shows it.
struct PicturedError {
  std::string name;   ///< of the error
  std::string words;  ///< where it is, along or about which axis
  std::size_t frame;  ///< position among the frames of all limbs
  std::size_t axis;   ///< of the frame: 0, 1 or 2
  bool turns;         ///< about that axis
  std::string size;   ///< at which it is shown, with its unit; empty where it has none
  std::string share;  ///< with its unit; empty where it has none
};

/// A mechanism at K poses, which stands drawn in its figure and can be turned: L limbs hold its platform. Lengths in
/// mm, in the base frame.
struct Robot {
  double yaw;                              ///< at first, deg
  double pitch;                            ///< likewise
  double scale;                            ///< pixels for a millimetre
  std::vector<double> centre;              ///< [3] of the picture
  bool z_is_down;                          ///< whether y and z change their signs before it is turned
  std::vector<std::string> poses = {};     ///< [K] for people
  std::vector<PicturedError> errors = {};  ///< [E]
  ArrayName frames = {};                   ///< [K x frames x 12] origins, x, y and z axes
  std::size_t limbs = 0;                   ///< L
  /// [K x E x L x 6] how each limb moves the platform at the error's size, [rotation; displacement at the base's
  /// origin]; none: it is not known.
  ArrayName motions = {};
  double exaggeration = 1.0;  ///< by which motions are shown at first
};

using Figure = std::variant<Bars, HeatMap, WorkspaceMap, Lines, Scatter, Robot>;  ///< Any of them.

/// The figures of a document by their keys, and the numbers that they show.
struct FigureSet {
  std::map<std::string, std::string> about;  ///< what the names in figures mean, as far as that is known
  std::map<std::string, Figure> figures;     ///< by their names in the page
  ArrayPool pool;                            ///< the numbers behind them
};

/// All of it as JSON that may stand in a script element of HTML: no "<" is in it. Arrays are little-endian 32-bit
/// floats in base64.
std::string figures_json(const FigureSet& set);

std::string base64(std::span<const std::byte> bytes);  ///< RFC 4648, with padding.

}  // namespace poesy
