#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "engine/app/command_line.h"
#include "engine/app/results.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/kinds/registry.h"
#include "engine/kinds/study_file.h"
#include "engine/run/evaluation.h"
#include "engine/run/replay.h"
#include "engine/storage/poesy_file.h"
#include "engine/storage/version.h"
#include "engine/study/study_kind.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

constexpr std::uint64_t kMostNumber = 0x7fffffffffffffff;  ///< largest number of a pose or a sample on the command line

struct ReplayOptions {
  std::string result;
  std::string factor;
  std::size_t pose = 0;
  std::optional<std::size_t> sample;
};

[[noreturn]] void refuse(const ReplayOptions& options, const std::string& problem, const std::string& remedy) {
  throw InputError({.file = options.result}, problem, remedy);
}

/// Throws InputError unless `number` is in [0, count). what: "pose" or "sample".
void check_number(const ReplayOptions& options, const std::string& what, std::size_t number, std::size_t count) {
  if (number < count) return;
  refuse(options, fmt::format("{} {}: there are {} {}s", what, number, count, what),
         count == 1 ? "the only number is 0" : fmt::format("give a number from 0 to {}", count - 1));
}

/// The index of options.factor in a list of known names. Throws InputError if the list does not have it. what: the word
/// for one of the names, for messages.
std::size_t position_of(const ReplayOptions& options, const std::string& what, const std::vector<std::string>& known) {
  const auto found = std::ranges::find(known, options.factor);
  if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  refuse(options, fmt::format("no {} '{}' in this result", what, options.factor),
         fmt::format("it has {}", fmt::join(known, ", ")));
}

void refuse_sample(const ReplayOptions& options, const std::string& why) {
  if (options.sample) refuse(options, why, fmt::format("write 'poesy replay {} NAME POSE'", options.result));
}

std::size_t required_sample(const ReplayOptions& options, std::size_t count) {
  if (!options.sample) refuse(options, "no sample given", fmt::format("give a number from 0 to {}", count - 1));
  check_number(options, "sample", *options.sample, count);
  return *options.sample;
}

/// Draws and solves one of the study's samples again.
ReplayedSample replay_drawn(const ReplayOptions& options, const StoredResult& result, const StoredStudy& stored,
                            const Model& model) {
  const Analysis& analysis = stored.study.analysis;
  if (analysis.kind->name != result.kind || analysis.factors.size() != result.factors.size()) {
    throw FileError(options.result, "keeps a study that does not fit it", kDamagedRemedy);
  }
  const std::size_t slot = position_of(options, "varied error", result.varied);
  const std::size_t samples = result.convergence ? result.convergence->samples[slot] : analysis.samples;
  const SampleIndex sample(required_sample(options, samples));
  return replay_sample(stored.study, model, stored.poses.poses, slot, PoseIndex(options.pose), sample);
}

/// The index of the row of given errors that the command line names: a case by its name, or a row of a table by the
/// numbers of pose and sample.
std::size_t row_of(const ReplayOptions& options, const GivenErrors& given) {
  if (given.samples == 0) refuse_sample(options, fmt::format("a {} has no samples", given.word));
  const std::size_t position = position_of(options, std::string(given.word), given.names);
  if (given.samples == 0) return position;
  const std::size_t sample = required_sample(options, given.samples);
  return given.pairing == Pairing::row_by_row ? options.pose : sample;
}

/// Solves a named case, or a row of errors of `poesy evaluate`, once more.
ReplayedSample replay_given(const ReplayOptions& options, const StoredResult& result, const GivenErrors& given,
                            const StoredStudy& stored, const Model& model) {
  const std::size_t row = row_of(options, given);
  ErrorTable errors{.factors = {}, .values = {}, .rows = 1};
  for (const NamedUnit& factor : result.factors) {
    const auto known = model.description().find_factor(factor.name);
    if (!known) throw FileError(options.result, "names an unknown error", "use the poesy that wrote it");
    errors.factors.push_back(*known);
  }
  const auto values = given.values.subspan(row * errors.factors.size(), errors.factors.size());
  errors.values.assign(values.begin(), values.end());
  return replay_row(stored.study.solver, model, result.poses, PoseIndex(options.pose), errors);
}

ReplayedSample replay_of(const ReplayOptions& options, const StoredResult& result, const StoredStudy& stored,
                         const Model& model) {
  if (!result.varied.empty()) return replay_drawn(options, result, stored, model);
  if (const auto given_errors = kind_of(result).given_errors) {
    return replay_given(options, result, given_errors(result), stored, model);
  }
  refuse(options, "a result of kind " + result.kind + " keeps no addresses of single solves",
         fmt::format("replay one of a {} result", replayable_kinds()));
}

void warn_of_other_program(const ReplayOptions& options, const StoredResult& result) {
  if (result.poesy_version == poesy_version() && result.git_commit == git_commit()) return;
  say(Message::warning,
      fmt::format("{} was written by poesy {} ({}), and this is {} ({}): draws and solves may "
                  "differ",
                  options.result, result.poesy_version, result.git_commit, poesy_version(), git_commit()));
}

/// Warns if the result lists this sample as failed, but with a status that differs from that of the replay.
void warn_of_difference(const ReplayOptions& options, const StoredResult& result, const ReplayedSample& replayed) {
  for (const Failure& failure : result.failures) {
    if (result.varied[failure.slot] != options.factor || failure.pose.value != options.pose ||
        failure.failed.sample.value != options.sample || failure.failed.status == replayed.status) {
      continue;
    }
    say(Message::warning, fmt::format("the result lists this sample as {}",
                                      kStatusNames[static_cast<std::size_t>(failure.failed.status)]));
  }
}

/// A value in its SI unit and in the unit that results show: "-0.25 m = -250 mm".
std::string value_text(double si, Dimension dimension) {
  const Unit& unit = display_unit(dimension);
  std::string text = shortest(si);
  if (dimension == Dimension::number) return text;
  return text + fmt::format(" {} = {:.6g} {}", si_unit(dimension), si / unit.si, unit.name);
}

std::string line(std::string_view name, double si, Dimension dimension) {
  return fmt::format("  {:<22} {}\n", name, value_text(si, dimension));
}

std::string end_text(SolveStatus status, std::uint32_t iterations) {
  return fmt::format("{} after {} iterations", kStatusNames[static_cast<std::size_t>(status)], iterations);
}

std::string sample_text(const ReplayOptions& options, const StoredResult& result, const ModelDescription& model,
                        const ReplayedSample& sample) {
  std::string text = fmt::format("pose {}\n", options.pose);
  const auto pose = result.poses[PoseIndex(options.pose)];
  for (std::size_t c = 0; c < pose.size(); ++c) {
    text += line(model.pose_coordinates[c].name, pose[c], model.pose_coordinates[c].dimension);
  }
  text += "errors that vary\n";
  for (std::size_t v = 0; v < sample.varied.size(); ++v) {
    const Factor& factor = model.factors[sample.varied[v].value];
    text += line(factor.name, sample.values[v], factor.dimension);
  }
  return text;
}

std::string outcome_text(const ModelDescription& model, const ReplayedSample& sample, std::string_view method) {
  std::string text =
      fmt::format("solved as in the run, method {}: {}\n", method, end_text(sample.status, sample.iterations));
  for (std::size_t r = 0; r < model.responses.size(); ++r) {
    text += line(model.responses[r].name, sample.responses[r], model.responses[r].dimension);
  }
  return text;
}

std::string iterations_text(const SolveTrace& trace) {
  if (trace.columns.empty()) return {};
  std::string text = fmt::format("{:>9}", "iteration");
  for (const TraceColumn& column : trace.columns) {
    text += fmt::format(" {:>22}", column.unit == "1" ? column.name : column.name + " [" + column.unit + "]");
  }
  for (std::size_t k = 0; k < trace.rows.size(); ++k) {
    if (k % trace.columns.size() == 0) text += fmt::format("\n{:>9}", k / trace.columns.size() + 1);
    text += fmt::format(" {:>22.6g}", trace.rows[k]);
  }
  return text + "\n";
}

/// Lines that say whether the solver of the run and the reference solver agree. If a solver did not converge, its
/// responses are those of its last iterate and may differ for this reason.
std::string agreement_text(const ModelDescription& model, const ReplayedSample& sample, const SolveTrace& trace) {
  std::string text = fmt::format("status: {}\n", sample.status == trace.status ? "the same" : "not the same");
  for (std::size_t r = 0; r < model.responses.size(); ++r) {
    const Response& response = model.responses[r];
    if (std::isnan(trace.responses[r]) && !std::isnan(sample.responses[r])) {
      text += fmt::format("  {:<22} not shown, because it is relative to another pose\n", response.name);
      continue;
    }
    text += fmt::format("  {:<22} {}; difference {:.3g}\n", response.name,
                        value_text(trace.responses[r], response.dimension),
                        std::abs(trace.responses[r] - sample.responses[r]));
  }
  return text;
}

std::string reference_text(const ModelDescription& model, const ReplayedSample& sample,
                           const std::optional<SolveTrace>& trace) {
  if (!trace) return "this mechanism shows no iterations\n";
  return fmt::format(
      "\nby the reference solver, whose iterations these are and not those above ({}): {}\n{}compared with the run, {}",
      trace->solver, end_text(trace->status, trace->iterations), iterations_text(*trace),
      agreement_text(model, sample, *trace));
}

int replay(const ReplayOptions& options) {
  const StoredResult result = read_result_with_warning(options.result);
  warn_of_other_program(options, result);
  check_number(options, "pose", options.pose, result.poses.size());
  const StoredStudy stored = stored_study(result, options.result, registry());
  if (!kind_of(result).report.words(result).from_tables && !calibration_text(stored.study).empty() &&
      !stored.study.mechanism.calibrated) {
    refuse(options, "its machines are calibrated, and a replay solves a machine as it is made",
           "take [analysis.calibration] out of the study, run it, and replay that result");
  }
  const std::unique_ptr<Model> model = build_model(stored.study.mechanism);
  const auto pose = stored.poses.poses[PoseIndex(options.pose)];
  if (const auto reason = model->unreachable(pose)) {
    throw FileError(options.result, "has a pose that the mechanism does not reach: " + *reason,
                    "use the poesy that wrote it");
  }
  const ReplayedSample sample = replay_of(options, result, stored, *model);
  warn_of_difference(options, result, sample);
  const ModelDescription& description = model->description();
  print(sample_text(options, result, description, sample) +
        outcome_text(description, sample, name(stored.study.solver.method)) +
        reference_text(description, sample, model->trace(pose, sample.errors, stored.study.solver)));
  return kDone;
}

}  // namespace

Command& add_replay(Command& program) {
  const auto [command, options] =
      program.add_command("replay", "solve one sample of a result again, iteration by iteration", replay);
  command.add_value("result", options.result, "RESULT.h5", "result file")->required();
  command
      .add_value("factor", options.factor, "FACTOR",
                 "error that varied; all: a Monte Carlo result; or the name of a case")
      ->required();
  command.add_whole_number("pose", options.pose, "POSE", "number of the pose, from 0", 0, kMostNumber)->required();
  command.add_whole_number("sample", options.sample, "SAMPLE", "number of the sample, from 0; not of a case", 0,
                           kMostNumber);
  command.notes = {
      "'poesy show' names a sample that failed, failures.csv of 'poesy export' and /solver/failed_* the first ones."};
  command.examples = {{"sample 345 of one error at pose 12", "poesy replay result.h5 epsilon_1_4_z 12 345"},
                      {"of a Monte Carlo result, where all errors vary", "poesy replay result.h5 all 12 345"}};
  return command;
}

}  // namespace poesy::app
