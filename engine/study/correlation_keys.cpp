#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/base/text.h"
#include "engine/random/normal_copula.h"
#include "engine/stats/rank_correlation.h"
#include "engine/study/override_keys.h"
#include "engine/study/study_kind.h"
#include "engine/study/table_file.h"

namespace poesy {
namespace {

/// The word in a study file that asks for the rank correlations of measured parts, which are computed from a file with
/// one line for each part.
constexpr std::string_view kAsMeasured = "as measured";

const InnerRows<CorrelatedErrors>& block_keys() {
  static const InnerRows<CorrelatedErrors> keys{
      .paths = {"errors.correlated"},
      .meaning = "Errors that depend on each other, for studies in which errors vary together.",
      .rows = {InnerRow<CorrelatedErrors>{
                   .name = "factors",
                   .value = {.type = "text or list of texts"},
                   .missing = "name the errors that are correlated, e.g. factors = [\"NAME\", \"NAME\"]",
                   .meaning = "The errors, at least two that vary: a factor set, or a list of factors. An error is in "
                              "one block at the most."},
               InnerRow<CorrelatedErrors>{
                   .name = "correlation",
                   .value = {.type = "list of lists of numbers, or text",
                             .bounds = "symmetric, ones on its diagonal, positive definite",
                             .words = {{kAsMeasured, "the rank correlation of the errors' columns, of one file"}}},
                   .missing = "write a row of numbers for each of them, e.g. correlation = [[1, 0.5], [0.5, 1]]",
                   .meaning = "How the errors are correlated, a row for each in the order of factors. It is the "
                              "correlation of normal errors; for others that of their normal scores, which is about "
                              "their rank correlation."}}};
  return keys;
}

/// The columns of one file from which errors take measured values. Each line of the file belongs to one part.
struct MeasuredTogether {
  std::string file;  ///< name of the file in the study
  std::vector<FactorIndex> factors;
  std::vector<std::string> columns;
};

/// The columns from which [errors.override] takes distributions, grouped by file.
std::vector<MeasuredTogether> measured_together(const StudySection& errors, const ModelDescription& model) {
  std::vector<MeasuredTogether> tables;
  const StudySection override = errors.section("override");
  for (std::size_t f = 0; f < model.factors.size(); ++f) {
    const auto own = override_of(override, model.factors[f].name);
    const auto file = own ? own->section().find("file") : std::nullopt;
    if (!file) continue;
    auto table = std::ranges::find(tables, file->text(), &MeasuredTogether::file);
    if (table == tables.end()) table = tables.insert(table, {file->text(), {}, {}});
    table->factors.emplace_back(f);
    table->columns.push_back(own->section().require("column").text());
  }
  return tables;
}

/// The correlation matrix [columns x columns] of the normal scores of a table's columns. An entry is 2 sin(pi r / 6)
/// for two columns with the rank correlation r (Spearman).
std::vector<double> correlation_of(const MeasuredTogether& table, const StudySection& errors,
                                   const ModelDescription& model) {
  const std::string path = beside_study(errors.place(), table.file);
  const std::size_t size = table.factors.size();
  std::vector<std::vector<double>> columns;
  for (std::size_t k = 0; k < size; ++k) {
    columns.push_back(read_column(path, table.columns[k], model.factors[table.factors[k].value].dimension).values);
  }
  std::vector<double> correlation(size * size, 1.0);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double r = 2.0 * std::sin(std::numbers::pi / 6.0 * rank_correlation(columns[i], columns[j]));
      correlation[i * size + j] = r;
      correlation[j * size + i] = r;
    }
  }
  return correlation;
}

/// Throws InputError if two errors take the same column: they would be the same number in each machine.
void check_columns(const StudyValue& value, const MeasuredTogether& table, const ModelDescription& model) {
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const auto first = std::ranges::find(table.columns, table.columns[k]) - table.columns.begin();
    if (static_cast<std::size_t>(first) == k) continue;
    const auto name = [&](std::size_t at) { return model.factors[table.factors[at].value].name; };
    value.fail(fmt::format("correlates {} and {}, which take the same column '{}' of {}", name(std::size_t(first)),
                           name(k), printable(table.columns[k]), printable(table.file)),
               "write one [[errors.correlated]] for each part, with the factors of this part");
  }
}

void check_definite(const StudyValue& value, std::span<const double> correlation) {
  const double least = smallest_eigenvalue(correlation);
  if (least >= kLeastEigenvalue) return;
  value.fail(fmt::format("gives a correlation that is not positive definite: its smallest eigenvalue is {}",
                         shortest(std::abs(least) < 1e-12 ? 0.0 : least)),
             "take smaller correlations, or leave out an error that follows from the others");
}

/// Reads a correlation matrix [size x size]. Throws InputError if it is not symmetric, an entry is beyond 1 or -1, or
/// the diagonal is not 1.
std::vector<double> read_matrix(const StudyValue& value, std::size_t size) {
  const std::string remedy = fmt::format("write {} rows of {} numbers, in the order of factors", size, size);
  std::vector<double> matrix;
  for (const StudyValue& row : value.list(size, remedy)) {
    for (const StudyValue& cell : row.list(size, remedy)) {
      const std::size_t i = matrix.size() / size;
      const std::size_t j = matrix.size() % size;
      matrix.push_back(cell.number());
      const double own = matrix.back();
      if (std::abs(own) > 1.0) cell.fail("is " + shortest(own), "a correlation lies between -1 and 1");
      if (i == j && own != 1.0) cell.fail("is " + shortest(own), "each error's correlation with itself is 1");
      if (j < i && own != matrix[j * size + i]) {
        cell.fail(fmt::format("is {}, but the number on the other side of the diagonal is {}", shortest(own),
                              shortest(matrix[j * size + i])),
                  "a correlation is symmetric: write the same number at both places");
      }
    }
  }
  return matrix;
}

/// The columns from which these factors take their distributions. Throws InputError if they are not all in one file.
MeasuredTogether columns_of(const StudyValue& value, std::span<const FactorIndex> factors, const StudySection& errors,
                            const ModelDescription& model) {
  MeasuredTogether asked;
  for (const FactorIndex factor : factors) {
    bool found = false;
    for (const MeasuredTogether& table : measured_together(errors, model)) {
      const auto place = std::ranges::find(table.factors, factor);
      if (place == table.factors.end() || (!asked.factors.empty() && asked.file != table.file)) continue;
      found = true;
      asked.file = table.file;
      asked.factors.push_back(factor);
      asked.columns.push_back(table.columns[static_cast<std::size_t>(place - table.factors.begin())]);
    }
    if (!found) {
      value.fail(fmt::format("is \"{}\", but {} is not a column of the same file", kAsMeasured,
                             model.factors[factor.value].name),
                 "give each of the errors a distribution \"measured\" with file and column in errors.override, or "
                 "write the numbers");
    }
  }
  return asked;
}

/// Throws InputError if some of these errors are drawn once for each machine and others at each pose.
void check_draws(const StudyValue& value, std::span<const FactorIndex> factors, const Study& study) {
  const auto anew = [&](FactorIndex factor) { return study.errors.is_per_pose(factor); };
  const auto fixed = std::ranges::find_if_not(factors, anew);
  const auto moving = std::ranges::find_if(factors, anew);
  if (fixed == factors.end() || moving == factors.end()) return;
  value.fail(fmt::format("has '{}', which is drawn per pose, and '{}', which is not",
                         study.model().factors[moving->value].name, study.model().factors[fixed->value].name),
             "errors that depend on each other are drawn together: give all of them the same draws");
}

CorrelatedErrors read_block(const StudyValue& value, const Study& study, const Reading& reading) {
  const StudySection section = value.section();
  CorrelatedErrors block;
  read_keys(block_keys(), section, block, Nothing());
  const StudyValue factors = section.require("factors");
  block.factors = read_factors(factors, study);
  if (block.factors.size() < 2) factors.fail("names one error", "name at least two");
  for (const CorrelatedErrors& other : study.errors.correlated) {
    for (const FactorIndex factor : other.factors) {
      if (std::ranges::find(block.factors, factor) == block.factors.end()) continue;
      factors.fail("has '" + study.model().factors[factor.value].name + "', which another block has as well",
                   "write one block for all errors that depend on each other");
    }
  }
  for (const FactorIndex factor : block.factors) {
    if (study.errors.by_factor[factor.value].shift() == 0.0) continue;
    factors.fail("has '" + study.model().factors[factor.value].name + "', whose distribution has a shift",
                 "leave it out here, or remove its shift: errors with one cannot be correlated");
  }
  for (const FactorIndex factor : block.factors) {
    if (study.errors.by_factor[factor.value].shape() != Distribution::Shape::given) continue;
    factors.fail("has '" + study.model().factors[factor.value].name + "', a column of errors.machines",
                 "leave it out here: the rows show which errors go together");
  }
  check_draws(factors, block.factors, study);
  const StudyValue correlation = section.require("correlation");
  if (correlation.is_text()) {
    static_cast<void>(correlation.word(std::array{kAsMeasured}));
    const StudySection errors = reading.root.section("errors");
    const MeasuredTogether asked = columns_of(correlation, block.factors, errors, study.model());
    check_columns(correlation, asked, study.model());
    if (reading.use != StudyUse::run) return {};
    block.correlation = correlation_of(asked, errors, study.model());
  } else {
    block.correlation = read_matrix(correlation, block.factors.size());
  }
  check_definite(correlation, block.correlation);
  return block;
}

/// Makes a block of correlated errors for each file from which several errors take their values.
void read_as_measured(const StudyValue& value, Study& study, const Reading& reading) {
  const StudySection errors = reading.root.section("errors");
  for (const MeasuredTogether& table : measured_together(errors, study.model())) {
    if (table.factors.size() < 2 || reading.use != StudyUse::run) continue;
    check_draws(value, table.factors, study);
    check_columns(value, table, study.model());
    study.errors.correlated.push_back({table.factors, correlation_of(table, errors, study.model())});
    check_definite(value, study.errors.correlated.back().correlation);
  }
  if (!study.errors.correlated.empty() || reading.use != StudyUse::run) return;
  value.fail(fmt::format("is \"{}\", but no two errors are columns of one file", kAsMeasured),
             "give errors a distribution \"measured\" with file and column in errors.override, or remove it");
}

void read_correlated(const StudyValue& value, Study& study, const Reading& reading) {
  if (value.is_text()) {
    static_cast<void>(value.word(std::array{kAsMeasured}));
    read_as_measured(value, study, reading);
    return;
  }
  for (const StudyValue& one : value.list()) {
    CorrelatedErrors block = read_block(one, study, reading);
    if (!block.factors.empty()) study.errors.correlated.push_back(std::move(block));
  }
}

std::string correlated_lines(const Study& study) {
  std::string text;
  for (const CorrelatedErrors& block : study.errors.correlated) {
    const std::size_t size = block.factors.size();
    text += "\n[[errors.correlated]]\nfactors = " + factors_text(block.factors, study.model()) + "\ncorrelation = [";
    for (std::size_t i = 0; i < size; ++i) {
      std::vector<std::string> row;
      for (std::size_t j = 0; j < size; ++j) row.push_back(shortest(block.correlation[i * size + j]));
      text += "\n  " + list_text(row) + ",";
    }
    text += "\n]\n";
  }
  return text;
}

std::string shown_correlated(const TemplateLines& lines, const Study& study) {
  const std::vector<Factor>& factors = study.model().factors;
  if (study.analysis.kind->varies != Varies::together || factors.size() < 2) return {};
  return lines.explanation_lines("errors", "correlated") + lines.keys_lines("errors.correlated") +
         fmt::format("# correlated = [{{ factors = [\"{}\", \"{}\"], correlation = [[1, 0.5], [0.5, 1]] }}]\n",
                     factors[0].name, factors[1].name);
}

/// A short list of names: "x1, x2 and 3 more".
std::string some_names(std::span<const FactorIndex> factors, const ModelDescription& model) {
  constexpr std::size_t kMost = 4;
  std::string text;
  for (std::size_t k = 0; k < std::min(kMost, factors.size()); ++k) {
    text += (k == 0 ? "" : ", ") + model.factors[factors[k].value].name;
  }
  return factors.size() <= kMost ? text : text + fmt::format(" and {} more", factors.size() - kMost);
}

}  // namespace

StudyRow correlated_row() {
  return {.name = "correlated",
          .value = {.type = "list of tables, or text",
                    .words = {{kAsMeasured,
                               "all columns of one file that errors.override takes keep their rank correlation; "
                               "for some of them, write a block"}}},
          .usual = "none",
          .meaning =
              "Errors that depend on each other, in blocks [[errors.correlated]]; studies in which errors vary "
              "together take them.",
          .reader = read_correlated,
          .lines = correlated_lines,
          .late = 1,
          .shown = shown_correlated};
}

StudyTable correlated_table() { return described(block_keys()); }

void check_correlated(const Study& study, const Reading& reading) {
  if (study.errors.correlated.empty()) return;
  const StudyKind& kind = *study.analysis.kind;
  const StudyValue value = reading.root.section("errors").require("correlated");
  if (kind.varies != Varies::together) {
    const auto other = std::ranges::find(reading.kinds.all, Varies::together, &StudyKind::varies);
    value.fail(fmt::format("correlates {}, but kind = \"{}\" {}",
                           some_names(study.errors.correlated.front().factors, study.model()), kind.name,
                           kind.varies == Varies::none ? "draws no errors" : "varies one error at a time"),
               fmt::format("take kind = \"{}\", or remove it", (*other)->name));
  }
  for (const CorrelatedErrors& block : study.errors.correlated) {
    for (const FactorIndex factor : block.factors) {
      if (std::ranges::find(study.analysis.factors, factor) != study.analysis.factors.end()) continue;
      value.fail("has '" + study.model().factors[factor.value].name + "', which the study does not vary",
                 "name it in analysis.factors, or leave it out here");
    }
  }
}

}  // namespace poesy
