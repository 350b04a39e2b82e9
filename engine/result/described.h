#pragma once

#include <cstddef>
#include <vector>

#include "engine/model/model.h"
#include "engine/result/result_file.h"

namespace poesy {

/// The names, units and descriptions of a mechanism's responses.
std::vector<NamedUnit> named_responses(const ModelDescription& model);

/// The names, units and descriptions of a mechanism's pose coordinates.
std::vector<NamedUnit> named_coordinates(const ModelDescription& model);

/// The chosen indices; if none are chosen, all indices from 0 to count - 1.
std::vector<std::size_t> chosen_or_all(std::vector<std::size_t> chosen, std::size_t count);

/// The part of a result that follows from the study alone, before anything is solved: kind, title, mechanism, metric,
/// coordinates, poses, responses and measured errors. All other members are empty. The headline (the responses of a
/// summary) is in the order of the model; read_result() moves responses with limits to the front. model: the built
/// mechanism of the study.
StoredResult described(const Study& study, const Model& model, const SelectedPoses& poses);

}  // namespace poesy
