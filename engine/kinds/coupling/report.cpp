#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <span>

#include "engine/kinds/coupling/coupling.h"
#include "engine/kinds/coupling/kind.h"
#include "engine/report/display.h"
#include "engine/report/tables.h"

namespace poesy::coupling {
namespace {

Cell place_cell(const StoredResult& result, bool known, std::int64_t pose) {
  return text_cell(known ? coordinates_text(result, static_cast<std::size_t>(pose)) : std::string());
}

Cell pose_cell(bool known, std::int64_t pose) {
  return known ? count_cell(static_cast<std::uint64_t>(pose)) : text_cell("");
}

std::vector<Cell> subset_row(const StoredResult& result, std::size_t r, std::size_t z, std::size_t k) {
  const Result& found = coupling_of(result);
  const double rounding = found.rounding(r, z);
  const auto cell = [&](double value) {
    Cell shown = number_cell(value / display(result.responses[r]).si, 5);
    if (value <= rounding) shown.text = "0";
    return shown;
  };
  const bool opposed = found.cancellation_max(r, z, k) > 0.0;
  const bool acts = found.effect_max(r, z, k) > rounding;
  return {text_cell(found.subsets[k]),
          cell(found.effect_max(r, z, k)),
          pose_cell(acts, found.effect_max_pose(r, z, k)),
          place_cell(result, acts, found.effect_max_pose(r, z, k)),
          cell(found.root_sum_square_max(r, z, k)),
          cell(found.first_order_sum_max(r, z, k)),
          has_worst_cases(found) ? cell(found.worst_case_max(r, z, k)) : text_cell(""),
          cell(found.interaction_max(r, z, k)),
          opposed ? percent_cell(found.opposed_share(r, z, k)) : text_cell(""),
          opposed ? percent_cell(found.cancellation_max(r, z, k)) : text_cell(""),
          pose_cell(opposed, found.cancellation_max_pose(r, z, k)),
          place_cell(result, opposed, found.cancellation_max_pose(r, z, k))};
}

/// The errors that are not zero, with their signs: "+leg_1 -leg_2".
std::string corner_text(const StoredResult& result, std::span<const std::int64_t> signs) {
  constexpr std::size_t kMost = 12;
  std::vector<std::string> names;
  for (std::size_t p = 0; p < result.factors.size(); ++p) {
    if (signs[p] != 0) names.push_back((signs[p] > 0 ? "+" : "-") + result.factors[p].name);
  }
  return some_names(names, kMost);
}

/// A text on the worst case of all sources together, with its pose and the signs of the errors; empty if no worst case
/// was found, or if it is only rounding.
std::string worst_corner_text(const StoredResult& result, std::size_t z, std::size_t r) {
  const Result& found = coupling_of(result);
  const std::size_t all = found.subsets.size() - 1;
  if (!has_worst_cases(found) || !(found.worst_case_max(r, z, all) > found.rounding(r, z))) return {};
  return fmt::format("worst case of {}: {}, with {}", found.subsets.back(),
                     place_text(result, static_cast<std::size_t>(found.worst_case_max_pose(r, z, all))),
                     corner_text(result, found.worst_case_signs.row(r, z, all)));
}

/// A text on the number of corners without a solution, and on the first such corner; empty if there is none.
std::string unsolved_text(const StoredResult& result) {
  const Result& found = coupling_of(result);
  const auto sum = [](const auto& counts) { return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}); };
  const auto first = std::ranges::find_if(found.unsolved_pose, [](std::int64_t pose) { return pose >= 0; });
  if (first == found.unsolved_pose.end()) return {};
  const auto [z, k] = found.unsolved_pose.positions(static_cast<std::size_t>(first - found.unsolved_pose.begin()));
  return fmt::format(
      "{} of the {} combinations of signs that were tried have no solution, so worst cases are of the others; the "
      "first: {} of {}, {}, with {}",
      count_text(sum(found.unsolved_corners)), count_text(sum(found.corners)), found.size_names[z], found.subsets[k],
      place_text(result, static_cast<std::size_t>(*first)), corner_text(result, found.unsolved_signs.row(z, k)));
}

Table response_table(const StoredResult& result, std::size_t z, std::size_t r) {
  const Result& found = coupling_of(result);
  const NamedUnit& response = result.responses[r];
  const std::string_view unit = display(response).name;
  Table table{
      .name = fmt::format("coupling_{}_{}", z + 1, response.name),
      .caption = fmt::format("{}: {} [{}]", found.size_names[z], response.name, unit),
      .columns = {
          text_column("subset", "subset"), number_column("effect_max", "largest effect", unit),
          number_column("effect_max_pose", "at pose", "", 1), text_column("effect_max_where", "largest where", 4),
          number_column("root_sum_square_max", "root sum square", unit),
          number_column("first_order_sum_max", "first-order sum", unit, 1),
          number_column("worst_case_max", "worst case", unit), number_column("interaction_max", "interaction", unit),
          percent_column("opposed_share", "opposed", 3), percent_column("cancellation_max", "cancellation", 2),
          number_column("cancellation_max_pose", "at pose", "", 2),
          text_column("cancellation_max_where", "cancelled where", 4)}};
  for (std::size_t k = 0; k < found.subsets.size(); ++k) table.rows.push_back(subset_row(result, r, z, k));
  if (!varies(result, r)) {
    table.notes.push_back(response.name + " does not vary: no source moves it by more than the rounding of solves");
  }
  if (std::string text = worst_corner_text(result, z, r); !text.empty()) table.notes.push_back(std::move(text));
  return table;
}

/// Whether, for some response of the summary, the effect of this source alone is only rounding at all poses and sizes.
bool does_nothing(const StoredResult& result, const std::string& source) {
  const Result& found = coupling_of(result);
  const auto k = static_cast<std::size_t>(std::ranges::find(found.subsets, source) - found.subsets.begin());
  if (k == found.subsets.size()) return false;
  return std::ranges::any_of(result.signed_headline, [&](std::size_t r) {
    for (std::size_t z = 0; z < found.size_names.size(); ++z) {
      if (!(found.effect_max(r, z, k) <= found.rounding(r, z))) return false;
    }
    return true;
  });
}

/// Whether all limbs have the same errors. The stored study always has the key `limbs`, because its defaults are filled
/// in.
bool same_in_all_limbs(const StoredResult& result) {
  return study_setting(result.study_text, "analysis", "limbs") == "\"all\"";
}

constexpr std::string_view kWorstCase =
    "the largest value that was found with either sign of each error: the signs by which the magnitudes of each alone "
    "add up (first-order sum), solved together, then flipped one by one until no flip is worse. No bound: other signs, "
    "or sizes in between, may do more";

std::vector<std::string> notes(const StoredResult& result) {
  const Result& found = coupling_of(result);
  std::vector<std::string> list{
      fmt::format("{} of errors, alone and together; largest values over {}",
                  counted(found.sources.size(), "source", "sources"), counted(found.poses(), "pose", "poses")),
      "interaction: together minus the sum of each alone",
      has_worst_cases(found) ? fmt::format("worst case: {}", kWorstCase)
                             : "first-order sum: of the magnitudes of each alone; no bound",
      "opposed: share of the poses where the sum is less than its largest part, cancellation: by how much at most; a "
      "norm, which has no sign, cannot tell"};
  if (std::string text = unsolved_text(result); !text.empty()) list.push_back(std::move(text));
  if (std::ranges::any_of(found.count, [&](std::uint64_t poses) { return poses < found.poses(); })) {
    list.emplace_back("some subsets leave out poses that were not solved: see the export's coupling_summary.csv");
  }
  if (same_in_all_limbs(result) &&
      std::ranges::any_of(found.sources, [&](const std::string& source) { return does_nothing(result, source); })) {
    list.emplace_back(
        "all limbs have the same error here, so sources that are symmetric cancel; limbs = \"independent\" "
        "shows what they can do");
  }
  return list;
}

/// The responses and poses that the figures show. Norms are left out: they have no sign and cannot show cancellation.
ShownCells cells(const StoredResult& result) {
  const Result& found = coupling_of(result);
  return shown_cells(result, found.size_names.size() * (2 * found.subsets.size() + 3), result.signed_headline);
}

/// The curves of a coupling result over the poses, one panel for each response and size. Keeps references to its
/// arguments.
class Curves {
 public:
  Curves(const StoredResult& result, const PoseFigures& figures)
      : result_(result), found_(coupling_of(result)), figures_(figures) {}

  Lines effects() const {
    return lines("", [&](std::size_t r, std::size_t z) { return effect_series(r, z); });
  }
  /// Interactions have their own panels, because they may be far smaller than effects.
  Lines interactions() const {
    return lines("interaction in ",
                 [&](std::size_t r, std::size_t z) { return subset_series("interaction", found_.interaction, r, z); });
  }
  Lines cancellations() const {
    Lines all = lines(
        "", [&](std::size_t r, std::size_t z) { return subset_series("cancellation", found_.cancellation, r, z); });
    for (Panel& panel : all.panels) panel.unit = "%";
    return all;
  }
  /// Fields for maps of the workspace: the effect of all sources together at each pose, and their cancellation.
  std::vector<Field> fields() const {
    std::vector<Field> list;
    for (const auto& [r, z] : panels()) {
      const std::string label = panel_label(r, z);
      list.push_back(
          {label + ", all sources", unit_text(result_.responses[r]), curve("effect", found_.effect, r, z, last())});
      if (has_subsets()) {
        list.push_back({label + ", cancellation", "%", curve("cancellation", found_.cancellation, r, z, last())});
      }
    }
    return list;
  }
  bool has_subsets() const { return found_.subsets.size() > sources(); }

 private:
  /// The number of sources. The first subsets have one source each.
  std::size_t sources() const { return std::min(found_.sources.size(), found_.subsets.size()); }
  std::size_t last() const { return found_.subsets.size() - 1; }
  const std::string& subset(std::size_t k) const { return found_.subsets[k]; }
  /// Pairs of a response and a size. For each response, the last size comes first, because the page shows the tables of
  /// this size.
  std::vector<std::pair<std::size_t, std::size_t>> panels() const {
    std::vector<std::pair<std::size_t, std::size_t>> list;
    for (const std::size_t r : figures_.responses()) {
      for (std::size_t z = found_.size_names.size(); z-- > 0;) list.emplace_back(r, z);
    }
    return list;
  }
  std::string panel_label(std::size_t r, std::size_t z) const {
    return fmt::format("{} at {}", result_.responses[r].name, found_.size_names[z]);
  }

  template <class SeriesOf>
  Lines lines(const std::string& prefix, const SeriesOf& series_of) const {
    Lines all{.x = figures_.axis(), .panels = {}, .most = sources() + 4};
    for (const auto& [r, z] : panels()) {
      all.panels.push_back({prefix + panel_label(r, z), unit_text(result_.responses[r]), series_of(r, z)});
    }
    return all;
  }

  /// Adds a curve over the poses to the page and returns its name. Values are in display units, cancellations in
  /// percent.
  ArrayName curve(std::string_view what, const Result::Curves& values, std::size_t r, std::size_t z,
                  std::size_t k) const {
    const double unit = what == "cancellation" ? 0.01 : display(result_.responses[r]).si;
    return figures_.add(fmt::format("{}/{}/{}/{}", what, r, z, k), values.row(r, z, k), unit);
  }

  /// Adds to `list` the curves of all subsets with several sources, except the subset of all sources. r: response; z:
  /// size.
  void add_subsets(std::vector<Series>& list, std::string_view what, const Result::Curves& values, std::size_t r,
                   std::size_t z) const {
    for (std::size_t k = sources(); k + 1 < found_.subsets.size(); ++k) {
      list.push_back({subset(k), curve(what, values, r, z, k)});
    }
  }

  /// The curve of all sources together, then the curves of the other subsets with several sources.
  std::vector<Series> subset_series(std::string_view what, const Result::Curves& values, std::size_t r,
                                    std::size_t z) const {
    std::vector<Series> list{{subset(last()), curve(what, values, r, z, last())}};
    add_subsets(list, what, values, r, z);
    return list;
  }

  /// The curves of each source alone, of all sources together (effect, interaction, worst case, first-order sum, root
  /// sum square), and of the other subsets.
  std::vector<Series> effect_series(std::size_t r, std::size_t z) const {
    std::vector<Series> list;
    for (std::size_t k = 0; k < sources(); ++k) {
      list.push_back({subset(k) + " alone", curve("effect", found_.effect, r, z, k)});
    }
    const auto add = [&](std::string label, std::string_view what, const Result::Curves& values, std::string style) {
      list.push_back(
          {.label = std::move(label), .value = curve(what, values, r, z, last()), .style = std::move(style)});
    };
    if (has_subsets()) {
      add(subset(last()) + " together", "effect", found_.effect, "solid");
      add("interaction of all", "interaction", found_.interaction, "dotted");
      if (has_worst_cases(found_)) add("worst case of all", "worst_case", found_.worst_case, "dashed");
      add("first-order sum of all", "first_order_sum", found_.first_order_sum, "dashed");
      add("root sum square of all", "root_sum_square", found_.root_sum_square, "dashed");
    }
    add_subsets(list, "effect", found_.effect, r, z);
    return list;
  }

  const StoredResult& result_;
  const Result& found_;
  const PoseFigures& figures_;
};

/// Adds the tables of the last size to the section. The tables of the other sizes are folded: the reader opens them.
void add_tables(const StoredResult& result, std::span<const Table> tables, Section& section) {
  const std::size_t shown = std::min(tables.size(), result.signed_headline.size());
  section.folded("The tables of the other sizes", tables.first(tables.size() - shown));
  for (const Table& table : tables.last(shown)) section.table(table);
}

void add_page(const StoredResult& result, std::span<const Table> tables, Page& page) {
  if (coupling_of(result).subsets.empty()) return;
  const PoseFigures figures(result, cells(result), page);
  const Curves curves(result, figures);
  Section& section = page.add_section("together", "What the sources do, alone and together");
  section.paragraph(
      "Each source of errors has its size alone, and with others. The interaction is what all do together less the sum "
      "of what each does alone. Root sum square: what is to be expected where either sign is as likely. First-order "
      "sum: of the magnitudes of each alone. Worst case: " +
      std::string(kWorstCase) + ".");
  figures.add_note(section);
  add_figure(page, section, "sources", curves.effects(),
             result.time.empty() ? "The effect at each pose." : "The effect along the trajectory.");
  if (curves.has_subsets()) {
    add_figure(page, section, "interactions", curves.interactions(), "The interaction of each subset of the sources.");
  }
  add_tables(result, tables, section);
  Section& cancels = page.add_section("where", "Where they cancel, and where they add up");
  cancels.paragraph(
      "Cancellation is the part of the sources' effects that opposes each other: 0 where none opposes another, 100 % "
      "where nothing is left of them together.");
  if (curves.has_subsets()) {
    add_figure(page, cancels, "cancellation", curves.cancellations(), "How much the sources cancel each other.");
  }
  figures.add_workspace(cancels, curves.fields());
}

SolveTally tally(const StoredResult& result) {
  const Result& found = coupling_of(result);
  return {"size", found.size_names, result.poses.size(), {found.solves.begin(), found.solves.end()}};
}

/// The names of subsets at each size: "FS+T at 0.1 mm".
std::vector<std::string> sized_subsets(const Result& coupling) {
  std::vector<std::string> list;
  for (const std::string& size : coupling.size_names) {
    for (const std::string& subset : coupling.subsets) list.push_back(fmt::format("{} at {}", subset, size));
  }
  return list;
}

/// The summary at the top of the report, for the last size (which the page shows) and the first response.
Answer answer(const StoredResult& result) {
  const Result& found = coupling_of(result);
  if (found.subsets.empty() || found.size_names.empty() || result.signed_headline.empty()) return {};
  const std::size_t r = varying_first(result, result.signed_headline).front();
  const std::size_t z = found.size_names.size() - 1;
  const std::size_t all = found.subsets.size() - 1;
  const std::size_t sources = std::min(found.sources.size(), found.subsets.size());
  const NamedUnit& response = result.responses[r];
  const auto text = [&](double value) { return response_text(response, value); };
  const std::string place = place_text(result, static_cast<std::size_t>(found.effect_max_pose(r, z, all)));
  const auto effects = found.effect_max.row(r, z).first(sources);
  const auto largest = static_cast<std::size_t>(std::ranges::max_element(effects) - effects.begin());
  Answer lines{
      {"Answer", fmt::format("At {}, {} together move {} by up to {}, at {}.", found.size_names.back(),
                             found.subsets[all], response.name, text(found.effect_max(r, z, all)), place)},
      {"Largest source", fmt::format("{} alone, with up to {}.", found.subsets[largest], text(effects[largest]))}};
  if (sources > 1) {
    const std::string worst = has_worst_cases(found)
                                  ? fmt::format(", and the worst case that was found is {}, which is not a bound",
                                                text(found.worst_case_max(r, z, all)))
                                  : "";
    lines.emplace_back(
        "Together", fmt::format("Interaction is at most {}. Where signs are as likely as not, {} are to be expected at "
                                "most; magnitudes add up to {}{}.",
                                text(found.interaction_max(r, z, all)), text(found.root_sum_square_max(r, z, all)),
                                text(found.first_order_sum_max(r, z, all)), worst));
  }
  lines.emplace_back("How sure", fmt::format("Solved, not sampled, at {}.", counted(found.poses(), "pose", "poses")));
  lines.emplace_back(kWhatToDo,
                     fmt::format("Make {} smaller first. Where sources cancel, do not count on it: their signs may "
                                 "differ from machine to machine.",
                                 found.subsets[largest]));
  return lines;
}

/// The figure of merit by which two results are compared: the largest effect of all sources together at the last size.
/// Its interval has no width, because errors are not drawn.
std::vector<Merit> merits(const StoredResult& result, std::string_view name) {
  const Result& found = coupling_of(result);
  if (name.empty() || found.effect_max.empty()) return {};
  const std::size_t r = response_named(result, name);
  const NamedUnit& response = result.responses[r];
  const double largest = found.effect_max.row(r).back() / display(response).si;
  return {{.what = fmt::format("largest effect of all sources together on {}", name),
           .unit = unit_text(response),
           .value = largest,
           .low = largest,
           .high = largest}};
}

Comparable comparable(const StoredResult& result, const StoredResult&) {
  const Result& found = coupling_of(result);
  Comparable all = comparable_by_response(result, "subset", sized_subsets(found));
  add_quantity(all, result, "largest effect over the poses", "effect_max",
               [&](std::size_t r, std::size_t n) { return found.effect_max.row(r)[n]; });
  return all;
}

}  // namespace

std::vector<Table> coupling_tables(const StoredResult& result, const TableOptions&) {
  std::vector<Table> tables;
  for (std::size_t z = 0; z < coupling_of(result).size_names.size(); ++z) {
    for (const std::size_t r : varying_first(result, result.signed_headline)) {
      tables.push_back(response_table(result, z, r));
    }
  }
  if (!tables.empty()) std::ranges::move(notes(result), std::back_inserter(tables.back().notes));
  return tables;
}

constinit const ReportKind kReport{
    .tally = tally,
    .tables = coupling_tables,
    .merits = merits,
    .words = [](const StoredResult& result) { return StudyWords{.sizes = coupling_of(result).size_names}; },
    .answer = answer,
    .shown_cells = cells,
    .page = add_page,
    .comparable = comparable};

}  // namespace poesy::coupling
