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

  const std::map<std::string, std::vector<float>>& arrays() const { return arrays_; }

 private:
  std::map<std::string, std::vector<float>> arrays_;
};

/// Something that the reader may choose, with its options.
struct Choice {
  std::string label;
  std::vector<std::string> options;
};

/// What bars may show: S series, R options of the choice, P items.
struct BarQuantity {
  std::string label;
  std::vector<std::vector<std::string>> units;  ///< [R] of one for all items, or of P
  ArrayName value;                              ///< [S x R x P]
  ArrayName low = {};                           ///< likewise; none: without intervals
  ArrayName high = {};
};

/// Horizontal bars, the largest first where they are sorted.
struct Bars {
  std::vector<Choice> choices;
  std::vector<BarQuantity> quantities;
  std::vector<std::string> items;        ///< [P]
  std::vector<std::string> series = {};  ///< [S]; empty where S = 1
  bool sorted = true;
  bool log = false;
};

struct Coordinate {
  std::string name;
  std::string unit;
  ArrayName value;  ///< [M]
};

struct HeatLayer {
  std::string label;
  std::string unit;
  ArrayName value;  ///< [P x M]
};

/// P rows, M columns.
struct HeatMap {
  std::vector<HeatLayer> layers;
  std::vector<std::string> rows;
  std::string column_label;
  std::vector<Coordinate> coordinates;  ///< of the columns
  ArrayName numbers = {};               ///< [M] of the columns; none: they count from 0
  bool log = false;
};

/// What may colour M poses; with rows, one of P may be chosen.
struct Field {
  std::string label;
  std::string unit;
  ArrayName value;                     ///< [M], or [P x M]
  std::vector<std::string> rows = {};  ///< [P]
};

/// Poses as dots in their coordinates.
struct Workspace {
  std::vector<Coordinate> coordinates;
  std::vector<Field> fields;
  ArrayName numbers = {};  ///< [M] of the poses; none: they count from 0
};

/// A line over the K values of x.
struct Series {
  std::string label;
  ArrayName value;  ///< [K]
  ArrayName low = {};
  ArrayName high = {};
  std::string style = "solid";  ///< "solid", "dashed" or "dotted"
};

struct Panel {
  std::string label;
  std::string unit;
  std::vector<Series> series;
};

struct Lines {
  Coordinate x;
  std::vector<Panel> panels;
  bool log = false;      ///< of x
  std::size_t most = 8;  ///< series that are shown until the reader asks for more
};

/// Points with names: R options of the choice, P points.
struct Scatter {
  std::vector<Choice> choices;
  std::pair<std::string, ArrayName> x;  ///< label, [R x P]
  std::pair<std::string, ArrayName> y;
  std::vector<std::string> units;  ///< [R]
  std::vector<std::string> names;  ///< [P]
};

using Figure = std::variant<Bars, HeatMap, Workspace, Lines, Scatter>;

/// The figures of a document by their keys, and the numbers that they show.
struct FigureSet {
  std::map<std::string, Figure> figures;
  ArrayPool pool;
};

/// All of it as JSON that may stand in a script element of HTML: no "<" is in it. Arrays are little-endian 32-bit
/// floats in base64.
std::string figures_json(const FigureSet& set);

/// RFC 4648, with padding.
std::string base64(std::span<const std::byte> bytes);

}  // namespace poesy
