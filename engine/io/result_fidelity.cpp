#include <array>

#include "engine/io/result_parts.h"

namespace poesy {
namespace {

const Axes kPairs{"response", "factor"};

void add_measures(ResultBuilder& result, const FidelityResult& found) {
  const std::string index_unit = "SI: response unit / factor unit";
  result.add("/fidelity/global", kPairs, found.global, {index_unit, "Global index by the second fidelity"});
  result.add("/fidelity/discrepancy", kPairs, found.discrepancy,
             {index_unit, "Global index by the second fidelity - global index by the first (/sensitivity/global)"});
  result.add("/fidelity/relative_discrepancy", kPairs, found.relative_discrepancy,
             {"1",
              "discrepancy over the error's effect: its largest global index by the first fidelity on any response of "
              "the same dimension; infinity where only the second fidelity has an effect, NaN where neither has"});
  result.add("/fidelity/nonlinearity", kPairs, found.nonlinearity,
             {"1",
              "Root mean square over the poses of hypot(change of the mean over the background, change of the standard "
              "deviation) / sigma(error), over the error's effect as in relative_discrepancy"});
}

}  // namespace

void add_fidelity(ResultBuilder& result, const Study& study, const FidelityResult& found) {
  h5::File& file = result.file();
  const MechanismChoice& choice = study.mechanism;
  file.make_group("/fidelity");
  result.show_axes("/fidelity", {"response", "factor", "pose"});
  file.set_attribute("/fidelity", "description",
                     std::string("The model's second fidelity on the same draws, compared with the first, of which all "
                                 "other groups speak"));
  const std::array names{study.model().fidelities[choice.fidelity], study.model().fidelities[choice.compared.value()]};
  file.set_attribute("/fidelity", "fidelities", std::span<const std::string>(names));
  file.set_attribute("/fidelity", "linearity", found.linearity);
  add_measures(result, found);
  result.add("/fidelity/linear", {"factor"}, found.linear,
             {"1",
              "1: for errors of the study's size no response's nonlinearity or relative discrepancy is above the "
              "attribute linearity of /fidelity; 0: one is, or the comparison is incomplete"});
  result.add("/fidelity/not_converged", {"factor", "pose"}, found.not_converged,
             {"1", "Samples that the second fidelity did not solve"});
}

void read_fidelity(const h5::File& file, StoredResult& result) {
  const std::size_t factors = axis_length(file, "factor");
  const std::size_t pairs = factors * axis_length(file, "response");
  const auto read = [&](const char* name) {
    return read_exactly<double>(file, std::string("/fidelity/") + name, pairs);
  };
  result.fidelities = file.attribute<std::string>("/fidelity", "fidelities");
  if (result.fidelities.size() != 2) throw h5::Error("it does not compare two fidelities");
  result.sensitivity.fidelity = {.linearity = file.attribute<double>("/fidelity", "linearity").at(0),
                                 .global = read("global"),
                                 .discrepancy = read("discrepancy"),
                                 .relative_discrepancy = read("relative_discrepancy"),
                                 .nonlinearity = read("nonlinearity"),
                                 .linear = read_exactly<std::uint8_t>(file, "/fidelity/linear", factors),
                                 .not_converged = read_exactly<std::uint64_t>(file, "/fidelity/not_converged",
                                                                              factors * axis_length(file, "pose"))};
}

}  // namespace poesy
